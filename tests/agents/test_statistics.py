"""Interquartile means, intervals over runs and paired comparisons, against closed forms and scipy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import mannwhitneyu, norm, trim_mean

from agents.statistics import improvement, interquartile_mean, stratified_interval


@pytest.mark.parametrize("size", [1, 3, 4, 7, 100, 1001])
def test_the_interquartile_mean_is_a_trimmed_mean(size: int) -> None:
    values = np.random.default_rng(size).exponential(1.0, size)
    assert interquartile_mean(values) == pytest.approx(trim_mean(values, 0.25), rel=1e-12)


def test_an_outlier_in_each_quarter_does_not_move_it() -> None:
    values = np.arange(8.0)
    wild = values.copy()
    wild[[0, 1, 6, 7]] = -1e9, -1e9, 1e9, 1e9
    assert interquartile_mean(wild) == interquartile_mean(values) == 3.5


def test_the_interval_covers_the_middle_of_many_runs() -> None:
    draw, hits = np.random.default_rng(0), 0
    for k in range(40):
        runs = draw.normal(0.0, 1.0, (12, 1)) + draw.normal(0.0, 0.3, (12, 20))
        _, low, high = stratified_interval([runs], seed=k)
        hits += low <= 0.0 <= high
    assert 33 <= hits <= 40  # 95 % of 40, a little less for a dozen runs


def test_more_arms_do_not_stand_in_for_more_runs() -> None:
    draw = np.random.default_rng(1)
    effect = draw.normal(0.0, 1.0, (5, 1))
    _, low, high = stratified_interval([effect + draw.normal(0.0, 0.01, (5, 2000))])
    assert high - low > 0.5


def test_strata_keep_their_share() -> None:
    low, high = np.zeros((3, 10)), np.ones((3, 10))
    value, least, most = stratified_interval([low, high], lambda values: values.mean(axis=-1))
    assert value == least == most == 0.5


def test_one_seed_gives_the_same_interval() -> None:
    values = np.random.default_rng(2).normal(size=(4, 30))
    assert stratified_interval([values], seed=3) == stratified_interval([values], seed=3)
    assert improvement(values, values[:1] + 0.1, seed=3) == improvement(values, values[:1] + 0.1, seed=3)


def test_the_probability_of_improvement_of_normal_differences() -> None:
    draw = np.random.default_rng(3)
    arms = draw.normal(0.0, 10.0, 4000)
    value, low, high = improvement(arms + draw.normal(-0.5, 1.0, (1, 4000)), arms[None])
    assert value == pytest.approx(norm.cdf(0.5), abs=0.02)
    assert low < norm.cdf(0.5) < high


def test_the_probability_of_improvement_over_single_arms_is_mann_whitney_s() -> None:
    draw = np.random.default_rng(4)
    values, reference = draw.integers(0, 6, (9, 1)).astype(float), draw.integers(0, 6, (7, 1)).astype(float)
    wins = mannwhitneyu(reference[:, 0], values[:, 0]).statistic
    assert improvement(values, reference)[0] == pytest.approx(wins / (9 * 7))


def test_pairs_show_what_an_unpaired_comparison_hides() -> None:
    difficulty = np.random.default_rng(5).normal(0.0, 10.0, (1, 60))
    assert improvement(difficulty - 0.1, difficulty) == (1.0, 1.0, 1.0)
