"""The flat arrays that the kernel reads, packed from the modes and the active laws."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flexarm_env.plant import layout as at
from flexarm_env.plant.active_laws import LAW_LISTS, ActiveLaw, law_lists
from flexarm_env.plant.assembly import assemble
from flexarm_env.plant.beam import Matrix, spread_out, turned
from flexarm_env.plant.blocks import blocks_of
from flexarm_env.plant.event_free_table import DEPTH, table_size
from flexarm_env.plant.force_parabola import influence_size
from flexarm_env.plant.modal import Decompose, Mode, complete, mode_of
from flexarm_env.plant.structure import (
    DRIVERS,
    HUB_TORQUE,
    MOTOR_TORQUE,
    SHORTEST_LAG,
    Key,
    LinearModel,
    Structure,
    exceeds,
    is_stacked,
    structure_of,
)

#: d, n, whole samples of delay.
Packed = tuple[Matrix, NDArray[np.int64], int]
RESPONSE = 5
#: Longest steps [s] over which a force that depends on the motion is fitted by one quartic; with drag, by a parabola.
LONGEST_STEP, LONGEST_STEP_WITH_DRAG = 5e-3, 2.5e-3
#: Parts of a sample over each of which a ramp of the drive is replaced by its mean.
RAMP_PARTS = 4
#: Ports of laws whose forces enter the modes' records.
LINEAR_PORTS = frozenset({"drag", "weight"})
#: Change of a force [Nm, N/m] at which the sweeps of its fit end.
TOLERANCE = 1e-12


def pack(
    structure: Structure,
    model: LinearModel,
    laws: Sequence[Sequence[ActiveLaw]],
    interval: float,
    decompose: Decompose = blocks_of,
) -> Packed:
    """Pack (d, n, whole samples of delay) for the kernel, without the tables that `prepare` writes.

    Args:
        structure: the linear quantities, of one arm or of stacked ones.
        model: their matrices.
        laws: those at work, for each arm; they differ in their parameters only.
        interval: sampling time [s].
        decompose: gives the blocks of the dynamics of each mode.

    Returns:
        d is (numbers,), or for stacked arms (arms, numbers).
    """
    active = laws[0]
    ports = frozenset(law.port for law in active) & LINEAR_PORTS
    varying = any(law.varies for law in active) or structure.has_limits
    if _is_cached(structure, decompose):
        linear = _linear_numbers_of_one(structure.key, ports, varying)
    else:
        linear = _linear_numbers(structure, model, ports, varying, decompose)
    n, arms = linear.counts.copy(), model.mass.shape[:-2]
    whole, early = split_delay(structure.input_delay, interval)
    parts = np.zeros((*arms, 2))
    parts[..., 0], parts[..., 1] = early, interval - early
    steps = np.where(parts > 0.0, np.maximum(np.ceil(parts / _longest_step(n, active, interval) - 1e-9), 1), 0)
    n[at.EARLY_SUBSTEPS], n[at.LATE_SUBSTEPS] = _common(steps.reshape(-1, 2).astype(int), "substeps of a sample")
    bodies = int(n[at.BODIES])
    lists, _ = law_lists(active, int(n[at.PARAMETERS]), bodies, model.signals)
    n[list(LAW_LISTS.values())] = at.COUNTS + np.cumsum([0, *map(len, lists[:-1])])
    parameters = np.array([law_lists(own, 0, bodies, model.signals)[1] for own in laws]).reshape(*arms, -1)
    head = _constants(structure, laws, interval, parts / np.maximum(steps, 1))
    d = np.concatenate([head, linear.values, parameters], axis=-1)
    return d, np.concatenate([n, np.array([number for rows in lists for number in rows], dtype=np.int64)]), whole


@dataclass(frozen=True)
class LinearNumbers:
    """What the linear quantities alone give.

    Attributes:
        counts: sizes, flags and places in n, without those of the laws and of the substeps.
        values: the records of the modes in d, (numbers,) or (arms, numbers).
    """

    counts: NDArray[np.int64]
    values: Matrix


@lru_cache(maxsize=32)
def _linear_numbers_of_one(key: Key, ports: frozenset[str], varying: bool) -> LinearNumbers:
    """Compute the numbers of one arm, cached: fits try many arms whose laws alone differ."""
    structure = structure_of(key)
    found = _linear_numbers(structure, assemble(structure), ports, varying, blocks_of)
    found.counts.flags.writeable = found.values.flags.writeable = False
    return found


def _linear_numbers(
    structure: Structure, model: LinearModel, ports: frozenset[str], varying: bool, decompose: Decompose
) -> LinearNumbers:
    """Compute what the linear quantities give, for laws of some ports, of which any or none varies while a body turns."""
    modes, points, arms = _modes(structure, model, decompose), _points(model, ports), model.mass.shape[:-2]
    n = _counts(structure, model, modes, len(points), varying)
    records = [_record(structure, model, mode, which, points, n) for which, mode in enumerate(modes)]
    place = 0
    for key, value in records[0].items():
        n[key] = place
        place += math.prod(value.shape[len(arms) :])
    n[at.STRIDE] = place
    n[at.PARAMETERS] = at.CONSTANTS + len(modes) * place
    values = [value.reshape(*arms, -1) for record in records for value in record.values()]
    return LinearNumbers(n, np.concatenate(values, axis=-1))


@dataclass(frozen=True)
class _Motion:
    """One arm, equal to another that moves in the same way: sensors that have no states are left out of the comparison.

    Attributes:
        key: of the quantities and of the sensors that have states.
        structure: the linear quantities.
        model: their matrices.
    """

    key: Key
    structure: Structure = field(compare=False)
    model: LinearModel = field(compare=False)


def _is_cached(structure: Structure, decompose: Decompose) -> bool:
    """Whether what the linear quantities give is kept: of one arm, decomposed in the ordinary way."""
    return decompose is blocks_of and not is_stacked(structure)


def _modes(structure: Structure, model: LinearModel, decompose: Decompose) -> Sequence[Mode]:
    """Decompose the arm in every mode."""
    if not _is_cached(structure, decompose):
        return _decomposed(structure, model, decompose)
    quantities, sensors = structure.key
    with_states = model.extra.shape[-1] > int(exceeds(structure.current_lag, SHORTEST_LAG))
    return _decomposed_one(_Motion((quantities, sensors if with_states else ()), structure, model))


@lru_cache(maxsize=16)
def _decomposed_one(motion: _Motion) -> Sequence[Mode]:
    """Decompose one arm, cached: fits try many arms whose sensors alone differ."""
    return _decomposed(motion.structure, motion.model, blocks_of)


def _decomposed(structure: Structure, model: LinearModel, decompose: Decompose) -> Sequence[Mode]:
    bodies = 2 if structure.separate_motor else 1
    count = 8 if exceeds(structure.gear_gap, 0.0) else 2**bodies
    modes = [mode_of(structure, model, which, decompose) for which in range(count)]
    for which, mode in enumerate(modes):
        for body in range(bodies):
            if not which >> body & 1:
                complete(mode, modes[which | 1 << body], body, len(model.names) + body)
    return modes


def _counts(structure: Structure, model: LinearModel, modes: Sequence[Mode], points: int, varying: bool) -> NDArray[np.int64]:
    """Fill the sizes and flags of n, without its places and lists."""
    n = np.zeros(at.COUNTS, dtype=np.int64)
    bodies = 2 if structure.separate_motor else 1
    n[at.BODIES], n[at.COORDINATES], n[at.POINTS] = bodies, len(model.names), points
    pulled = np.any(np.not_equal(structure.hub_stiffness, 0.0)) or structure.is_servo
    holds = pulled or np.any(model.extra_from_motion[..., 0])  # a filtered angle
    n[at.COUPLED] = bodies == 2 or holds
    n[at.TIP] = len(model.names) - 2 if structure.elements and not structure.vibrations else -1
    n[at.HUB_BODY] = bodies - 1 if structure.has_joint else 0
    n[at.DRIVE_FEEDBACK] = _feedback(structure)
    n[at.VARYING] = varying
    n[at.STEADY_BODIES] = 0 if varying else bodies
    n[at.BLOCKS] = max(mode.c0.shape[-1] for mode in modes)
    n[at.SIGNALS], n[at.STATES], n[at.DRIVERS] = len(model.signals), modes[0].physical.shape[-2], len(DRIVERS)
    n[at.MODES] = at.CONSTANTS
    return n


def _feedback(structure: Structure) -> int:
    """Tell how the drive's torque depends on the motion, as DRIVE_FEEDBACK does."""
    if structure.has_limits:
        return at.LIMITED
    if structure.is_servo:
        return at.PROPORTIONAL
    return at.OPPOSED if exceeds(structure.resistance, 0.0) else at.NO_FEEDBACK


def _longest_step(n: NDArray[np.int64], active: Sequence[ActiveLaw], interval: float) -> float:
    """Longest substep [s] over which the forces are fitted well enough."""
    longest = LONGEST_STEP_WITH_DRAG if n[at.POINTS] else LONGEST_STEP if n[at.VARYING] else np.inf
    if any(law.port == "ramp" for law in active):
        longest = min(longest, interval / RAMP_PARTS)
    return longest


def _constants(structure: Structure, laws: Sequence[Sequence[ActiveLaw]], interval: float, lengths: Matrix) -> Matrix:
    """Collect the single constants of d, for substeps of some lengths (…, 2) before and after the delay's end."""
    head = np.zeros((*lengths.shape[:-1], at.CONSTANTS))
    head[..., at.GAP] = structure.gear_gap / structure.gear_ratio
    head[..., at.TOLERANCE], head[..., at.INTERVAL], head[..., at.GEAR_RATIO] = TOLERANCE, interval, structure.gear_ratio
    head[..., at.EARLY_LENGTH], head[..., at.LATE_LENGTH] = lengths[..., 0], lengths[..., 1]
    head[..., at.LOAD_STIFFNESS] = structure.gear_stiffness
    head[..., at.LOAD_DAMPING] = structure.gear_damping_time * structure.gear_stiffness
    head[..., at.LOAD_BY_COMMAND] = structure.torque_by_command
    _add_drive(structure, head)
    two = structure.separate_motor
    shares = np.array([[law.motor_share if two else 0.0 for law in own if law.port == "friction"] for own in laws])
    head[..., at.HUB_FRICTION_SHARE] = np.sum(1.0 - shares, axis=-1).reshape(lengths.shape[:-1])
    head[..., at.MOTOR_FRICTION_SHARE] = np.sum(shares, axis=-1).reshape(lengths.shape[:-1])
    if not all(law.dry for law in laws[0]):
        share = structure.motor_viscous_share if two else 0.0
        head[..., at.HUB_VISCOUS], head[..., at.MOTOR_VISCOUS] = (1.0 - share) * structure.viscous, share * structure.viscous
    return head


def _add_drive(structure: Structure, head: Matrix) -> None:
    """Write the constants of a drive with feedback to those of d."""
    if _feedback(structure) == at.NO_FEEDBACK:
        return
    s = structure
    head[..., at.VOLTAGE_BY_ANGLE] = gain = s.command_gain * s.position_gain
    head[..., at.VOLTAGE_BY_COMMAND] = gain if s.is_servo else s.command_gain
    head[..., at.VOLTAGE_BY_SPEED] = s.command_gain * s.rate_gain
    head[..., at.TORQUE_BY_VOLTAGE], head[..., at.BACK_EMF] = s.torque_by_amp / s.resistance, s.back_emf
    if not s.has_limits:
        return
    head[..., at.LARGEST_VOLTAGE] = _or_none(s.largest_voltage if s.is_servo else 0.0)
    head[..., at.LARGEST_DROP] = _or_none(s.largest_current * s.resistance)
    head[..., at.SUPPLY_VOLTAGE] = _or_none(s.supply_voltage)
    head[..., at.SUPPLY_SHARE] = s.supply_resistance / s.resistance


def _or_none(limit: float | Matrix) -> Matrix:
    """Replace a limit of 0, which stands for none, by infinity."""
    return np.where(np.greater(limit, 0.0), limit, np.inf)


def _points(model: LinearModel, ports: frozenset[str]) -> NDArray[np.intp]:
    """Locate the forces on the beam that laws of some ports give: the drag at each point, and weight, the last."""
    last = model.beam_force.shape[-1] - 1
    return np.arange(0 if "drag" in ports else last, last + 1 if "weight" in ports else last)


def _size_of_tables(n: NDArray[np.int64]) -> int:
    """Count the numbers of a mode's tables of event-free steps or, with drag, of the forces' influence."""
    if n[at.POINTS]:
        return 4 * int(getattr(influence_size, "py_func", influence_size)(n))
    levels = (DEPTH + 1 if n[at.VARYING] else 1) if n[at.VARYING] or n[at.BODIES] == 2 else 0
    return 2 * levels * int(getattr(table_size, "py_func", table_size)(n))


def split_delay(delay: ArrayLike, interval: float) -> tuple[int, Matrix]:
    """Split a delay into whole samples and the rest [s], or the rests of some with as many; the whole part may be negative.

    Raises:
        ValueError: for delays of different whole parts.
    """
    whole = int(_common(np.floor(np.ravel(delay) / interval + 1e-9), "whole samples of delay"))
    rest = np.asarray(delay) - whole * interval
    return whole, np.where(rest > 1e-9 * interval, rest, 0.0)


def _common(counts: Matrix | NDArray[np.int64], what: str) -> Matrix | NDArray[np.int64]:
    """Look up the counts (arms, …) that all stacked arms share.

    Raises:
        ValueError: where they differ.
    """
    if (counts != counts[0]).any():
        raise ValueError(f"stacked arms differ in their {what}: build a plant of their own")
    common: Matrix | NDArray[np.int64] = counts[0]
    return common


def _record(
    structure: Structure, model: LinearModel, mode: Mode, which: int, points: NDArray[np.intp], n: NDArray[np.int64]
) -> dict[int, Matrix]:
    """Compute the parts of one mode's record in d, by their places in n."""
    size, bodies, blocks = len(model.names), int(n[at.BODIES]), int(n[at.BLOCKS])
    torques = [HUB_TORQUE, MOTOR_TORQUE][:bodies]
    physical = _wide(mode.physical, blocks)
    arms = mode.c0.shape[:-1]
    c0, c1 = (np.concatenate([c, np.zeros((*arms, blocks - c.shape[-1]))], axis=-1) for c in (mode.c0, mode.c1))
    hold, held_angles = _wide(mode.hold, blocks), np.array([float((which >> body) & 1) for body in range(bodies)])
    angle, speed = physical[..., :bodies, :], physical[..., size : size + bodies, :]
    windup = angle[..., -1:, :] - angle[..., :1, :]
    mesh = windup + spread_out(structure.gear_damping_time) * (speed[..., -1:, :] - speed[..., :1, :])
    forces = np.concatenate([mode.forcing[..., torques], mode.beam_forcing[..., points]], axis=-1)
    return {
        at.C0: c0,
        at.C1: c1,
        at.RESPONSES: np.zeros((*arms, 4 * blocks * RESPONSE)),
        at.QUIET_TABLE: np.zeros((*arms, 2 * blocks * at.QUIET_SIZE)),
        at.STEP_TABLES: np.zeros((*arms, _size_of_tables(n))),
        at.PHYSICAL: physical,
        at.MODAL: turned(_wide(turned(mode.modal), blocks)),
        at.FORCING: _wide(turned(mode.forcing), blocks),
        at.FORCE_COLUMNS: _wide(turned(forces), blocks),
        at.SPEED: speed,
        at.SPEED_WEIGHT: _weights(speed, c0, c1),
        at.ANGLE: angle,
        at.HOLDS_ANGLE: np.broadcast_to(held_angles, (*arms, bodies)),
        at.WINDUP: windup,
        at.WINDUP_WEIGHT: _weights(windup, c0, c1),
        at.MESH: mesh,
        at.MESH_WEIGHT: _weights(mesh, c0, c1),
        at.HOLD: hold,
        at.HOLD_WEIGHT: _weights(hold, c0, c1),
        at.HOLD_DRIVERS: mode.hold_drivers,
        at.HOLD_FORCES: np.concatenate([mode.hold_drivers[..., torques], mode.hold_beam[..., points]], axis=-1),
        at.DRAG_VELOCITY: model.beam_velocity[..., points, :] @ physical[..., size : 2 * size, :],
        at.OUTPUT: model.output @ physical,
        at.OUTPUT_DRIVERS: model.output @ mode.held + model.output_from_input,
    }


def _wide(matrix: Matrix, blocks: int) -> Matrix:
    wide = np.zeros((*matrix.shape[:-1], 2 * blocks))
    wide[..., : matrix.shape[-1]] = matrix
    return wide


def _weights(rows: Matrix, c0: Matrix, c1: Matrix) -> Matrix:
    """Compute the weights of the blocks' amplitudes in the bound of each row's curvature."""
    a = rows[..., 0::2] - rows[..., 1::2] * c1[..., None, :]
    weights: Matrix = np.sqrt(a**2 + rows[..., 1::2] ** 2 * c0[..., None, :])
    return weights
