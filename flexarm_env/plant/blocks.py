"""Linear dynamics taken apart into blocks of second order, of one arm or of many at once.

A block is (p, P) with ṗ = P + f₁, Ṗ = −c₀ p − c₁ P + f₂: a vibration mode, or a real eigenvalue together with its
integral. It stays smooth where a rigid mode loses its damping and an eigenvector basis would break down.

Arms with real and complex eigenvalues in the same places are decomposed together. The result of an arm does not depend
on its company, to the last bit.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from flexarm_env.plant.beam import Matrix, turned

Places = NDArray[np.intp]
Complex = NDArray[np.complex128]


def blocks_of(dynamics: Matrix) -> tuple[Matrix, Matrix, Matrix, Matrix]:
    """Compute (c0, c1, V, W) with ẋ = A x, x = V z and z = W x, z in blocks.

    Args:
        dynamics: A, (…, states, states) [1/s].

    Returns:
        (…, blocks), the same, (…, states, 2 blocks), (…, 2 blocks, states); zeros fill up arms with fewer blocks.
    """
    arms, size = dynamics.shape[:-2], dynamics.shape[-1]
    if not arms:
        return _blocks_of_one(dynamics.tobytes(), size)
    every = dynamics.reshape(math.prod(arms), size, size)
    parts = list(_decompositions(every)) if size else []  # a rigid arm that is held has no states
    blocks = max((c0.shape[1] for _, c0, *_ in parts), default=0)
    c0, c1 = np.zeros((len(every), blocks)), np.zeros((len(every), blocks))
    v, w = np.zeros((len(every), size, 2 * blocks)), np.zeros((len(every), 2 * blocks, size))
    if len(parts) == 1:
        _, c0, c1, v, w = parts[0]
        parts = []
    for chosen, own_c0, own_c1, own_v, own_w in parts:
        own = own_c0.shape[1]
        c0[chosen, :own], c1[chosen, :own] = own_c0, own_c1
        v[chosen, :, : 2 * own], w[chosen, : 2 * own] = own_v, own_w
    return (
        c0.reshape(*arms, blocks),
        c1.reshape(*arms, blocks),
        v.reshape(*arms, size, 2 * blocks),
        w.reshape(*arms, 2 * blocks, size),
    )


@lru_cache(maxsize=64)
def _blocks_of_one(dynamics: bytes, size: int) -> tuple[Matrix, Matrix, Matrix, Matrix]:
    """Compute the blocks of one arm, cached: fits try many arms with the same dynamics."""
    c0, c1, v, w = (stack[0] for stack in blocks_of(np.frombuffer(dynamics).reshape(1, size, size)))
    for kept in (c0, c1, v, w):
        kept.flags.writeable = False
    return c0, c1, v, w


def _alike(rows: NDArray[np.bool_] | NDArray[np.int8]) -> Iterator[Places]:
    """Yield the places of rows that are the same, group by group."""
    if len(rows) == 1 or (rows == rows[0]).all():
        yield np.arange(len(rows))
        return
    keys = [row.tobytes() for row in rows]
    for key in dict.fromkeys(keys):
        yield np.flatnonzero([k == key for k in keys])


def _decompositions(every: Matrix) -> Iterator[tuple[Places, Matrix, Matrix, Matrix, Matrix]]:
    """Yield the numbers (n,) and c0, c1, V, W of arms (arms, states, states), group by group of equal structure."""
    moves = np.asarray(every.any(axis=1))
    for chosen in _alike(moves):
        cyclic, inner = np.flatnonzero(~moves[chosen[0]]), np.flatnonzero(moves[chosen[0]])
        values, vectors = np.linalg.eig(every[chosen[:, None, None], inner[:, None], inner])
        for same in _alike(np.sign(values.imag).astype(np.int8)):
            rates = every[chosen[same][:, None, None], cyclic[:, None], inner]
            c0, c1, v, real, vibrating = _columns(values[same], vectors[same], rates, cyclic, inner)
            lacks = _lack(v[:, cyclic[:, None], 2 * real])
            for equal in _alike(lacks[:, None]):
                closed = _with_inverse(c0[equal], c1[equal], v[equal], real, vibrating, cyclic, inner, lacks[equal[0]])
                yield chosen[same][equal], *closed


def _columns(
    values: Complex, vectors: Complex, rates: Matrix, cyclic: Places, inner: Places
) -> tuple[Matrix, Matrix, Matrix, Places, Places]:
    """Compute c0, c1, V and the numbers of the real and of the vibrating blocks, from the eigenvectors of the inner states.

    Args:
        values: (n, inner).
        vectors: (n, inner, inner).
        rates: of the cyclic states, on which nothing depends, from the inner ones (n, cyclic, inner).
        cyclic: places of the ones among the states.
        inner: and of the others.
    """
    upper = np.flatnonzero(values[0].imag >= 0.0)
    values, vectors = values[:, upper], vectors[:, :, upper]
    real, vibrating = np.flatnonzero(values[0].imag == 0.0), np.flatnonzero(values[0].imag != 0.0)
    size = len(cyclic) + len(inner)
    c0, c1 = np.zeros(values.shape), -values.real
    v = np.zeros((len(values), size, 2 * len(upper)))
    if len(real):
        found = np.ascontiguousarray(vectors[:, :, real].real)
        v[:, inner[:, None], 2 * real + 1] = found
        v[:, cyclic[:, None], 2 * real] = rates @ found
    if len(vibrating):
        x, y = values[:, None, vibrating].real, values[:, None, vibrating].imag
        a, b = (np.ascontiguousarray(part[:, :, vibrating]) for part in (vectors.real, vectors.imag))
        if len(cyclic):
            whole = np.zeros((2, len(values), size, len(vibrating)))
            whole[0][:, inner], whole[1][:, inner] = a, b
            whole[0][:, cyclic], whole[1][:, cyclic] = _ratio(rates @ a, rates @ b, x, y)
            a, b = whole
        sizes = a[:, : size // 2 + 1] ** 2 + b[:, : size // 2 + 1] ** 2
        largest = np.arange(len(values))[:, None], sizes.argmax(axis=1), np.arange(len(vibrating))
        a, b = _ratio(a, b, a[largest][:, None], b[largest][:, None])
        v[:, :, 2 * vibrating + 1] = b / y
        v[:, :, 2 * vibrating] = a - x * b / y
        c0[:, vibrating], c1[:, vibrating] = (x**2 + y**2)[:, 0], -2.0 * x[:, 0]
    return c0, c1, v, real, vibrating


def _picked(matrix: Matrix, rows: Places, columns: Places) -> Matrix:
    """Rows and columns of matrices (n, …), one behind the other: how numpy multiplies depends on how they lie in memory."""
    return np.ascontiguousarray(matrix[:, rows[:, None], columns])


def _ratio(a: Matrix, b: Matrix, c: Matrix, d: Matrix) -> tuple[Matrix, Matrix]:
    """Real and imaginary part of (a + ib)/(c + id): numpy's own may round an arm's numbers by their place in an array."""
    size = c**2 + d**2
    return (a * c + b * d) / size, (b * c - a * d) / size


def _lack(cover: Matrix) -> NDArray[np.bool_]:
    """Whether each of the matrices (n, cyclic, real) has a lower rank than it has rows (n,)."""
    arms, cyclic, real = cover.shape
    if cyclic == 0 or real < cyclic:
        return np.full(arms, cyclic > 0)
    if cyclic == 1:
        return np.asarray(~cover.any(axis=(1, 2)))
    return np.asarray(np.linalg.matrix_rank(cover) < cyclic)


def _with_inverse(
    c0: Matrix, c1: Matrix, v: Matrix, real: Places, vibrating: Places, cyclic: Places, inner: Places, lacks: bool
) -> tuple[Matrix, Matrix, Matrix, Matrix]:
    """Compute c0, c1, V and its inverse W; with `lacks` the real modes do not span all cyclic places."""
    used = np.sort(np.concatenate([2 * real + 1, 2 * vibrating, 2 * vibrating + 1]))
    if lacks:  # then each has a block of its own, which never moves
        own = np.zeros((len(v), v.shape[1], 2 * len(cyclic)))
        own[:, cyclic, 2 * np.arange(len(cyclic))] = 1.0
        real = np.concatenate([real, c0.shape[1] + np.arange(len(cyclic))])
        still = np.zeros((len(v), len(cyclic)))
        v, c0, c1 = np.concatenate([v, own], axis=2), np.hstack([c0, still]), np.hstack([c1, still])
    w = np.zeros((len(v), v.shape[2], v.shape[1]))
    back = np.linalg.inv(_picked(v, inner, used))
    w[:, used[:, None], inner] = back
    if len(cyclic):
        cover = _picked(v, cyclic, 2 * real)
        one = len(cyclic) == 1
        spread = turned(cover) / (cover @ turned(cover)) if one else np.linalg.pinv(cover)
        w[:, 2 * real[:, None], cyclic] = spread
        w[:, 2 * real[:, None], inner] = -spread @ (_picked(v, cyclic, used) @ back)
    return c0, c1, v, w
