"""The sensors' noise is normal, and each draw depends on its key, stream and place alone."""

from __future__ import annotations

import numpy as np
import pytest
from numba import njit
from scipy import stats

from flexarm_env.env.draws import EDGES, GOLDEN, LAYER_AREA, mixed, normal

DRAWS = 1_000_000


@njit
def draws(stream: int, count: int) -> np.ndarray:
    out = np.empty(count)
    for i in range(count):
        out[i] = normal(stream, i)
    return out


@pytest.fixture(scope="module")
def drawn() -> np.ndarray:
    return draws(np.uint64(mixed(GOLDEN)), DRAWS)


def test_the_layers_have_equal_areas_and_fill_the_density() -> None:
    heights = np.exp(-0.5 * EDGES[1:] ** 2)
    areas = EDGES[1:-1] * np.diff(heights)
    assert areas == pytest.approx(np.full(len(areas), LAYER_AREA), rel=1e-9)
    tail = np.sqrt(2.0 * np.pi) * stats.norm.sf(EDGES[1])
    assert EDGES[1] * heights[0] + tail == pytest.approx(LAYER_AREA, rel=1e-9)


def test_the_draws_are_normal(drawn: np.ndarray) -> None:
    assert stats.kstest(drawn, "norm").pvalue > 1e-3
    for power, moment in ((1, 0.0), (2, 1.0), (3, 0.0), (4, 3.0), (6, 15.0)):
        powers = drawn**power
        assert abs(powers.mean() - moment) < 4.0 * powers.std() / DRAWS**0.5


def test_the_tail_is_normal(drawn: np.ndarray) -> None:
    tail = np.abs(drawn[np.abs(drawn) > EDGES[1]])
    share = 2.0 * stats.norm.sf(EDGES[1])
    assert abs(len(tail) - share * DRAWS) < 4.0 * (share * DRAWS) ** 0.5
    assert stats.kstest(1.0 - stats.norm.sf(tail) / stats.norm.sf(EDGES[1]), "uniform").pvalue > 1e-3


def test_draws_of_neighbours_are_not_alike(drawn: np.ndarray) -> None:
    other = draws(np.uint64(mixed(GOLDEN + np.uint64(1))), DRAWS)
    pairs = [(drawn[1:], drawn[:-1]), (drawn[4:], drawn[:-4]), (drawn, other), (drawn[1:] ** 2, drawn[:-1] ** 2)]
    for first, second in pairs:
        assert abs(np.corrcoef(first, second)[0, 1]) < 4.0 / DRAWS**0.5


def test_a_draw_is_a_function_of_its_place(drawn: np.ndarray) -> None:
    stream = np.uint64(mixed(GOLDEN))
    places = [7, 3, 99_999, 3]
    assert [normal(stream, i) for i in places] == [drawn[i] for i in places]
