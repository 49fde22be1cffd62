"""State-space model of the arm while its hub moves or is stuck, for the design of controllers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import expm

from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.plant.assembly import assemble
from flexarm_env.plant.beam import Matrix
from flexarm_env.plant.modal import HUB_STUCK, MOTOR_STUCK, mode_of
from flexarm_env.plant.structure import COMMAND, HELD_HUB, HELD_MOTOR, HUB_TORQUE, ONE

if TYPE_CHECKING:
    from flexarm_env.arm import Arm

MODES = ("moving", "stuck")
INPUTS = ("command", "hub_torque", "weight")
#: A pair of eigenvalues with a higher damping ratio is not counted as a vibration.
LARGEST_DAMPING = 0.95
#: Eigenvalues below this [rad/s] belong to a rigid motion.
SLOWEST = 1e-6


@dataclass(frozen=True, eq=False)  # arrays have no single answer to ==
class LinearArm:
    """ẋ = dynamics x + forcing u, x[k+1] = transition x[k] + response u[k], y = output x + offset.

    Attributes:
        mode: "moving" or "stuck". Stuck, the hub's angle stays in the state as a constant and its speed as zero.
        interval: sampling time; inputs are held over it [s].
        states: names of the states: "hub", "deflection_1", … [rad, m], their rates "hub_rate", …, and "extra_1", … for
            lagged current and filtered sensors.
        inputs: "command" [A or V], "hub_torque", an external torque on the hub [Nm], and "weight", a force in proportion to mass
            on beam and payload, by its torque about the axis without payload [Nm].
        outputs: names of the signals.
        dynamics: (states, states) [1/s].
        forcing: (states, inputs).
        transition: (states, states).
        response: (states, inputs).
        output: (outputs, states).
        offset: (outputs,) readings of an arm at rest at angle 0.
    """

    mode: str
    interval: float
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    dynamics: Matrix
    forcing: Matrix
    transition: Matrix
    response: Matrix
    output: Matrix
    offset: Matrix

    def vibrations(self) -> tuple[Matrix, Matrix]:
        """Compute natural frequencies (vibrations,) [Hz], rising, and damping ratios (vibrations,)."""
        rates = np.linalg.eigvals(self.dynamics)
        rates = rates[(rates.imag > SLOWEST) & (-rates.real < LARGEST_DAMPING * np.abs(rates))]
        rates = rates[np.argsort(np.abs(rates))]
        return np.abs(rates) / (2.0 * np.pi), -rates.real / np.abs(rates)


def linearise(arm: Arm, mode: str, interval: float) -> LinearArm:
    """Linearise an arm without dry friction, backlash, saturation and dead time (thesis eqs. 3.9 to 3.14).

    Args:
        arm: with all its linear effects.
        mode: "moving" (pinned beam, hub free) or "stuck" (clamped beam, hub held).
        interval: sampling time [s].

    Raises:
        InputError: for another mode or an interval that is not a positive number.

    Example:
        >>> from flexarm_env import Arm
        >>> model = linearise(Arm.load("thesis"), "moving", 0.005)
        >>> model.states[:2], model.transition.shape, model.output.shape
        (('hub', 'deflection_1'), (6, 6), (4, 6))
    """
    if mode not in MODES:
        raise InputError(f"no mode '{mode}'{did_you_mean(mode, MODES)}")
    if not (np.isfinite(interval) and interval > 0.0):
        raise InputError(f"interval {interval:g} s; give a positive number such as 0.005")
    model = assemble(structure := arm.structure())
    bodies = 2 if structure.separate_motor else 1
    found = mode_of(structure, model, sum((HUB_STUCK, MOTOR_STUCK)[:bodies]) if mode == "stuck" else 0)
    drivers = np.column_stack([found.forcing[:, [COMMAND, HUB_TORQUE]], found.beam_forcing[:, -1]])
    width, states = found.modal.shape
    blocks = _blocks(found.c0, found.c1)
    # The angles of held bodies are inputs of the mode, and states of this model.
    driven, held = np.zeros((width, states)), np.zeros((states, states))
    for body, driver in enumerate((HELD_HUB, HELD_MOTOR)[:bodies] if mode == "stuck" else ()):
        driven[:, body], held[:, body] = found.forcing[:, driver], found.held[:, driver]
    whole = np.zeros((width + states + len(INPUTS),) * 2)
    whole[:width] = np.hstack([blocks, driven, drivers])
    step = expm(whole * interval)[:width]
    lift = found.physical
    return LinearArm(
        mode=mode,
        interval=interval,
        states=(*model.names, *(f"{name}_rate" for name in model.names), *_extra(model.extra.shape[0])),
        inputs=INPUTS,
        outputs=tuple(model.signals),
        dynamics=lift @ (blocks @ found.modal + driven),
        forcing=lift @ drivers,
        transition=lift @ (step[:, :width] @ found.modal + step[:, width : width + states]) + held,
        response=lift @ step[:, width + states :],
        output=model.output,
        offset=model.output_from_input[:, ONE].copy(),
    )


def share_of_payload(arm: Arm) -> float:
    """Compute the torque of the payload's weight about the axis over that of the arm's own weight.

    Example:
        >>> from flexarm_env import Arm
        >>> arm = Arm.load("thesis").with_effect("payload", mass=0.1)  # on a beam of 0.42381 kg, whose half counts
        >>> round(share_of_payload(arm), 4)
        0.4719
    """
    # the last column is the force of a weight of 1 Nm about the axis without payload
    return float(assemble(arm.structure()).beam_force[0, -1]) - 1.0


def _blocks(c0: Matrix, c1: Matrix) -> Matrix:
    """Assemble the dynamics of the mode's blocks, (2 blocks, 2 blocks)."""
    dynamics, place = np.zeros((2 * len(c0), 2 * len(c0))), np.arange(0, 2 * len(c0), 2)
    dynamics[place, place + 1], dynamics[place + 1, place], dynamics[place + 1, place + 1] = 1.0, -c0, -c1
    return dynamics


def _extra(count: int) -> list[str]:
    return [f"extra_{place + 1}" for place in range(count)]
