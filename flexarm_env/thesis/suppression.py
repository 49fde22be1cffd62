"""The runs of thesis chapter 4: a pulse or a slew, with feedback of the beam's torque by region of speed."""

from __future__ import annotations

import functools

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.controllers import make_controller
from flexarm_env.controllers.pd import DERIVATIVE, PROPORTIONAL
from flexarm_env.controllers.vibration import VibrationSuppression
from flexarm_env.thesis import arms, continuous
from flexarm_env.thesis.constants import PINNED_DELAY, TABLE
from flexarm_env.thesis.law import Law
from flexarm_env.thesis.runs import DURATION, INTERVAL, PULSE, Floats, Run, pulse, run

SLEW = np.deg2rad(100.0)
LIMIT = 5.0  # [A]
#: K_mo at high speed, K_mo at low speed, and friction compensation at low speed, of Figs. 4.15 to 4.18.
GAINS = {
    "pd": (0.0, 0.0, False),
    "vibration_dual": (-1.0, 1.0, True),
    "vibration_low": (0.0, 1.0, True),
    "vibration_high": (-1.0, 0.0, False),
}


def law(high: float, low: float, compensation: bool = False, slews: bool = False, delay: float = 0.0, amps: float = LIMIT) -> Law:
    """Build the law of eq. 4.1 or 4.2.

    Args:
        high: K_mo at high speed.
        low: K_mo at low speed.
        compensation: whether Coulomb friction is compensated at low speed.
        slews: whether PD slews to 100°; otherwise the pulse is applied.
        delay: t_d [s].
        amps: limit of the current [A].
    """
    extra = arms.combined().value("effects.coulomb.torque") / (TABLE["N"] * TABLE["kphi"]) if compensation else 0.0
    drive = {"target": SLEW, "proportional": PROPORTIONAL, "derivative": DERIVATIVE} if slews else {"pulse": PULSE}
    return Law(high=high, low=low, compensation=extra, delay=delay, limit=amps, **drive)


def _arm(friction: bool, limited: bool) -> Arm:
    arm = arms.combined() if friction else arms.pinned_only()
    return arm if limited else arm.with_values({"drive.limit": 0.0})


@functools.cache
def delayed(limited: bool, friction: bool = True) -> Run:
    """Run K_mo = −1, t_d = 0.026 s on the pinned model (Figs. 4.4, 4.5)."""
    control = law(-1.0, -1.0, delay=PINNED_DELAY, amps=LIMIT if limited else np.inf)
    return continuous.run(_arm(friction, limited), control)


@functools.cache
def without_friction(gain: float) -> Run:
    """Run K_mo = gain, t_d = 0 on the pinned model without dry friction (Fig. 4.7)."""
    return continuous.run(arms.pinned_only(), law(gain, gain))


@functools.cache
def sampled_without_friction() -> Run:
    """Run the same at K_mo = −1 with the product's controller every 5 ms."""
    arm, interval = arms.pinned_only(), 0.005
    controller = VibrationSuppression(
        arm.with_values({"drive.limit": 0.0}), interval, high_gain=-1.0, low_gain=-1.0, friction_compensation=False,
        proportional=0.0, derivative=0.0,
    )  # fmt: skip
    return run(arm, controller, feed=pulse(0.0, interval=interval), interval=interval)


@functools.cache
def with_friction(high: float, low: float, compensation: bool = False, limited: bool = True) -> Run:
    """Run K_mo by region of speed, t_d = 0, with friction (Figs. 4.8 to 4.14)."""
    return continuous.run(_arm(True, limited), law(high, low, compensation, amps=LIMIT if limited else np.inf))


@functools.cache
def slew(name: str) -> Run:
    """Run 100° under one of GAINS (Figs. 4.15 to 4.19)."""
    return continuous.run(arms.combined(), law(*GAINS[name], slews=True))


@functools.cache
def practical() -> Run:
    """Run 100° under the product's controller of the practical choice, mid-beam strain × K for M_o, every millisecond."""
    arm = arms.combined()
    target = np.full(round(DURATION / INTERVAL), SLEW)
    return run(arm, make_controller("vibration_practical", arm, INTERVAL), target=target)


@functools.cache
def stand_in(name: str) -> Run:
    """Run 100° on the noisy stand-in for the rig at 200 Hz, with one controller of the product (Figs. 4.20 to 4.22)."""
    arm, target = arms.stand_in(), np.full(round(DURATION / 0.005), SLEW)
    return run(arm, make_controller(name, arm, 0.005), target=target, interval=0.005, noise=0)


@functools.cache
def stand_in_delayed() -> Run:
    """Run K_mo = −1, t_d = 0.026 s on the noisy stand-in, its mid-beam gage in place of M_o, 5 A (Fig. 4.6)."""
    arm = arms.stand_in()
    options = {"high_gain": -1.0, "low_gain": -1.0, "delay": PINNED_DELAY, "proportional": 0.0, "derivative": 0.0}
    unlimited = arm.with_values({"drive.limit": 0.0})
    controller = make_controller("vibration_practical", unlimited, 0.005, **options)
    feed = pulse(0.0, interval=0.005)
    return run(arm, controller, feed=feed, interval=0.005, noise=0)


def swing(strain: Floats, start: float, stop: float, interval: float = INTERVAL) -> float:
    """Measure the strain from peak to peak between two times [V]."""
    return float(np.ptp(strain[round(start / interval) : round(stop / interval)]))


@functools.cache
def printed_torque() -> Run:
    """Run K_mo = −1, t_d = 0 without dry friction by eq. 4.4 as printed, EI twice in its first term (Fig. 4.7, erratum 5).

    N M_o = EI (6 EI v − 2 s) is a gain times the moment at one position x along the beam. There the coefficients of v and s
    in the moment, 6 − 12 x and 6 x − 2, have the ratio of 6 EI and −2.
    """
    stiffness = arms.combined().value("beam.bending_stiffness")
    place = (6.0 - 6.0 * stiffness) / (12.0 - 18.0 * stiffness)
    gain = -2.0 / (6.0 * place - 2.0)
    arm = arms.pinned_only().with_values({"sensors.strain_base.position": place})
    return continuous.run(arm, law(-gain, -gain))
