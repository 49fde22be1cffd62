"""Columns of an arm's truth, which the plant writes after its readings and the environment takes from there."""

from __future__ import annotations

#: Hub angle [rad] and speed [rad/s], tip deflection [m], whether the hub sticks, whether the state diverged (0 or 1).
TRUTH_ANGLE, TRUTH_SPEED, TRUTH_DEFLECTION, TRUTH_STUCK, TRUTH_LOST = range(5)
TRUTH_SIZE = 5
