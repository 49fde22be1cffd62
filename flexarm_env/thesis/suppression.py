"""The runs of thesis chapter 4: a pulse or a slew, with the beam's torque fed back by region of speed."""

from __future__ import annotations

import functools

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.controllers import make_controller
from flexarm_env.controllers.vibration import VibrationSuppression
from flexarm_env.thesis import arms
from flexarm_env.thesis.fixed_step import Law, pinned, simulate
from flexarm_env.thesis.runs import DURATION, INTERVAL, PULSE, Floats, Run, pulse, run

#: Control [s] where friction is compensated at low speed: the switching converges slowly with the interval.
FINE = 1e-4
#: The thesis's controllers act at each step; its method at this step [s] stands for that limit.
LIMIT_STEP = 1e-6
SLEW = np.deg2rad(100.0)


def _after_pulse(arm: Arm, high: float, low: float, delay: float, compensation: bool, interval: float) -> Run:
    """Eq. 4.1: 3 A for 0.5 s, and K_mo M_o(t − t_d)/kφ added to it; the arm's limit holds for the sum."""
    controller = VibrationSuppression(
        arms.unlimited(), interval, high_gain=high, low_gain=low, delay=delay, friction_compensation=compensation,
        proportional=0.0, derivative=0.0,
    )  # fmt: skip
    return run(arm, controller, feed=pulse(0.0, interval=interval), interval=interval)


@functools.cache
def delayed(limited: bool, friction: bool = True) -> Run:
    """K_mo = −1, t_d = 0.026 s on the pinned model (Figs. 4.4, 4.5)."""
    arm = arms.combined() if friction else arms.pinned_only()
    return _after_pulse(arm if limited else arm.with_values({"drive.limit": 0.0}), -1.0, -1.0, 0.026, False, INTERVAL)


@functools.cache
def without_friction(gain: float) -> Run:
    """K_mo = gain, t_d = 0 on the pinned model without dry friction (Fig. 4.7)."""
    return _after_pulse(arms.pinned_only(), gain, gain, 0.0, False, INTERVAL)


@functools.cache
def with_friction(high: float, low: float, compensation: bool = False, limited: bool = True) -> Run:
    """K_mo by region of speed, t_d = 0, with friction (Figs. 4.8 to 4.14)."""
    arm = arms.combined() if limited else arms.unlimited()
    return _after_pulse(arm, high, low, 0.0, compensation, FINE if low or compensation else INTERVAL)


@functools.cache
def slew(controller: str) -> Run:
    """100° under one of the product's controllers (Figs. 4.15 to 4.19)."""
    interval = FINE if controller in ("vibration_dual", "vibration_low") else INTERVAL
    target = np.full(round(DURATION / interval), SLEW)
    return run(arms.combined(), make_controller(controller, arms.combined(), interval), target=target, interval=interval)


@functools.cache
def stand_in(controller: str) -> Run:
    """100° of the noisy stand-in for the rig at 200 Hz, one controller of the product (Figs. 4.20 to 4.22)."""
    arm = arms.stand_in()
    return run(
        arm, make_controller(controller, arm, 0.005), target=np.full(round(DURATION / 0.005), SLEW), interval=0.005, noise=0
    )


@functools.cache
def limit(high: float, low: float, compensation: bool, slews: bool) -> Floats:
    """The same as with_friction or slew, by the thesis's own method with control at each step of 1 µs.

    Returns:
        (samples, 5) as fixed_step.simulate, every millisecond.
    """
    amps = (arms.combined().value("effects.coulomb.torque") / (1.5 * 0.33)) if compensation else 0.0
    drive = {"target": SLEW, "proportional": 2.5308, "derivative": 0.6625} if slews else {"pulse": PULSE}
    return simulate(pinned(), Law(high=high, low=low, compensation=amps, limit=5.0, **drive), DURATION, LIMIT_STEP, INTERVAL)
