"""The runs of thesis chapter 3: the models after 3 A from 0.5 to 1.0 s."""

from __future__ import annotations

import functools
from collections.abc import Callable

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.controllers import make_controller
from flexarm_env.thesis import arms, printed
from flexarm_env.thesis.constants import INERTIA_CHANGE, TABLE
from flexarm_env.thesis.fixed_step import Model, clamped, simulate
from flexarm_env.thesis.frequency import Vibration, vibration
from flexarm_env.thesis.law import Law
from flexarm_env.thesis.runs import DURATION, INTERVAL, PULSE, Floats, Run, pulse, run

#: Beginning of the pulse [s].
START = 0.5
#: Between these times [s] after the pulse the hub of every model moves without a stop.
MOVING = (1.08, 2.0)
#: Step [s] of the clamped model: a tenth of it changes the results by less than 1e-4.
CLAMPED_STEP = 1e-5


def lighter(arm: Arm) -> Arm:
    """Decrease J_m by 0.0003 kg m²."""
    return arms.lighter_motor(arm, -INERTIA_CHANGE)


def heavier(arm: Arm) -> Arm:
    """Increase J_m by 0.0003 kg m²."""
    return arms.lighter_motor(arm, INERTIA_CHANGE)


MODELS: dict[str, Callable[[], Arm]] = {
    "combined": arms.combined,
    "coulomb": arms.coulomb_only,
    "pinned": arms.pinned_only,
    "lighter": lambda: lighter(arms.coulomb_only()),
    "heavier": lambda: heavier(arms.coulomb_only()),
    "printed": lambda: printed.arm(arms.coulomb_only()),
    "printed, lighter": lambda: printed.arm(lighter(arms.coulomb_only())),
    "damped": arms.damped_beam,
    "payload": arms.loaded,
    "stand-in": arms.stand_in,
}


@functools.cache
def after_pulse(model: str) -> Run:
    """Run one of MODELS after the pulse."""
    return run(MODELS[model](), feed=pulse(START))


@functools.cache
def slew() -> Run:
    """Run the stand-in for the rig, with noise, under PD to 100°, at 200 Hz (Fig. 3.1)."""
    arm = arms.stand_in()
    controller = make_controller("pd", arm, 0.005)
    return run(arm, controller, target=np.full(1000, np.deg2rad(100.0)), interval=0.005, noise=0)


def moving(model: str, signal: str = "strain_mid") -> Vibration:
    """Estimate the vibration in a signal while the hub moves, after the pulse."""
    made = after_pulse(model)
    return vibration(made.time, made.signals[signal], *MOVING, (4.0, 16.0))


def stuck(model: str) -> Vibration:
    """Estimate the vibration of the strain after the hub's last stop."""
    made = after_pulse(model)
    return vibration(made.time, made.strain, made.rest(), DURATION, (0.8, 4.0))


def double_inertia() -> float:
    """Compute N² J of eq. 2.1, which includes the arm's inertia, as in the thesis's clamped model [kg m²]."""
    return TABLE["N"] ** 2 * TABLE["J_m"] + TABLE["J_a"]


def hub_inertia() -> float:
    """Compute N² J_m + J_hub, motor and hub alone [kg m²]."""
    return TABLE["N"] ** 2 * TABLE["J_m"] + TABLE["J_hub"]


@functools.cache
def clamped_pulse(inertia: float) -> Floats:
    """Run the clamped model with friction after the pulse (Fig. 3.7), as fixed_step.simulate.

    Args:
        inertia: of its hub [kg m²].
    """
    return simulate(clamped(inertia), Law(pulse=PULSE, pulse_start=START), DURATION, CLAMPED_STEP, INTERVAL)


@functools.cache
def clamped_control(inertia: float, gain: float, delay: float = 0.0) -> Floats:
    """Run the clamped model without dry friction under eq. 4.1 (Figs. 4.2 and 4.3), as fixed_step.simulate.

    Args:
        inertia: of its hub [kg m²].
        gain: K_mo.
        delay: t_d [s].
    """
    return simulate(_plain(inertia), Law(pulse=PULSE, high=gain, low=gain, delay=delay), DURATION, CLAMPED_STEP, INTERVAL)


def _plain(inertia: float) -> Model:
    return clamped(inertia).without_friction()
