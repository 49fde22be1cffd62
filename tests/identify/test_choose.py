"""Which of several models is taken: the simplest of those that remove most, and far off the one that forecasts find likely."""

from __future__ import annotations

import pytest
from searches import far_off, scored

from flexarm_env.identify.replay.error_measure import Score
from flexarm_env.identify.select.choose import simplest, with_forecasts
from flexarm_env.identify.select.model import Model


def simplest_far_off(models, before):
    search = far_off()
    measure = search.criteria.measure([m.score for m in models])
    return simplest(search.calibrator, search.criteria, models, scored(before), measure)


@pytest.mark.parametrize(
    ("costs", "named"),
    [
        ((38_800.0, 29_100.0, 32_200.0, 60_000.0), ("coulomb", "constant_torque")),
        ((28_000.0, 29_100.0, 32_200.0, 60_000.0), ("end_stop",)),
        ((38_800.0, 29_100.0, 29_105.0, 60_000.0), ("coulomb",)),
        ((38_800.0, 29_100.0, 32_200.0, 20_000.0), ("coulomb", "constant_torque")),
    ],
)
def test_far_off_forecasts_choose_among_those_that_remove_most(costs, named):
    """A stop halts an arm where friction does; an offset of a sensor leaves most of the error, whatever it makes likely."""
    models = [
        scored(Score(14.6, 14.7), "end_stop"),
        scored(Score(9.7, 14.8), "coulomb", "constant_torque"),
        scored(Score(22.6, 60.0), "coulomb"),
        scored(Score(61.0, 800.0), "sensor_offset"),
    ]
    for one, cost in zip(models, costs, strict=True):
        vars(one)["forecast_cost"] = cost
    assert simplest_far_off(models, Score(70.0, 900.0)).effects == named


@pytest.mark.parametrize(("left", "fitted"), [(9.0, True), (2.0, False)])
def test_forecasts_are_fitted_only_where_models_are_ranked_by_them(monkeypatch, left, fitted):
    ranked, search = [], far_off()
    monkeypatch.setattr(Model, "forecast_cost", property(lambda m: ranked.append(m.effects)))
    models = [scored(Score(9.0, 9.0), "end_stop"), scored(Score(10.0, 10.0), "coulomb")]
    assert with_forecasts(search.calibrator, search.criteria, models, Score(left, left)) == models
    assert ranked == ([("end_stop",), ("coulomb",)] if fitted else [])


def test_an_effect_that_windows_ask_for_is_chosen_though_whole_runs_end_elsewhere():
    """A delay, beside a stop that is missing as well: where a run ends is up to the stop."""
    models = [scored(Score(15.5, 125.9), "input_delay", "constant_torque"), scored(Score(7.0, 139.7), "input_delay")]
    for one, cost in zip(models, (20_000.0, 9_000.0), strict=True):
        vars(one)["forecast_cost"] = cost
    assert simplest_far_off(models, Score(36.2, 147.5)).effects == ("input_delay",)
