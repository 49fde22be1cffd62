"""The runs of thesis chapter 2: the rigid model under PD, with and without backlash."""

from __future__ import annotations

import functools

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.controllers import make_controller
from flexarm_env.controllers.pd import RATE
from flexarm_env.thesis import arms, impact
from flexarm_env.thesis.constants import TABLE
from flexarm_env.thesis.runs import INTERVAL, Floats, Run, run, square_wave

DURATION = 10.0
#: Second set-point step [s], the first to start from rest with the teeth on the other side.
STEP = 2.5


@functools.cache
def rigid(gap: bool, rate: bool = False, printed: bool = False) -> Run:
    """Run the rigid arm on the product's plant.

    Args:
        gap: whether it has the backlash of Table 2.1.
        rate: whether the current ramps (Fig. 2.8).
        printed: whether its inertia is Table 2.1's 0.158 kg m² (erratum 7).
    """
    arm = arms.rigid(TABLE["J_a"] if printed else None, TABLE["gap"] if gap else 0.0)
    return _follow(arm, "pd_rate_limited" if rate else "pd")


@functools.cache
def misprinted_friction() -> Run:
    """Run the rigid arm by eq. 2.3 as printed, where b_s acts on the acceleration: it adds inertia and no damping."""
    arm = arms.rigid(arms.beam_inertia(arms.combined()) + TABLE["J_hub"] + TABLE["b_s"])
    return _follow(arm.with_effect("viscous", coefficient=TABLE["N"] ** 2 * TABLE["b_m"]), "pd")


@functools.cache
def collision(gap: bool, rate: bool = False, printed: bool = False) -> Floats:
    """Run the rigid arm with the thesis's collision (eqs. 2.13 to 2.22), as impact.follow.

    Args:
        gap: whether it has the backlash of Table 2.1.
        rate: whether the current ramps (Fig. 2.8).
        printed: whether gears separate by eq. 2.22 as printed.
    """
    inertia = arms.beam_inertia(arms.combined()) + TABLE["J_hub"]
    size = TABLE["gap"] if gap else 0.0
    return impact.follow(square_wave(DURATION), INTERVAL, size, inertia, RATE if rate else np.inf, printed)


@functools.cache
def flexible(rate: bool = False) -> Run:
    """Run the flexible arm (six elements, gears, noise) in the place of the thesis's rig."""
    arm = arms.stand_in()
    name = "pd_rate_limited" if rate else "pd"
    return run(arm, make_controller(name, arm, 0.005), target=square_wave(DURATION, 0.005), interval=0.005, noise=0)


@functools.cache
def flexible_quiet() -> Run:
    """Run the flexible arm of one element, without noise."""
    return _follow(arms.combined(), "pd")


def _follow(arm: Arm, controller: str) -> Run:
    return run(arm, make_controller(controller, arm, INTERVAL), target=square_wave(DURATION))


def jump(speed: Floats, interval: float = INTERVAL, at: float = STEP, within: float = 0.05) -> float:
    """Measure the jump: the largest speed [rad/s] that the motor loses again within 5 ms, soon after a set-point step.

    Args:
        speed: of the motor (samples,) [rad/s].
        interval: [s].
        at: time of the step [s].
        within: length of the window after the step [s].
    """
    part = np.abs(speed[round(at / interval) : round((at + within) / interval)])
    width = max(round(0.005 / interval), 1)
    return float(np.max(part[:-width] - part[width:], initial=0.0))


def swings(speed: Floats, interval: float = INTERVAL) -> int:
    """Count the reversals of the speed between 50 ms after a step and the next step: 1 for a simple motion."""
    part = np.abs(speed[round((STEP + 0.05) / interval) : round((2.0 * STEP) / interval)])
    slopes = np.diff(part)
    slopes = slopes[np.abs(slopes) > 1e-6]
    return int(np.sum(np.diff(np.sign(slopes)) != 0.0))
