"""Block-diagonal form of the linear part, one for each way in which hub, motor and gears can be held."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexarm_env.plant.beam import Matrix, spread_out
from flexarm_env.plant.blocks import blocks_of
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


@dataclass
class Mode:
    """The arm while a given set of bodies is held; blocks as (c0, c1), rows on the block coordinates z.

    Of stacked arms (see plant/structure.py) all but `held` have one more axis in front, the arms.
    """

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


def mode_of(structure: Structure, model: LinearModel, which: int) -> Mode:
    """Decompose the arm in one mode.

    Args:
        structure: for the gears' stiffness, inertia and gap.
        model: the matrices.
        which: HUB_STUCK, MOTOR_STUCK and GEAR_OPEN added up.
    """
    size = len(model.names)
    free, held = _free_coordinates(model.names, which)
    arms, stiffness, damping, drivers = model.mass.shape[:-2], model.stiffness.copy(), model.damping.copy(), model.input.copy()
    if "motor" in model.names and not which & GEAR_OPEN:
        _close_gears(structure, model, stiffness, damping, drivers)
    for column, place in held:
        drivers[..., column] -= stiffness[..., place]
    extra = model.extra.shape[-1]
    inverse = np.linalg.inv(free.T @ model.mass @ free)
    positions, states = free.shape[1], 2 * free.shape[1] + extra
    dynamics = np.zeros((*arms, states, states))
    dynamics[..., :positions, positions : 2 * positions] = np.eye(positions)
    pull = _clean(free.T @ stiffness @ free, stiffness)
    rows = slice(positions, 2 * positions)
    dynamics[..., rows, :positions] = -inverse @ pull
    dynamics[..., rows, rows] = -inverse @ free.T @ damping @ free
    dynamics[..., rows, 2 * positions :] = inverse @ free.T @ model.from_extra
    into_extra = model.extra_from_motion
    dynamics[..., 2 * positions :, :positions] = _clean(into_extra[..., :size] @ free, into_extra)
    dynamics[..., 2 * positions :, rows] = into_extra[..., size:] @ free
    dynamics[..., 2 * positions :, 2 * positions :] = model.extra
    c0, c1, v, w = blocks_of(dynamics)
    force = np.zeros((*arms, states, len(DRIVERS)))
    force[..., rows, :] = inverse @ free.T @ drivers
    force[..., 2 * positions :, :] = model.extra_from_input
    for column, place in held:
        force[..., 2 * positions :, column] += into_extra[..., place]
    drag = np.zeros((*arms, states, model.drag_force.shape[-1]))
    drag[..., rows, :] = inverse @ free.T @ model.drag_force

    lift = np.zeros((2 * size + extra, states))
    lift[:size, :positions] = free
    lift[size : 2 * size, rows] = free
    lift[2 * size :, 2 * positions :] = np.eye(extra)
    at_hold = np.zeros((2 * size + extra, len(DRIVERS)))
    for column, place in held:
        at_hold[place, column] = 1.0

    bodies = 2 if "motor" in model.names else 1
    resist = np.zeros((*arms, bodies, states))
    resist[..., 2 * positions :] = model.from_extra[..., :bodies, :]
    resist[..., rows] -= (damping @ free)[..., :bodies, :]
    resist[..., :positions] -= (stiffness @ free)[..., :bodies, :]
    inertial = (model.mass @ free)[..., :bodies, :]
    resist -= inertial @ dynamics[..., rows, :]
    return Mode(
        c0=c0,
        c1=c1,
        physical=lift @ v,
        held=at_hold,
        modal=w @ _unlift(free, extra),
        forcing=w @ force,
        drag_forcing=w @ drag,
        hold=resist @ v,
        hold_drivers=drivers[..., :bodies, :] - inertial @ force[..., rows, :],
        hold_drag=model.drag_force[..., :bodies, :] - inertial @ drag[..., rows, :],
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
    physical[..., speed, :] = 0.0
    own, column = [body], HELD_HUB + body
    by_angle = held.hold_drivers[..., own, column, None] * physical[..., own, :]
    free.hold[..., own, :] = held.hold[..., own, :] @ held.modal @ physical + by_angle
    free.hold_drivers[..., body, :], free.hold_drag[..., body, :] = held.hold_drivers[..., body, :], held.hold_drag[..., body, :]
    free.hold_drivers[..., body, column] = 0.0


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
    if not product.size:
        return product
    largest = np.abs(scale).max(axis=(-2, -1), keepdims=True)
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
    stiffness += spread_out(k) * np.outer(windup, windup)
    damping += spread_out(GEAR_DAMPING_TIME * k) * np.outer(windup, windup)
    drivers[..., GEAR_SIDE] += np.asarray(k * 0.5 * structure.gear_gap / structure.gear_ratio)[..., None] * windup


__all__ = ["COMMAND", "GEAR_OPEN", "HUB_STUCK", "MOTOR_STUCK", "Mode", "complete", "mode_of"]
