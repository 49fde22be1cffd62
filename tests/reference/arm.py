"""Matrices, friction and energy of the reference arm."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Mode:
    """One linear regime: z" = weights (force + gain z), until a row of `rows z + offsets` falls below 0."""

    sign: int
    weights: Array
    force: Array
    gain: Array
    rows: Array
    offsets: Array

    def slope(self, _time: float, z: Array) -> Array:
        """Time derivative of z = [positions, speeds]; SI units."""
        half = len(self.force)
        out = np.empty(2 * half)
        out[:half] = z[half:]
        out[half:] = self.weights @ (self.force + self.gain @ z)
        return out


@dataclass(frozen=True)
class Arm:
    """Arm of the thesis (Table A.1) with n elements; torques, dampings and hub_inertia are on the arm's side.

    Units: payload kg; viscous N m s; coulomb and static (total, not the excess) N m; extra_damping a square
    matrix (1 + 2n) in absolute coordinates, added to B; beam_damping s (Kelvin-Voigt: C = time * K_beam);
    cable_stiffness N m/rad about angle 0; length m; mass_per_length kg/m; rigidity N m^2; inertias kg m^2;
    motor_constant N m/A. The hub's inertia is gear_ratio^2 motor_inertia + hub_inertia.
    """

    elements: int = 1
    payload: float = 0.0
    viscous: float = 1.5**2 * 0.0008 + 0.1
    coulomb: float = 1.5 * 0.066 + 0.183
    static: float = 1.5 * 0.09487 + 0.21574
    extra_damping: Array | None = None
    beam_damping: float = 0.0
    cable_stiffness: float = 0.0
    length: float = 1.0
    mass_per_length: float = 0.42381
    rigidity: float = 68.944e9 * 1.1475e-10
    gear_ratio: float = 1.5
    motor_inertia: float = 0.00193
    hub_inertia: float = 0.00129
    motor_constant: float = 0.33

    def __post_init__(self) -> None:
        if self.static < self.coulomb:
            raise ValueError("static is the total at rest: it cannot be below coulomb")

    @property
    def size(self) -> int:
        """Number of coordinates, 1 + 2 * elements."""
        return 1 + 2 * self.elements

    @cached_property
    def rigid(self) -> Array:
        """Coordinates of a rigid rotation by 1 rad: angle 1, deflections x, slopes 1."""
        x = self.length * np.arange(1, self.elements + 1) / self.elements
        return np.concatenate([[1.0], np.column_stack([x, np.ones(self.elements)]).ravel()])

    def _assemble(self, element: Array) -> Array:
        total = np.zeros((self.size + 1, self.size + 1))
        for first in range(0, 2 * self.elements, 2):
            total[first : first + 4, first : first + 4] += element
        return total[1:, 1:]  # the hub does not deflect: node 0 keeps its slope only

    @cached_property
    def K_beam(self) -> Array:
        """Stiffness of the beam alone (thesis eq. 3.8, primes restored), SI units."""
        h = self.length / self.elements
        upper = [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h]]
        lower = [[-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]]
        return self._assemble(self.rigidity / h**3 * np.array(upper + lower))

    @cached_property
    def K(self) -> Array:
        """Stiffness with the cable's at the hub, SI units."""
        return self.K_beam + self.cable_stiffness * self._hub_only()

    @cached_property
    def M_bare(self) -> Array:
        """Mass of beam and payload without the hub's inertia (thesis eqs. 3.7, 3.14), SI units."""
        h = self.length / self.elements
        upper = [[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h]]
        lower = [[54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h]]
        mass = self._assemble(self.mass_per_length * h / 420 * np.array(upper + lower))
        mass[-2, -2] += self.payload
        return mass

    @cached_property
    def M(self) -> Array:
        """Mass with the hub's inertia, SI units."""
        return self.M_bare + (self.gear_ratio**2 * self.motor_inertia + self.hub_inertia) * self._hub_only()

    @cached_property
    def B(self) -> Array:
        """Damping: viscous at the hub, Kelvin-Voigt in the beam, and the extra matrix; SI units."""
        damping = self.viscous * self._hub_only() + self.beam_damping * self.K_beam
        return damping if self.extra_damping is None else damping + self.extra_damping

    def _hub_only(self) -> Array:
        matrix = np.zeros((self.size, self.size))
        matrix[0, 0] = 1.0
        return matrix

    @cached_property
    def _gain(self) -> Array:
        """Force per z = [angle, q_f - rigid_f angle, and their rates], so a big angle cancels nothing."""
        relative = np.eye(self.size)
        relative[:, 0] = self.rigid
        stiffness = self.K_beam.copy()
        stiffness[:, 0] = 0.0  # a rigid rotation bends nothing, exactly
        stiffness[0, 0] = self.cable_stiffness
        viscous = self.B - self.beam_damping * self.K_beam
        bending = self.beam_damping * self.K_beam
        bending[:, 0] = 0.0
        return -np.hstack([stiffness, viscous @ relative + bending])

    @cached_property
    def _hold_row(self) -> Array:
        """Row u, hold torque = u . force: the hub's force less what the clamped beam's acceleration takes."""
        return np.concatenate([[1.0], -np.linalg.solve(self.M[1:, 1:], self.M[1:, 0])])

    @cached_property
    def _weights(self) -> tuple[Array, Array]:
        """Acceleration of z per force: (stuck, slipping)."""
        stuck = np.zeros((self.size, self.size))
        stuck[1:, 1:] = np.linalg.inv(self.M[1:, 1:])
        slip = np.array(np.linalg.inv(self.M), dtype=np.float64)
        slip[1:] -= np.outer(self.rigid[1:], slip[0])
        return stuck, slip

    def _mode(self, sign: int, torque: float) -> Mode:
        force = np.zeros(self.size)
        force[0] = torque - sign * self.coulomb
        if sign:
            row = np.zeros((1, 2 * self.size))
            row[0, self.size] = sign
            return Mode(sign, self._weights[1], force, self._gain, row, np.zeros(1))
        hold = self._hold_row @ self._gain
        rows, offsets = np.array([-hold, hold]), np.array([self.static - torque, self.static + torque])
        return Mode(0, self._weights[0], force, self._gain, rows, offsets)

    def _sign(self, z: Array, torque: float, breaking_away: bool) -> int:
        """Decide the mode: the hub's direction of motion, 0 when it sticks."""
        if z[self.size] != 0.0:
            return int(np.sign(z[self.size]))
        hold = torque + float(self._hold_row @ self._gain @ z)
        return 0 if abs(hold) <= self.static and not breaking_away else int(np.sign(hold))

    @cached_property
    def _fastest(self) -> float:
        """Largest angular frequency of the unconstrained hub [rad/s]; the clamped ones lie below it."""
        return float(np.sqrt(eigh(self.K, self.M, eigvals_only=True)[-1]))

    def _relative(self, state: Array) -> Array:
        half = np.asarray(state, dtype=float).reshape(2, self.size).copy()
        half[:, 1:] -= half[:, :1] * self.rigid[1:]
        return half.ravel()

    def moment_at(self, x: float, q: Array) -> Array:
        """Bending moment EI y'' [N m] at x [m] for absolute q (..., size); on a node, the outer element's."""
        q = np.asarray(q, dtype=float)
        return (q[..., 1:] - q[..., :1] * self.rigid[1:]) @ self._bending(x)

    def _bending(self, x: float) -> Array:
        """Row (2n,): moment [N m] at x [m] per node coordinate relative to the hub's line."""
        h = self.length / self.elements
        element = min(int(x / h + 1e-12), self.elements - 1)
        a = x / h - element
        shape = np.array([(12 * a - 6) / h**2, (6 * a - 4) / h, (6 - 12 * a) / h**2, (6 * a - 2) / h])
        row = np.zeros(2 * self.elements + 2)
        row[2 * element : 2 * element + 4] = self.rigidity * shape
        return row[2:]

    def energy(self, state: Array) -> Array:
        """Kinetic and elastic energy [J] of absolute states (..., 2 * size)."""
        q, speed = np.split(np.asarray(state, dtype=float), 2, axis=-1)
        bend = q - q[..., :1] * self.rigid
        kinetic = np.einsum("...i,ij,...j", speed, self.M, speed)
        elastic = np.einsum("...i,ij,...j", bend, self.K_beam, bend) + self.cable_stiffness * q[..., 0] ** 2
        return 0.5 * (kinetic + elastic)


def frequencies(elements: int, hub: str = "free", payload: float = 0.0) -> Array:
    """Natural frequencies [Hz], ascending, without 0; hub "free", "bare" (no inertia) or "clamped"."""
    arm = Arm(elements=elements, payload=payload)
    if hub == "clamped":
        squares = eigh(arm.K[1:, 1:], arm.M[1:, 1:], eigvals_only=True)
    elif hub in ("free", "bare"):
        squares = eigh(arm.K, arm.M if hub == "free" else arm.M_bare, eigvals_only=True)[1:]
    else:
        raise ValueError(f"hub must be 'free', 'bare' or 'clamped', not {hub!r}")
    return np.sqrt(squares) / (2 * np.pi)
