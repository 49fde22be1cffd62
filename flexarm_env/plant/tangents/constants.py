"""Derivatives of the kernel's constants: of all numbers in d, with the blocks' basis turned along with the dynamics.

The eigenvectors of an arm are free in scale and, where blocks share eigenvalues, in direction. Differences of two
decompositions would therefore mean nothing. With A V = V L, a change dA of the dynamics turns the basis by dV = V Y and changes
the blocks by dL, where dL + Y L − L Y = W dA V (perturbation of invariant subspaces: Stewart and Sun, Matrix Perturbation
Theory, 1990, chapter V). dL has the form of a block. All other numbers are smooth functions of V, W, c₀, c₁ and the arm's
quantities, and follow by differences of them along these directions.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from flexarm_env.plant import layout as at
from flexarm_env.plant.active_laws import ActiveLaw
from flexarm_env.plant.assembly import assemble
from flexarm_env.plant.beam import Matrix
from flexarm_env.plant.blocks import blocks_of
from flexarm_env.plant.flat_arrays import pack
from flexarm_env.plant.structure import SHORTEST_LAG, Structure, exceeds, stacked

#: Central differences of order four: places in steps, and weights. The numbers differenced are smooth functions of an arm.
PLACES = np.array([-2.0, -1.0, 1.0, 2.0])
WEIGHTS = np.array([1.0, -8.0, 8.0, -1.0]) / 12.0
#: Pairs of blocks whose spectra are closer than this share of the larger one count as equal; they do not act on each other.
EQUAL = 1e-11

Blocks = tuple[Matrix, Matrix, Matrix, Matrix]  # c0, c1, V, W


@dataclass(frozen=True)
class Neighbours:
    """Arms beside one arm, at PLACES along each constant.

    Attributes:
        structures: constant by constant, place by place.
        laws: those that act on each.
        steps: (constants,) the steps between places, in the unit of the constant.
    """

    structures: Sequence[Structure]
    laws: Sequence[Sequence[ActiveLaw]]
    steps: Matrix


def constant_tangents(structure: Structure, active: Sequence[ActiveLaw], interval: float, neighbours: Neighbours) -> Matrix:
    """Compute the derivatives (numbers, constants) of the numbers in d.

    Args:
        structure: the linear part of the arm.
        active: its laws.
        interval: sampling time [s].
        neighbours: the arm's own at places beside it.

    Raises:
        ValueError: if an arm beside it is of another kind: the readings then have no derivative.
    """
    if any(_kind(other) != _kind(structure) for other in neighbours.structures):
        raise ValueError("an arm of another kind lies within the difference")
    bases = _Bases(neighbours.steps)
    _, layout, _ = pack(structure, assemble(structure), [active], interval, bases.record)
    beside = stacked(neighbours.structures)
    moved = pack(beside, assemble(beside), neighbours.laws, interval, bases.turned)
    substeps = [at.EARLY_SUBSTEPS, at.LATE_SUBSTEPS]
    numbers = moved[0].reshape(len(neighbours.steps), len(PLACES), -1)
    tangents = np.einsum("cpn,p->nc", numbers, WEIGHTS) / neighbours.steps
    delays = np.reshape(beside.input_delay, (-1, len(PLACES))) @ WEIGHTS / neighbours.steps
    early, late = (max(int(count), 1) for count in layout[substeps])
    tangents[at.EARLY_LENGTH], tangents[at.LATE_LENGTH] = delays / early, -delays / late
    return np.ascontiguousarray(tangents)


def _kind(structure: Structure) -> tuple[bool, ...]:
    """Tell which bodies, states and inputs an arm has, of those that its numbers decide."""
    s = structure
    lags = (s.current_lag, *(channel.filter for channel in s.sensors.values()))
    present = [exceeds(part, 0.0) for part in (s.resistance, s.gear_gap)] + [exceeds(lag, SHORTEST_LAG) for lag in lags]
    return s.soft_gears, s.soft_root, *present


class _Bases:
    """Decompositions of an arm's modes, in the order of their computation, and those beside it in the same gauge."""

    def __init__(self, steps: Matrix) -> None:
        self.steps = steps
        self.own: list[tuple[Matrix, Blocks]] = []
        self.next = 0

    def record(self, dynamics: Matrix) -> Blocks:
        """Decompose a mode of the arm itself."""
        found = blocks_of(dynamics)
        self.own.append((dynamics, found))
        return found

    def turned(self, dynamics: Matrix) -> Blocks:
        """Turn the basis of the arm's own mode to first order along the change of the dynamics (arms, states, states)."""
        (_, (c0, c1, v, w)), self.next = self.own[self.next], self.next + 1
        every = dynamics.reshape(len(self.steps), len(PLACES), *dynamics.shape[1:])
        change = np.einsum("cpij,p->cij", every, WEIGHTS) / self.steps[:, None, None]
        dc0, dc1, y = basis_change(c0, c1, w @ change @ v)
        lengths = (self.steps[:, None] * PLACES).ravel()
        each = np.repeat(np.arange(len(self.steps)), len(PLACES))
        back = (w @ v) @ y @ w
        return (
            c0 + lengths[:, None] * dc0[each],
            c1 + lengths[:, None] * dc1[each],
            v + lengths[:, None, None] * (v @ y)[each],
            w - lengths[:, None, None] * back[each],
        )


def basis_change(c0: Matrix, c1: Matrix, m: Matrix) -> tuple[Matrix, Matrix, Matrix]:
    """Solve dL + Y L − L Y = M for blocks [[0, 1], [−c₀, −c₁]].

    Args:
        c0: (blocks,).
        c1: (blocks,).
        m: (constants, 2 blocks, 2 blocks).

    Returns:
        dc₀, dc₁ (constants, blocks); Y (constants, 2 blocks, 2 blocks).
    """
    blocks = len(c0)
    pairs = m.reshape(len(m), blocks, 2, blocks, 2).transpose(1, 3, 0, 2, 4)  # [j, k, constant, row, column]
    own = np.zeros((blocks, 2, 2))
    own[:, 0, 1], own[:, 1, 0], own[:, 1, 1] = 1.0, -c0, -c1
    real = (c0[:, None] == 0.0) & (c0 == 0.0)
    same = np.eye(blocks, dtype=np.bool_) & ~real
    apart = ~(real | same)
    y = np.zeros_like(pairs)
    y[apart] = _between_blocks(own[np.nonzero(apart)[0]], own[np.nonzero(apart)[1]], pairs[apart])
    y[same] = _within_blocks(c0[same.any(axis=1)], c1[same.any(axis=1)], pairs[same])
    y[real] = _between_real(c1[np.nonzero(real)[0]], c1[np.nonzero(real)[1]], pairs[real])
    diagonal = np.arange(blocks)
    inner = y[diagonal, diagonal]
    left = pairs[diagonal, diagonal] - inner @ own[:, None] + own[:, None] @ inner
    return -left[:, :, 1, 0].T, -left[:, :, 1, 1].T, y.transpose(2, 0, 3, 1, 4).reshape(m.shape)


def _within_blocks(c0: Matrix, c1: Matrix, m: Matrix) -> Matrix:
    """Solve the upper row of Y L − L Y = M (blocks, constants, 2, 2), (−c₀ y₁₂, y₁₁ − c₁ y₁₂), with a lower row of Y of zeros."""
    y = np.zeros_like(m)
    y[..., 0, 1] = -m[..., 0, 0] / c0[:, None]
    y[..., 0, 0] = m[..., 0, 1] + c1[:, None] * y[..., 0, 1]
    return y


def _between_blocks(first: Matrix, second: Matrix, m: Matrix) -> Matrix:
    """Solve Y L₂ − L₁ Y = M (pairs, constants, 2, 2); where two blocks are the same, they do not act on each other."""
    eye = np.eye(2)
    by_second = np.einsum("ij,plk->pikjl", eye, second).reshape(-1, 4, 4)
    by_first = np.einsum("pij,kl->pikjl", first, eye).reshape(-1, 4, 4)
    # coordinates and rates differ in size by the frequency: scaled, both count alike
    size = np.sqrt(np.maximum(np.abs(first[:, 1, 0]), np.abs(second[:, 1, 0])))
    one = np.ones_like(size)
    scale = np.stack([one, 1.0 / size, size, one], axis=1)
    operator = (by_second - by_first) * scale[:, None, :] / scale[:, :, None]
    inverse = np.linalg.pinv(operator, rcond=EQUAL) * scale[:, :, None] / scale[:, None, :]
    y, left = np.zeros_like(m), m
    for _ in range(2):  # once more for what rounding leaves
        y = y + np.einsum("pij,pcj->pci", inverse, left.reshape(*m.shape[:2], 4)).reshape(m.shape)
        left = m - y @ second[:, None] + first[:, None] @ y
    return y


def _between_real(first: Matrix, second: Matrix, m: Matrix) -> Matrix:
    """Solve Y L₂ − L₁ Y = M (pairs, constants, 2, 2) for real eigenvalues with their integrals, where M has no left column."""
    y = np.zeros_like(m)
    gap = first - second  # of the eigenvalues −c₁
    apart = np.abs(gap) > EQUAL * np.maximum(np.abs(first), np.abs(second))
    y[apart, :, 1, 1] = m[apart, :, 1, 1] / gap[apart, None]
    y[..., 0, 0] = m[..., 0, 1] + y[..., 1, 1]
    return y
