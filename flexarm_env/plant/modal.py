"""Block-diagonal form of the linear part, one for each way in which hub, motor and gears can be held.

A block is (p, P) with ṗ = P + f₁, Ṗ = −c₀ p − c₁ P + f₂: a vibration mode, or a real eigenvalue together with its
integral. It stays smooth where a rigid mode loses its damping and an eigenvector basis would break down.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.plant.beam import Matrix
from flexarm_env.plant.structure import (
    COMMAND,
    DRIVERS,
    GEAR_DAMPING_TIME,
    GEAR_SIDE,
    HELD_HUB,
    HELD_MOTOR,
    LinearModel,
    Structure,
)

HUB_STUCK, MOTOR_STUCK, GEAR_OPEN = 1, 2, 4
Places = NDArray[np.intp]


@dataclass
class Mode:
    """The arm while a given set of bodies is held; blocks as (c0, c1), rows on the block coordinates z."""

    c0: Matrix  # (blocks,)
    c1: Matrix  # (blocks,)
    physical: Matrix  # (states, 2 blocks): [q, q̇, e] from z
    held: Matrix  # (states, drivers): and from the held angles
    modal: Matrix  # (2 blocks, states): z from [q, q̇, e]
    forcing: Matrix  # (2 blocks, drivers)
    drag_forcing: Matrix  # (2 blocks, drag points)
    hold: Matrix  # (bodies, 2 blocks): torque that friction must resist, on a body that stands
    hold_drivers: Matrix  # (bodies, drivers)
    hold_drag: Matrix  # (bodies, drag points)


def blocks_of(dynamics: Matrix) -> tuple[Matrix, Matrix, Matrix, Matrix]:
    """Return (c0, c1, V, W) with ẋ = A x, x = V z and z = W x, z in blocks.

    Args:
        dynamics: A, (states, states) [1/s].
    """
    size = dynamics.shape[0]
    if not size:  # a rigid arm that is held
        return np.zeros(0), np.zeros(0), np.zeros((0, 0)), np.zeros((0, 0))
    moves = dynamics.any(axis=0)
    cyclic, inner = np.flatnonzero(~moves), np.flatnonzero(moves)
    values, vectors = np.linalg.eig(dynamics[inner[:, None], inner])
    upper = values.imag >= 0.0
    values, vectors = values[upper], vectors[:, upper]
    real = np.flatnonzero(values.imag == 0.0)
    vibrating = np.flatnonzero(values.imag != 0.0)
    c0, c1 = np.zeros(len(values)), -values.real
    v = np.zeros((size, 2 * len(values)))
    if len(real):
        found = vectors[:, real].real
        v[inner[:, None], 2 * real + 1] = found
        v[cyclic[:, None], 2 * real] = dynamics[cyclic[:, None], inner] @ found
    rates = dynamics[cyclic[:, None], inner]
    for k in vibrating:
        value, whole = values[k], np.zeros(size, complex)
        whole[inner] = vectors[:, k]
        whole[cyclic] = rates @ vectors[:, k] / value
        largest = whole[np.abs(whole[: size // 2 + 1]).argmax()]
        whole *= largest.conjugate() / abs(largest) ** 2
        v[:, 2 * k + 1] = whole.imag / value.imag
        v[:, 2 * k] = whole.real - value.real * whole.imag / value.imag
        c0[k], c1[k] = abs(value) ** 2, -2.0 * value.real
    cover = v[cyclic[:, None], 2 * real]
    if len(cyclic) and (len(real) < len(cyclic) or _rank(cover) < len(cyclic)):
        # a place that no real mode reaches keeps a block of its own, which never moves
        own = np.zeros((size, 2 * len(cyclic)))
        own[cyclic, 2 * np.arange(len(cyclic))] = 1.0
        real = np.concatenate([real, len(c0) + np.arange(len(cyclic))])
        v, c0, c1 = np.hstack([v, own]), np.append(c0, np.zeros(len(cyclic))), np.append(c1, np.zeros(len(cyclic)))
        cover = v[cyclic[:, None], 2 * real]
    return c0, c1, v, _inverse(v, real, vibrating, cyclic, inner, cover)


def _rank(matrix: Matrix) -> int:
    return int(matrix.any()) if len(matrix) == 1 else int(np.linalg.matrix_rank(matrix))


def _inverse(v: Matrix, real: Places, vibrating: Places, cyclic: Places, inner: Places, cover: Matrix) -> Matrix:
    w = np.zeros((v.shape[1], v.shape[0]))
    moving = real[v[:, 2 * real + 1].any(axis=0)]
    used = np.sort(np.concatenate([2 * moving + 1, 2 * vibrating, 2 * vibrating + 1]))
    w[used[:, None], inner] = np.linalg.inv(v[inner[:, None], used])
    if len(cyclic):
        spread = cover.T / np.sum(cover**2) if len(cyclic) == 1 else np.linalg.pinv(cover)
        w[2 * real[:, None], cyclic] = spread
        w[2 * real[:, None], inner] = -spread @ (v[cyclic[:, None], used] @ w[used[:, None], inner])
    return w


def mode_of(structure: Structure, model: LinearModel, which: int) -> Mode:
    """Decompose the arm in one mode.

    Args:
        structure: for the gears' stiffness, inertia and gap.
        model: the matrices.
        which: HUB_STUCK, MOTOR_STUCK and GEAR_OPEN added up.
    """
    size = len(model.names)
    free, held = _free_coordinates(model.names, which)
    stiffness, damping, drivers = model.stiffness.copy(), model.damping.copy(), model.input.copy()
    if "motor" in model.names and not which & GEAR_OPEN:
        _close_gears(structure, model, stiffness, damping, drivers)
    for column, place in held:
        drivers[:, column] -= stiffness[:, place]
    extra = model.extra.shape[0]
    inverse = np.linalg.inv(free.T @ model.mass @ free)
    positions, states = free.shape[1], 2 * free.shape[1] + extra
    dynamics = np.zeros((states, states))
    dynamics[:positions, positions : 2 * positions] = np.eye(positions)
    pull = _clean(free.T @ stiffness @ free, stiffness)
    rows = slice(positions, 2 * positions)
    dynamics[rows, :positions] = -inverse @ pull
    dynamics[rows, rows] = -inverse @ free.T @ damping @ free
    dynamics[rows, 2 * positions :] = inverse @ free.T @ model.from_extra
    into_extra = model.extra_from_motion
    dynamics[2 * positions :, :positions] = _clean(into_extra[:, :size] @ free, into_extra)
    dynamics[2 * positions :, rows] = into_extra[:, size:] @ free
    dynamics[2 * positions :, 2 * positions :] = model.extra
    c0, c1, v, w = blocks_of(dynamics)
    force = np.zeros((states, len(DRIVERS)))
    force[rows] = inverse @ free.T @ drivers
    force[2 * positions :] = model.extra_from_input
    for column, place in held:
        force[2 * positions :, column] += into_extra[:, place]
    drag = np.zeros((states, model.drag_force.shape[1]))
    drag[rows] = inverse @ free.T @ model.drag_force

    lift = np.zeros((2 * size + extra, states))
    lift[:size, :positions] = free
    lift[size : 2 * size, rows] = free
    lift[2 * size :, 2 * positions :] = np.eye(extra)
    at_hold = np.zeros((2 * size + extra, len(DRIVERS)))
    for column, place in held:
        at_hold[place, column] = 1.0

    bodies = 2 if "motor" in model.names else 1
    resist = np.zeros((bodies, states))
    resist[:, 2 * positions :] = model.from_extra[:bodies]
    resist[:, rows] -= (damping @ free)[:bodies]
    resist[:, :positions] -= (stiffness @ free)[:bodies]
    inertial = (model.mass @ free)[:bodies]
    resist -= inertial @ dynamics[rows]
    return Mode(
        c0=c0,
        c1=c1,
        physical=lift @ v,
        held=at_hold,
        modal=w @ _unlift(free, extra),
        forcing=w @ force,
        drag_forcing=w @ drag,
        hold=resist @ v,
        hold_drivers=drivers[:bodies] - inertial @ force[rows],
        hold_drag=model.drag_force[:bodies] - inertial @ drag[rows],
    )


def complete(free: Mode, held: Mode, body: int, speed: int) -> None:
    """Write into a mode what would hold a body that stands for a moment.

    Args:
        free: the mode, in which the body is free.
        held: the one that holds it, and the same others.
        body: 0 hub, 1 motor.
        speed: the row of the body's speed in [q, q̇, e], which is zero.
    """
    physical = free.physical.copy()
    physical[speed] = 0.0
    column = HELD_HUB + body
    free.hold[body] = held.hold[body] @ held.modal @ physical + held.hold_drivers[body, column] * physical[body]
    free.hold_drivers[body], free.hold_drag[body] = held.hold_drivers[body], held.hold_drag[body]
    free.hold_drivers[body, column] = 0.0


def _unlift(free: Matrix, extra: int) -> Matrix:
    """Return the matrix that picks the free coordinates, their rates and the extra states from [q, q̇, e]."""
    size, positions = free.shape
    pick = 2.0 * np.eye(size) - free if size == positions else free.T  # its inverse: one entry off the diagonal
    out = np.zeros((2 * positions + extra, 2 * size + extra))
    out[:positions, :size] = out[positions : 2 * positions, size : 2 * size] = pick
    out[2 * positions :, 2 * size :] = np.eye(extra)
    return out


def _clean(product: Matrix, scale: Matrix) -> Matrix:
    """Zero what is only rounding, so that a coordinate that nothing depends on is seen as such."""
    largest = np.abs(scale).max(initial=0.0)
    return np.where(np.abs(product) < 1e-15 * largest, 0.0, product)


def _free_coordinates(names: list[str], which: int) -> tuple[Matrix, list[tuple[int, int]]]:
    size = len(names)
    free = np.eye(size)
    held, gone = [], []
    if "motor" in names and not which & (HUB_STUCK | MOTOR_STUCK):
        free[1, 0] = 1.0  # the motor's coordinate becomes the windup of the gears
    if which & HUB_STUCK:
        gone.append(0)
        held.append((HELD_HUB, 0))
    if which & MOTOR_STUCK:
        gone.append(1)
        held.append((HELD_MOTOR, 1))
    return free[:, [place for place in range(size) if place not in gone]], held


def _close_gears(structure: Structure, model: LinearModel, stiffness: Matrix, damping: Matrix, drivers: Matrix) -> None:
    k = structure.gear_stiffness
    windup = np.zeros(len(model.names))
    windup[0], windup[1] = -1.0, 1.0
    stiffness += k * np.outer(windup, windup)
    damping += GEAR_DAMPING_TIME * k * np.outer(windup, windup)
    drivers[:, GEAR_SIDE] += k * 0.5 * structure.gear_gap / structure.gear_ratio * windup


__all__ = ["COMMAND", "GEAR_OPEN", "HUB_STUCK", "MOTOR_STUCK", "Mode", "blocks_of", "complete", "mode_of"]
