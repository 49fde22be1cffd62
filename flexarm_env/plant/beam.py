"""Finite elements of an Euler–Bernoulli beam, measured from the turning hub (thesis section 3.1).

Every quantity of a beam may be one number or one for each of many beams, (…); matrices then are (…, rows, columns).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

Matrix = NDArray[np.float64]

#: Mass and stiffness of an element of length 1, mass 1 and bending stiffness 1 on [v, s, v, s].
UNIT_MASS = np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]]) / 420
UNIT_STIFFNESS = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4.0]])
#: Coefficients of 1, u, u², u³ in the shapes of [v, s, v, s], slopes over the element's length.
SHAPES = np.array([[1, 0, -3, 2], [0, 1, -2, 1], [0, 0, 3, -2], [0, 0, -1, 1.0]])
#: The same of 1, u in their second derivatives.
BENDS = np.array([[-6, 12], [-4, 6], [6, -12], [-2, 6.0]])


def spread_out(value: ArrayLike) -> Matrix:
    """Reshape a quantity (…) to multiply matrices (…, rows, columns)."""
    return np.asarray(value, dtype=float)[..., None, None]


def turned(matrix: Matrix) -> Matrix:
    """Transpose matrices (…, rows, columns)."""
    return np.swapaxes(matrix, -1, -2)


def element_matrices(length: Matrix, mass_per_length: Matrix, bending_stiffness: Matrix) -> tuple[Matrix, Matrix]:
    """Compute mass and stiffness (…, 4, 4) of one element on [v, s, v, s] (thesis eqs. 3.7, 3.8 with erratum 1)."""
    sizes = np.ones((*length.shape, 4))
    sizes[..., 1::2] = length[..., None]
    scale = sizes[..., :, None] * sizes[..., None, :]
    mass, stiffness = spread_out(mass_per_length * length), spread_out(bending_stiffness / (length * length * length))
    return mass * scale * UNIT_MASS, stiffness * scale * UNIT_STIFFNESS


class Beam:
    """A beam of equal elements on a turning hub.

    Coordinates are [hub angle, root slope, v_1, s_1, … v_n, s_n]: the hub angle [rad] from the fixed line, the
    slope of the root against the hub [rad], and deflection [m] and slope [rad] of each node against the hub's line.
    """

    def __init__(self, elements: int, length: ArrayLike, mass_per_length: ArrayLike, bending_stiffness: ArrayLike) -> None:
        self.elements = elements
        self.length, mass_per_length, self.bending_stiffness = np.broadcast_arrays(
            *(np.asarray(value, dtype=float) for value in (length, mass_per_length, bending_stiffness))
        )
        self.size = 2 + 2 * elements
        self.span = self.length / elements
        absolute = np.zeros((*self.length.shape, self.size, self.size))
        slopes = np.arange(1, self.size, 2)
        absolute[..., 2 * np.arange(elements + 1), 0] = self.length[..., None] * np.linspace(0.0, 1.0, elements + 1)
        absolute[..., slopes, 0] = absolute[..., slopes, slopes] = 1.0
        absolute[..., slopes[1:] - 1, slopes[1:] - 1] = 1.0
        mass, stiffness = element_matrices(self.span, mass_per_length, self.bending_stiffness)
        full_mass, full_stiffness = np.zeros_like(absolute), np.zeros_like(absolute)
        for element in range(elements):
            where = slice(2 * element, 2 * element + 4)
            full_mass[..., where, where] += mass
            full_stiffness[..., where, where] += stiffness
        self.mass: Matrix = turned(absolute) @ full_mass @ absolute
        absolute[..., 0] = 0.0  # the hub's angle bends nothing; exact zeros keep it out of the stiffness
        self.stiffness: Matrix = turned(absolute) @ full_stiffness @ absolute

    def deflection_rows(self, x: ArrayLike, absolute: bool) -> Matrix:
        """Rows (…, places, size) that give the deflection [m] at x (…, places) [m].

        From the hub's line or (absolute) from the fixed one.
        """
        places = np.asarray(x, dtype=float)
        element, u = self._local(places)
        powers = np.ones((*u.shape, 4))
        powers[..., 1], powers[..., 2], powers[..., 3] = u, u * u, u * u * u
        shapes = powers @ SHAPES.T
        shapes[..., 1::2] *= self.span[..., None, None]
        return self._rows(element, shapes, places if absolute else np.zeros(()))

    def moment_rows(self, x: ArrayLike) -> Matrix:
        """Rows (…, places, size) that give the bending moment [Nm] at x (…, places) (thesis section 3.3 with erratum 4)."""
        element, u = self._local(np.asarray(x, dtype=float))
        bends = BENDS[:, 0] + u[..., None] * BENDS[:, 1]
        bends[..., 1::2] *= self.span[..., None, None]
        return self._rows(element, spread_out(self.bending_stiffness / self.span**2) * bends, np.zeros(()))

    def _local(self, x: Matrix) -> tuple[NDArray[np.intp], Matrix]:
        along = x / self.span[..., None]
        element = np.minimum(along.astype(np.intp), self.elements - 1)
        return element, along - element

    def _rows(self, element: NDArray[np.intp], shapes: Matrix, hub: Matrix) -> Matrix:
        rows = np.zeros((*element.shape, self.size))
        flat, first = rows.reshape(-1, self.size), 2 * element.reshape(-1, 1)
        flat[np.arange(len(flat))[:, None], first + np.arange(4)] = shapes.reshape(-1, 4)
        rows[..., 0] = hub  # where the deflection of node 0, which is zero, would stand
        return rows

    def drag_points(self) -> tuple[Matrix, Matrix]:
        """Gauss points [m] along the beam and their weights [m], (…, places), for forces per length."""
        places, weights = _gauss(self.elements)
        return self.length[..., None] * places, self.length[..., None] * weights


@lru_cache(maxsize=32)
def _gauss(elements: int) -> tuple[Matrix, Matrix]:
    """Gauss points and weights of equal elements of a beam of length 1."""
    points, weights = np.polynomial.legendre.leggauss(max(2, 4 // elements))
    places = (np.arange(elements)[:, None] + 0.5 + 0.5 * points) / elements
    return places.ravel(), np.tile(0.5 * weights / elements, elements)
