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
    hold: Matrix  # (bodies, 2 blocks): torque that friction must resist, on a held body
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
    cyclic = np.flatnonzero(~dynamics.any(axis=0))
    inner = np.setdiff1d(np.arange(size), cyclic)
    values, vectors = np.linalg.eig(dynamics[np.ix_(inner, inner)])
    rates = dynamics[np.ix_(cyclic, inner)]
    c0, c1, first, second = [], [], [], []
    real = []
    for value, vector in zip(values, vectors.T, strict=True):
        if value.imag < 0.0:
            continue
        p, big_p = np.zeros(size), np.zeros(size)
        if value.imag == 0.0:
            real.append(len(c0))
            big_p[inner] = vector.real
            p[cyclic] = rates @ vector.real
            c0.append(0.0)
            c1.append(-value.real)
        else:
            whole = np.zeros(size, complex)
            whole[inner] = vector
            whole[cyclic] = rates @ vector / value
            largest = whole[np.abs(whole[: size // 2 + 1]).argmax()]
            whole *= largest.conjugate() / abs(largest) ** 2
            big_p[:] = whole.imag / value.imag
            p[:] = whole.real - value.real * whole.imag / value.imag
            c0.append(abs(value) ** 2)
            c1.append(-2.0 * value.real)
        first.append(p)
        second.append(big_p)
    count = len(real)
    cover = np.array([first[k][cyclic] for k in real]).reshape(count, len(cyclic)).T
    if len(cyclic) and (count < len(cyclic) or np.linalg.matrix_rank(cover) < len(cyclic)):
        for place in cyclic:  # a place that no real mode reaches keeps a block of its own, which never moves
            real.append(len(c0))
            first.append(np.eye(size)[place])
            second.append(np.zeros(size))
            c0.append(0.0)
            c1.append(0.0)
        cover = np.array([first[k][cyclic] for k in real]).T
    v = np.stack([column for pair in zip(first, second, strict=True) for column in pair], axis=1)
    w = _inverse(v, real, [k for k in range(len(c0)) if np.any(second[k])], cyclic, inner, cover)
    return np.array(c0), np.array(c1), v, w


def _inverse(
    v: Matrix, real: list[int], moving: list[int], cyclic: Places, inner: Places, cover: Matrix
) -> Matrix:
    w = np.zeros((v.shape[1], v.shape[0]))
    used = [c for k in moving for c in ((2 * k + 1,) if k in real else (2 * k, 2 * k + 1))]
    w[np.ix_(used, inner)] = np.linalg.inv(v[np.ix_(inner, used)])
    if len(cyclic):
        spread = np.linalg.pinv(cover)
        places = [2 * k for k in real]
        w[np.ix_(places, cyclic)] = spread
        w[np.ix_(places, inner)] = -spread @ (v[np.ix_(cyclic, used)] @ w[np.ix_(used, inner)])
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


def _unlift(free: Matrix, extra: int) -> Matrix:
    """Return the matrix that picks the free coordinates, their rates and the extra states from [q, q̇, e]."""
    size, positions = free.shape
    pick = np.linalg.inv(free) if size == positions else free.T
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
    return np.delete(free, gone, axis=1), held


def _close_gears(structure: Structure, model: LinearModel, stiffness: Matrix, damping: Matrix, drivers: Matrix) -> None:
    k = structure.gear_stiffness
    windup = np.zeros(len(model.names))
    windup[0], windup[1] = -1.0, 1.0
    stiffness += k * np.outer(windup, windup)
    damping += GEAR_DAMPING_TIME * k * np.outer(windup, windup)
    drivers[:, GEAR_SIDE] += k * 0.5 * structure.gear_gap / structure.gear_ratio * windup


__all__ = ["COMMAND", "GEAR_OPEN", "HUB_STUCK", "MOTOR_STUCK", "Mode", "blocks_of", "mode_of"]
