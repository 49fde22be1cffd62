"""Clamped modes of a slender beam by Hermite finite elements, with tip mass, tip inertia and root spring.

Deflection w(x) [m] is measured from the rotating line of the hub: the hub angle enters through the rigid
vector (w = x, slope = 1).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg import eigh

#: roots of cos(z) cosh(z) = -1, the clamped-free beam
CLAMPED_ROOTS = (1.87510407, 4.69409113, 7.85475744, 10.99554073, 14.13716839, 17.27875953)
#: roots of tan(z) = tanh(z), the pinned-free beam
PINNED_ROOTS = (3.92660231, 7.06858275, 10.21017612)


class Beam(NamedTuple):
    """Modal beam: `w(x) = shape(x) @ eta` with mass-normalised modes.

    Attributes:
        omega2: squared circular frequencies [rad²/s²], shape (modes,).
        coupling: hub–mode coupling ∫ x φ dm [kg^½ m], shape (modes,).
        inertia: inertia of the rigid beam and payload about the hub [kg m²].
        moment_arm: first moment ∫ x dm [kg m].
        load: ∫ φ dm [kg^½], shape (modes,).
        shape: mode shapes at the nodes, shape (nodes, modes).
        x: nodes along the beam [m].
        weight: length that each node stands for [m].
        bend: bending moment EI φ″ at the two gages per unit modal coordinate, shape (2, modes).
    """

    omega2: np.ndarray
    coupling: np.ndarray
    inertia: float
    moment_arm: float
    load: np.ndarray
    shape: np.ndarray
    x: np.ndarray
    weight: np.ndarray
    bend: np.ndarray


#: A rigid arm: no modes, one node at the hub.
NO_BEAM = Beam(np.zeros(0), np.zeros(0), 0.0, 0.0, np.zeros(0), np.zeros((1, 0)), np.zeros(1), np.zeros(1), np.zeros((2, 0)))


def element(ei: float, density: float, h: float) -> tuple[np.ndarray, np.ndarray]:
    """Return mass [kg, kg m, kg m²] and stiffness [N/m, N, Nm] of one Hermite element of length `h` [m]."""
    mass = (
        density
        * h
        / 420
        * np.array(
            [
                [156, 22 * h, 54, -13 * h],
                [22 * h, 4 * h**2, 13 * h, -3 * h**2],
                [54, 13 * h, 156, -22 * h],
                [-13 * h, -3 * h**2, -22 * h, 4 * h**2],
            ]
        )
    )
    stiff = (
        ei
        / h**3
        * np.array(
            [
                [12, 6 * h, -12, 6 * h],
                [6 * h, 4 * h**2, -6 * h, 2 * h**2],
                [-12, -6 * h, 12, -6 * h],
                [6 * h, 2 * h**2, -6 * h, 4 * h**2],
            ]
        )
    )
    return mass, stiff


def curvature(x: float, h: float) -> np.ndarray:
    """Return the second derivatives [1/m², 1/m] of the four Hermite functions at `x` [m] in an element."""
    s = x / h
    return np.array([-6 + 12 * s, h * (-4 + 6 * s), 6 - 12 * s, h * (-2 + 6 * s)]) / h**2


def assemble(ei: float, density: float, length: float, elements: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the free beam's mass and stiffness in (deflection, slope) of `elements` + 1 nodes."""
    mass, stiff = element(ei, density, length / elements)
    m_all, k_all = np.zeros((2, 2 * elements + 2, 2 * elements + 2))
    for e in range(elements):
        at = slice(2 * e, 2 * e + 4)
        m_all[at, at] += mass
        k_all[at, at] += stiff
    return m_all, k_all


def curvature_rows(points: np.ndarray, length: float, elements: int) -> np.ndarray:
    """Return the rows (points, nodal values) that give the curvature [1/m] at `points` [m]."""
    out = np.zeros((len(points), 2 * elements + 2))
    h = length / elements
    for i, x in enumerate(points):
        e = min(int(x / h), elements - 1)
        out[i, 2 * e : 2 * e + 4] = curvature(x - e * h, h)
    return out


def build(
    ei: float,
    density: float,
    length: float,
    *,
    modes: int = 12,
    elements: int = 6,
    payload: float = 0.0,
    tip_inertia: float = 0.0,
    root_compliance: float = 0.0,
    gages: tuple[float, float] = (0.55, 0.02),
) -> Beam:
    """Return the reduced beam.

    Args:
        ei: bending stiffness [Nm²]. density: mass per length [kg/m]. length: [m].
        payload: tip mass [kg]. tip_inertia: [kg m²]. root_compliance: of the clamp [rad/Nm]; 0 is rigid.
        gages: positions of the mid and base gages [m].
    """
    mass, stiff = assemble(ei, density, length, elements)
    mass[-2, -2] += payload
    mass[-1, -1] += tip_inertia
    first = 2
    if root_compliance > 0.0:
        stiff[1, 1] += 1.0 / root_compliance
        first = 1
    nodes = np.linspace(0.0, length, elements + 1)
    rigid = np.column_stack([nodes, np.ones(elements + 1)]).ravel()
    shift = np.column_stack([np.ones(elements + 1), np.zeros(elements + 1)]).ravel()
    omega2, free = eigh(stiff[first:, first:], mass[first:, first:], subset_by_index=(0, modes - 1))
    vectors = np.vstack([np.zeros((first, modes)), free])
    vectors *= np.sign(vectors[-2])
    weight = np.full(elements + 1, length / elements)
    weight[[0, -1]] /= 2.0
    return Beam(
        omega2,
        vectors.T @ mass @ rigid,
        float(rigid @ mass @ rigid),
        float(shift @ mass @ rigid),
        vectors.T @ mass @ shift,
        vectors[::2],
        nodes,
        weight,
        ei * curvature_rows(np.array(gages), length, elements) @ vectors,
    )
