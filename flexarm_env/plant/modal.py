"""Block-diagonal form of the linear part, one for each mode of hub, motor and gears."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from flexarm_env.errors import InputError
from flexarm_env.plant.beam import Matrix, spread_out
from flexarm_env.plant.blocks import blocks_of
from flexarm_env.plant.structure import (
    COMMAND,
    DRIVERS,
    GEAR_SIDE,
    HELD_HUB,
    HELD_MOTOR,
    LinearModel,
    Structure,
)

HUB_STUCK, MOTOR_STUCK, GEAR_OPEN = 1, 2, 4
#: A rate of decay [1/s] below this is none: an eigenvalue so near to 0 has an eigenvector that no float tells from that of 0.
SLOWEST_DECAY = 1e-16
#: Inverse of an inertia [1/(kg m²)], or of a mass, from which products with it need not be finite.
LARGEST_INVERSE = 1e100

Decompose = Callable[[Matrix], tuple[Matrix, Matrix, Matrix, Matrix]]


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
    beam_forcing: Matrix  # (2 blocks, forces on the beam)
    hold: Matrix  # (bodies, 2 blocks): torque that friction must resist, on a body at rest
    hold_drivers: Matrix  # (bodies, drivers)
    hold_beam: Matrix  # (bodies, forces on the beam)


def mode_of(structure: Structure, model: LinearModel, which: int, decompose: Decompose = blocks_of) -> Mode:
    """Decompose the arm in one mode.

    Args:
        structure: for the gears' stiffness, inertia and gap.
        model: the matrices.
        which: HUB_STUCK, MOTOR_STUCK and GEAR_OPEN added up.
        decompose: gives c0, c1, V, W of the dynamics (see blocks_of).
    """
    frame = _frame(len(model.names), "motor" in model.names, model.extra.shape[-1], which)
    free, held = frame.free, frame.held
    stiffness, damping, drivers = model.stiffness.copy(), model.damping.copy(), model.input.copy()
    if "motor" in model.names and not which & GEAR_OPEN:
        _close_gears(structure, model, stiffness, damping, drivers)
    for column, place in held:
        drivers[..., column] -= stiffness[..., place]
    inertial = model.mass @ free
    inverse = _inverse(free.T @ inertial)
    answer = inverse @ free.T  # accelerations by forces
    dynamics = _dynamics(model, free, stiffness, damping, inverse)
    c0, c1, v, w = _decomposed(dynamics, free.shape[1], decompose)
    rows, bodies = slice(free.shape[1], 2 * free.shape[1]), 2 if "motor" in model.names else 1
    force = _padded(answer @ drivers, dynamics, rows)
    force[..., rows.stop :, :] = model.extra_from_input
    for column, place in held:
        force[..., rows.stop :, column] += model.extra_from_motion[..., place]
    along = _padded(answer @ model.beam_force, dynamics, rows)
    inertial = inertial[..., :bodies, :]
    return Mode(
        c0=c0,
        c1=c1,
        physical=frame.lift @ v,
        held=frame.at_hold,
        modal=w @ frame.pick,
        forcing=w @ force,
        beam_forcing=w @ along,
        hold=_resisted(model, stiffness @ free, damping @ free, inertial, dynamics) @ v,
        hold_drivers=drivers[..., :bodies, :] - inertial @ force[..., rows, :],
        hold_beam=model.beam_force[..., :bodies, :] - inertial @ along[..., rows, :],
    )


def _decomposed(dynamics: Matrix, positions: int, decompose: Decompose) -> tuple[Matrix, Matrix, Matrix, Matrix]:
    """Decompose dynamics, with each lagged state counted from where it would settle at the present positions.

    A position that only lags follow is then one on which nothing depends. Without damping it and its rate would have one and the
    same eigenvector.
    """
    extra = slice(2 * positions, None)
    settled = -np.linalg.solve(dynamics[..., extra, extra], dynamics[..., extra, :positions])
    if not settled.any():
        return decompose(dynamics)
    turn = np.broadcast_to(np.eye(dynamics.shape[-1]), dynamics.shape).copy()
    back = turn.copy()
    turn[..., extra, :positions], back[..., extra, :positions] = settled, -settled
    turned = back @ dynamics @ turn
    turned[..., extra, :positions] = 0.0
    c0, c1, v, w = decompose(turned)
    return c0, c1, turn @ v, w @ back


def _inverse(mass: Matrix) -> Matrix:
    """Invert mass matrices (…, positions, positions).

    Raises:
        InputError: for a body of no inertia.
    """
    try:
        inverse = np.asarray(np.linalg.inv(mass), dtype=np.float64)
    except np.linalg.LinAlgError:
        inverse = np.full_like(mass, np.inf)
    if not (np.abs(inverse) < LARGEST_INVERSE).all():
        raise InputError(
            "a body of the arm has no inertia, and any torque would move it beyond all: raise hub.inertia or link.inertia"
        )
    return inverse


def _dynamics(model: LinearModel, free: Matrix, stiffness: Matrix, damping: Matrix, inverse: Matrix) -> Matrix:
    """Compute A (…, states, states) of ẋ = A x, for x the free positions, their rates and the extra states."""
    arms, size, positions = model.mass.shape[:-2], len(model.names), free.shape[1]
    states = 2 * positions + model.extra.shape[-1]
    dynamics = np.zeros((*arms, states, states))
    dynamics[..., :positions, positions : 2 * positions] = np.eye(positions)
    pull = _clean(free.T @ (stiffness @ free), stiffness)
    rows = slice(positions, 2 * positions)
    dynamics[..., rows, :positions] = -inverse @ pull
    decay = -(inverse @ free.T) @ (damping @ free)
    dynamics[..., rows, rows] = np.where(np.abs(decay) < SLOWEST_DECAY, 0.0, decay)
    dynamics[..., rows, 2 * positions :] = (inverse @ free.T) @ model.from_extra
    into_extra = model.extra_from_motion
    dynamics[..., 2 * positions :, :positions] = _clean(into_extra[..., :size] @ free, into_extra)
    dynamics[..., 2 * positions :, rows] = into_extra[..., size:] @ free
    dynamics[..., 2 * positions :, 2 * positions :] = model.extra
    return dynamics


def _padded(accelerations: Matrix, dynamics: Matrix, rows: slice) -> Matrix:
    """Place accelerations in the rows of the positions' rates, and zeros in those of the other states."""
    padded = np.zeros((*dynamics.shape[:-1], accelerations.shape[-1]))
    padded[..., rows, :] = accelerations
    return padded


def _resisted(model: LinearModel, stiffness: Matrix, damping: Matrix, inertial: Matrix, dynamics: Matrix) -> Matrix:
    """Compute the rows (…, bodies, states) of the torque that friction resists, from matrices on the free positions."""
    bodies, positions = inertial.shape[-2], inertial.shape[-1]
    rows = slice(positions, 2 * positions)
    resist = np.zeros((*inertial.shape[:-1], dynamics.shape[-1]))
    resist[..., 2 * positions :] = model.from_extra[..., :bodies, :]
    resist[..., rows] -= damping[..., :bodies, :]
    resist[..., :positions] -= stiffness[..., :bodies, :]
    resist -= inertial @ dynamics[..., rows, :]
    return resist


def complete(free: Mode, held: Mode, body: int, speed: int) -> None:
    """Add to a mode the torque that would hold a free body at zero speed.

    Args:
        free: the mode with the body free.
        held: the mode with the body held and all else equal.
        body: 0 hub, 1 motor.
        speed: the row of the body's speed in [q, q̇, e], which is zero.
    """
    physical = free.physical.copy()
    physical[..., speed, :] = 0.0
    own, column = slice(body, body + 1), HELD_HUB + body
    by_angle = held.hold_drivers[..., own, column : column + 1] * physical[..., own, :]
    free.hold[..., own, :] = held.hold[..., own, :] @ held.modal @ physical + by_angle
    free.hold_drivers[..., body, :], free.hold_beam[..., body, :] = held.hold_drivers[..., body, :], held.hold_beam[..., body, :]
    free.hold_drivers[..., body, column] = 0.0


def _clean(product: Matrix, scale: Matrix) -> Matrix:
    """Set rounding errors to zero, so that a coordinate on which nothing depends is recognised."""
    if not product.size:
        return product
    largest = np.abs(scale).max(axis=(-2, -1), keepdims=True)
    return np.where(np.abs(product) < 1e-15 * largest, 0.0, product)


@dataclass(frozen=True)
class _Frame:
    """Coordinates of a mode, which do not depend on the arm's numbers."""

    free: Matrix  # (coordinates, positions): coordinates from the mode's positions
    held: list[tuple[int, int]]  # driver and coordinate of each held body
    lift: Matrix  # [q, q̇, e] from the mode's states
    pick: Matrix  # and back
    at_hold: Matrix  # [q, q̇, e] from the drivers


@lru_cache(maxsize=256)
def _frame(size: int, two_bodies: bool, extra: int, which: int) -> _Frame:
    whole = np.eye(size)
    if two_bodies and not which & (HUB_STUCK | MOTOR_STUCK):
        whole[1, 0] = 1.0  # the motor's coordinate becomes the windup of the gears
    held = [(HELD_HUB, 0)] if which & HUB_STUCK else []
    held += [(HELD_MOTOR, 1)] if which & MOTOR_STUCK else []
    free = np.delete(whole, [place for _, place in held], axis=1)
    positions = free.shape[1]
    # the inverse of free: one entry off the diagonal, or rows of the unit matrix
    places = 2.0 * np.eye(size) - free if size == positions else free.T
    lift, pick = np.zeros((2 * size + extra, 2 * positions + extra)), np.zeros((2 * positions + extra, 2 * size + extra))
    lift[:size, :positions] = lift[size : 2 * size, positions : 2 * positions] = free
    pick[:positions, :size] = pick[positions : 2 * positions, size : 2 * size] = places
    lift[2 * size :, 2 * positions :] = pick[2 * positions :, 2 * size :] = np.eye(extra)
    at_hold = np.zeros((2 * size + extra, len(DRIVERS)))
    for column, place in held:
        at_hold[place, column] = 1.0
    for matrix in (free, lift, pick, at_hold):
        matrix.flags.writeable = False
    return _Frame(free, held, lift, pick, at_hold)


def _close_gears(structure: Structure, model: LinearModel, stiffness: Matrix, damping: Matrix, drivers: Matrix) -> None:
    k = structure.gear_stiffness
    windup = np.zeros(len(model.names))
    windup[0], windup[1] = -1.0, 1.0
    stiffness += spread_out(k) * np.outer(windup, windup)
    damping += spread_out(structure.gear_damping_time * k) * np.outer(windup, windup)
    drivers[..., GEAR_SIDE] += np.asarray(k * 0.5 * structure.gear_gap / structure.gear_ratio)[..., None] * windup


__all__ = ["COMMAND", "GEAR_OPEN", "HUB_STUCK", "MOTOR_STUCK", "Mode", "complete", "mode_of"]
