"""The flat arrays that the kernel reads, packed from the modes and the active laws."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flexarm_env.plant import layout as at
from flexarm_env.plant.beam import Matrix, spread_out, turned
from flexarm_env.plant.event_free_table import DEPTH, table_size
from flexarm_env.plant.modal import Mode, complete, mode_of
from flexarm_env.plant.structure import DRIVERS, HUB_TORQUE, MOTOR_TORQUE, LinearModel, Structure, exceeds

RESPONSE = 5
#: Longest steps [s] over which a force that depends on the motion is fitted by one quartic; with drag, by a parabola.
LONGEST_STEP, LONGEST_STEP_WITH_DRAG = 5e-3, 2.5e-3
#: Parts of a sample in each of which a drive that is on its way to the next command is taken by its mean.
RAMP_PARTS = 4
#: Change of a force [Nm, N/m] below which the sweeps that fit it stop.
TOLERANCE = 1e-12
LAW_LISTS = {
    "friction": at.FRICTION_LAWS,
    "factor": at.FACTOR_LAWS,
    "presliding": at.PRESLIDING_LAWS,
    "torque": at.TORQUE_LAWS,
    "weight": at.WEIGHT_LAWS,
    "drag": at.DRAG_LAWS,
    "drive": at.DRIVE_LAWS,
    "ramp": at.RAMP_LAWS,
    "sensor": at.SENSOR_LAWS,
}


@dataclass(frozen=True)
class ActiveLaw:
    """One law at work: its place in the catalogue's list of laws, its parameters in the law's order.

    `varies` says that it changes while a body turns one way, so that the force must be fitted over each step.
    `motor_share` is the part of it that acts on the motor where motor and hub are two bodies, `reads` the signals that it
    changes.
    """

    kind: int
    port: str
    parameters: tuple[float, ...]
    varies: bool
    motor_share: float = 0.0
    reads: tuple[str, ...] = ()


def pack(
    structure: Structure, model: LinearModel, laws: Sequence[Sequence[ActiveLaw]], interval: float
) -> tuple[Matrix, NDArray[np.int64], int]:
    """Return (d, n, whole samples of delay) for the kernel; the blocks' responses are still to be filled in.

    Args:
        structure: the linear quantities, of one arm or of stacked ones.
        model: their matrices.
        laws: those at work, for each arm; they differ in their parameters only.
        interval: sampling time [s].

    Returns:
        d is (numbers,), or for stacked arms (arms, numbers).
    """
    active, arms = laws[0], model.mass.shape[:-2]
    bodies = 2 if structure.separate_motor else 1
    count = 8 if exceeds(structure.gear_gap, 0.0) else 2**bodies
    modes = [mode_of(structure, model, which) for which in range(count)]
    for which, mode in enumerate(modes):
        for body in range(bodies):
            if not which >> body & 1:
                complete(mode, modes[which | 1 << body], body, len(model.names) + body)
    varying = any(law.varies for law in active)
    points = _points(model, active)
    whole, early = split_delay(structure.input_delay, interval)
    n = np.zeros(at.COUNTS, dtype=np.int64)
    blocks = max(mode.c0.shape[-1] for mode in modes)
    n[at.BODIES], n[at.COORDINATES], n[at.POINTS] = bodies, len(model.names), len(points)
    n[at.COUPLED] = bodies == 2 or np.any(np.not_equal(structure.hub_stiffness, 0.0))
    n[at.VARYING] = varying
    n[at.STEADY_BODIES] = 0 if varying else bodies
    n[at.BLOCKS] = blocks
    n[at.SIGNALS], n[at.STATES], n[at.DRIVERS] = len(model.signals), modes[0].physical.shape[-2], len(DRIVERS)
    n[at.MODES] = at.CONSTANTS
    step_tables = _size_of_tables(n)
    records = [_record(structure, model, mode, which, points, blocks, step_tables) for which, mode in enumerate(modes)]
    place = 0
    for key, value in records[0].items():
        n[key] = place
        place += math.prod(value.shape[len(arms) :])
    n[at.STRIDE] = place
    longest = LONGEST_STEP_WITH_DRAG if len(points) else LONGEST_STEP if varying else np.inf
    if any(law.port == "ramp" for law in active):
        longest = min(longest, interval / RAMP_PARTS)
    parts = np.zeros((*arms, 2))
    parts[..., 0], parts[..., 1] = early, interval - early
    steps = np.where(parts > 0.0, np.maximum(np.ceil(parts / longest - 1e-9), 1), 0)
    n[at.EARLY_SUBSTEPS], n[at.LATE_SUBSTEPS] = steps.reshape(-1, 2)[0].astype(int)
    n[at.PARAMETERS] = at.CONSTANTS + count * place
    lists, _ = _law_lists(active, int(n[at.PARAMETERS]), bodies, model.signals)
    named: list[int] = []
    for key, rows in zip(LAW_LISTS.values(), lists, strict=True):
        n[key] = at.COUNTS + len(named)
        named += rows
    head = np.zeros((*arms, at.CONSTANTS))
    parameters = np.array([_law_lists(own, 0, bodies, model.signals)[1] for own in laws]).reshape(*arms, -1)
    values = [value.reshape(*arms, -1) for record in records for value in record.values()]
    d = np.concatenate([head, *values, parameters], axis=-1)
    lengths = parts / np.maximum(steps, 1)
    d[..., at.GAP] = structure.gear_gap / structure.gear_ratio
    d[..., at.TOLERANCE], d[..., at.INTERVAL], d[..., at.GEAR_RATIO] = TOLERANCE, interval, structure.gear_ratio
    d[..., at.EARLY_LENGTH], d[..., at.LATE_LENGTH] = lengths[..., 0], lengths[..., 1]
    d[..., at.LOAD_STIFFNESS] = structure.gear_stiffness
    d[..., at.LOAD_DAMPING] = structure.gear_damping_time * structure.gear_stiffness
    d[..., at.LOAD_BY_COMMAND] = structure.torque_by_command
    shares = np.array([[law.motor_share if bodies == 2 else 0.0 for law in own if law.port == "friction"] for own in laws])
    d[..., at.HUB_RUBS] = np.sum(1.0 - shares, axis=-1).reshape(arms)
    d[..., at.MOTOR_RUBS] = np.sum(shares, axis=-1).reshape(arms)
    return d, np.concatenate([n, np.array(named, dtype=np.int64)]), whole


def _points(model: LinearModel, active: Sequence[ActiveLaw]) -> NDArray[np.intp]:
    """Places among the forces on the beam of those that laws ask for: the drag at each point, and weight, the last."""
    ports, last = {law.port for law in active}, model.beam_force.shape[-1] - 1
    return np.arange(0 if "drag" in ports else last, last + 1 if "weight" in ports else last)


def _size_of_tables(n: NDArray[np.int64]) -> int:
    """Numbers of a mode's tables of slides, or, with drag, of what forces move."""
    if n[at.POINTS]:
        return int(12 * (2 * n[at.BODIES] + n[at.POINTS]) * (n[at.BODIES] + n[at.POINTS]))
    levels = (DEPTH + 1 if n[at.VARYING] else 1) if n[at.VARYING] or n[at.BODIES] == 2 else 0
    return 2 * levels * int(getattr(table_size, "py_func", table_size)(n))


def split_delay(delay: ArrayLike, interval: float) -> tuple[int, Matrix]:
    """Return whole samples and the rest [s] of a delay, or the rests of some with as many; the whole part may be negative."""
    whole = int(np.floor(np.ravel(delay)[0] / interval + 1e-9))
    rest = np.asarray(delay) - whole * interval
    return whole, np.where(rest > 1e-9 * interval, rest, 0.0)


def _record(
    structure: Structure, model: LinearModel, mode: Mode, which: int, points: NDArray[np.intp], blocks: int, step_tables: int
) -> dict[int, Matrix]:
    size, bodies = len(model.names), 2 if structure.separate_motor else 1
    torques = [HUB_TORQUE, MOTOR_TORQUE][:bodies]
    physical = _wide(mode.physical, blocks)
    arms = mode.c0.shape[:-1]
    none = np.zeros((*arms, blocks - mode.c0.shape[-1]))
    c0, c1 = np.concatenate([mode.c0, none], axis=-1), np.concatenate([mode.c1, none], axis=-1)
    hold = _wide(mode.hold, blocks)
    angle, speed = physical[..., :bodies, :], physical[..., size : size + bodies, :]
    windup = angle[..., -1:, :] - angle[..., :1, :]
    mesh = windup + spread_out(structure.gear_damping_time) * (speed[..., -1:, :] - speed[..., :1, :])
    forces = np.concatenate([mode.forcing[..., torques], mode.beam_forcing[..., points]], axis=-1)
    held_angles = np.array([float((which >> body) & 1) for body in range(bodies)])
    return {
        at.C0: c0,
        at.C1: c1,
        at.RESPONSES: np.zeros((*arms, 4 * blocks * RESPONSE)),
        at.QUIET_TABLE: np.zeros((*arms, 2 * blocks * at.QUIET_SIZE)),
        at.STEP_TABLES: np.zeros((*arms, step_tables)),
        at.PHYSICAL: physical,
        at.MODAL: turned(_wide(turned(mode.modal), blocks)),
        at.FORCING: turned(_wide(turned(mode.forcing), blocks)),
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
    """How much each block's amplitude can bend each row's value: what curvature_bound sums up."""
    a = rows[..., 0::2] - rows[..., 1::2] * c1[..., None, :]
    weights: Matrix = np.sqrt(a**2 + rows[..., 1::2] ** 2 * c0[..., None, :])
    return weights


def _law_lists(
    active: Sequence[ActiveLaw], start: int, bodies: int, signals: Sequence[str]
) -> tuple[list[list[int]], list[float]]:
    """Counts, kinds and places of the laws by port, and their parameters, each law's after hub's and motor's share.

    A sensor's law stands once for each signal that it changes, whose number comes third.
    """
    parameters: list[float] = []
    lists = []
    for port in list(LAW_LISTS)[:-1]:
        laws = [law for law in active if law.port == port]
        rows = [len(laws)]
        for law in laws:
            share = law.motor_share if bodies == 2 else 0.0
            parameters += [1.0 - share, share]
            rows += [law.kind, start + len(parameters)]
            parameters += law.parameters
        lists.append(rows)
    rows = [0]
    for law in (law for law in active if law.port == "sensor"):
        changed = [number for number, signal in enumerate(signals) if signal in law.reads]
        rows[0] += len(changed)
        for number in changed:
            rows += [law.kind, start + len(parameters), number]
        parameters += law.parameters
    return [*lists, rows], parameters
