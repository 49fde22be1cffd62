"""The rows T1 to T19, in order."""

from __future__ import annotations

from collections.abc import Callable

from flexarm_env.thesis.claims import appendix, chapter2, chapter3, chapter4, slews, speed
from flexarm_env.thesis.claims.claim import FAILS, HOLDS, IN_PART, Claim, Part

ROWS: tuple[Callable[[], Claim], ...] = (
    appendix.constants,
    appendix.whole_arm,
    chapter2.position,
    chapter2.backlash,
    chapter3.two_frequencies,
    chapter3.falling_frequency,
    chapter3.motor_inertia,
    chapter3.clamped_alone,
    chapter3.beam_damping,
    chapter3.payload,
    chapter4.clamped_model,
    chapter4.delayed_torque,
    chapter4.torque_at_once,
    chapter4.with_dry_friction,
    chapter4.positive_gain,
    chapter4.by_region,
    slews.slew_of_100_degrees,
    slews.practical_choice,
    speed.twelve_hours,
)

__all__ = ["FAILS", "HOLDS", "IN_PART", "ROWS", "Claim", "Part"]
