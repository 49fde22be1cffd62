"""Reward terms that all of the thesis's tasks have: near the target, without vibration, with little effort, within range."""

from __future__ import annotations

import math

from flexarm_env.tasks.reward import RewardTerm

#: Distance from the target at which `closeness` has fallen to 1/e [rad].
NEAR = 0.05


def distance(hub_angle: float, target: float) -> float:
    """Penalise the hub's distance from the target [rad]."""
    return -abs(target - hub_angle)


def closeness(hub_angle: float, target: float) -> float:
    """Reward a hub that is nearly at the target."""
    return math.exp(-abs(target - hub_angle) / NEAR)


def vibration(tip_deflection: float, beam_length: float) -> float:
    """Penalise a bent beam."""
    return -abs(tip_deflection) / beam_length


def effort(command: float) -> float:
    """Penalise large commands."""
    return -(command**2)


def rate(command_change: float) -> float:
    """Penalise sudden commands."""
    return -(command_change**2)


def failure(failed: bool) -> float:
    """Penalise an arm that leaves its range."""
    return -1.0 if failed else 0.0


COMMON_TERMS = (
    RewardTerm(distance, 1.0, "−abs(target − θ) [rad]"),
    RewardTerm(closeness, 0.5, f"exp(−abs(target − θ) / {NEAR:g} rad)"),
    RewardTerm(vibration, 2.0, "−abs(w) / beam length"),
    RewardTerm(effort, 0.02, "−u²"),
    RewardTerm(rate, 0.02, "−(change of u)²"),
    RewardTerm(failure, 100.0, "−1 once, where the arm leaves its range"),
)
