"""Finite elements of an Euler–Bernoulli beam, measured from the turning hub (thesis section 3.1)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Matrix = NDArray[np.float64]


def element_matrices(length: float, mass_per_length: float, bending_stiffness: float) -> tuple[Matrix, Matrix]:
    """Return mass and stiffness (4, 4) of one element on [v, s, v, s] (thesis eqs. 3.7, 3.8 with erratum 1)."""
    a = length
    mass = np.array(
        [
            [156, 22 * a, 54, -13 * a],
            [22 * a, 4 * a**2, 13 * a, -3 * a**2],
            [54, 13 * a, 156, -22 * a],
            [-13 * a, -3 * a**2, -22 * a, 4 * a**2],
        ]
    )
    stiffness = np.array(
        [
            [12, 6 * a, -12, 6 * a],
            [6 * a, 4 * a**2, -6 * a, 2 * a**2],
            [-12, -6 * a, 12, -6 * a],
            [6 * a, 2 * a**2, -6 * a, 4 * a**2],
        ]
    )
    return mass * mass_per_length * a / 420, stiffness * bending_stiffness / a**3


class Beam:
    """A beam of equal elements on a turning hub.

    Coordinates are [hub angle, root slope, v_1, s_1, … v_n, s_n]: the hub angle [rad] from the fixed line, the
    slope of the root against the hub [rad], and deflection [m] and slope [rad] of each node against the hub's line.
    """

    def __init__(self, elements: int, length: float, mass_per_length: float, bending_stiffness: float) -> None:
        self.elements = elements
        self.length = length
        self.bending_stiffness = bending_stiffness
        self.size = 2 + 2 * elements
        span = length / elements
        nodes = np.linspace(0.0, length, elements + 1)
        absolute = np.zeros((2 * elements + 2, self.size))
        for node, x in enumerate(nodes):
            absolute[2 * node, 0] = x
            absolute[2 * node + 1, 0] = 1.0
            absolute[2 * node + 1, 2 * node + 1] = 1.0
            if node:
                absolute[2 * node, 2 * node] = 1.0
        mass, stiffness = element_matrices(span, mass_per_length, bending_stiffness)
        full_mass = np.zeros((2 * elements + 2, 2 * elements + 2))
        full_stiffness = np.zeros_like(full_mass)
        for element in range(elements):
            where = slice(2 * element, 2 * element + 4)
            full_mass[where, where] += mass
            full_stiffness[where, where] += stiffness
        self.mass: Matrix = absolute.T @ full_mass @ absolute
        bent = absolute.copy()
        bent[:, 0] = 0.0  # the hub's angle bends nothing; exact zeros keep it out of the stiffness
        self.stiffness: Matrix = bent.T @ full_stiffness @ bent

    def _local(self, x: float) -> tuple[int, float, float]:
        span = self.length / self.elements
        element = min(int(x / span), self.elements - 1)
        return element, x / span - element, span

    def deflection_row(self, x: float, absolute: bool) -> Matrix:
        """Row that gives the deflection [m] at x, from the hub's line or (absolute) from the fixed one."""
        element, u, a = self._local(x)
        shape = [1 - 3 * u**2 + 2 * u**3, a * (u - 2 * u**2 + u**3), 3 * u**2 - 2 * u**3, a * (u**3 - u**2)]
        return self._row(element, shape, x if absolute else 0.0)

    def moment_row(self, x: float) -> Matrix:
        """Row that gives the bending moment [Nm] at x (thesis section 3.3 with erratum 4)."""
        element, u, a = self._local(x)
        shape = [(12 * u - 6) / a**2, (6 * u - 4) / a, (6 - 12 * u) / a**2, (6 * u - 2) / a]
        return self.bending_stiffness * self._row(element, shape, 0.0)

    def _row(self, element: int, shape: list[float], hub: float) -> Matrix:
        row = np.zeros(self.size)
        row[2 * element : 2 * element + 4] = shape
        row[0] = hub  # where the deflection of node 0, which is zero, would stand
        return row

    def drag_points(self) -> list[tuple[float, float]]:
        """Gauss points (x [m], weight [m]) along the beam, for forces per length."""
        per_element = max(2, 4 // self.elements)
        points, weights = np.polynomial.legendre.leggauss(per_element)
        span = self.length / self.elements
        return [
            (span * (element + 0.5 + 0.5 * point), 0.5 * span * weight)
            for element in range(self.elements)
            for point, weight in zip(points, weights, strict=True)
        ]
