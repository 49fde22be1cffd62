"""Of models that recordings do not tell apart, the simplest is named; calibrating twice measures how far apart that is."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from flexarm_env.effects import catalogue
from flexarm_env.identify.replay.error_measure import Score
from flexarm_env.identify.select import rivals
from flexarm_env.identify.select.criteria import ThresholdCriteria
from flexarm_env.identify.select.model import Model
from flexarm_env.identify.settings import Settings

NUMBERS = {"cable_stiffness": 2, "end_stop": 4}


def model(effect: str, error: float) -> Model:
    score = Score(error, error)
    return Model(
        (effect,), SimpleNamespace(arm=SimpleNamespace(known=catalogue()), parameters=range(NUMBERS[effect])), score, score
    )


def named(
    monkeypatch: pytest.MonkeyPatch, first: dict[str, float], again: dict[str, float], calibrated: int = 2
) -> tuple[str, ...]:
    """The effects that the recordings do not tell apart, by the errors of their first calibrations and of their second ones."""
    second: list[Model] = []
    monkeypatch.setattr(rivals, "fit_models", lambda *_, **__: second.extend(model(*one) for one in again.items()) or second)
    settings = Settings()
    before = model("cable_stiffness", 14.0)
    criteria = ThresholdCriteria(before.score, before.score, True, settings)
    calibrator = SimpleNamespace(
        dataset=SimpleNamespace(readings=lambda held_out: 30_000), settings=settings, nominal_with_effects_of=lambda arm: arm
    )
    models = [model(name, error) for name, error in first.items()]
    winner = min(models, key=lambda m: m.score.windows)
    found = rivals.find_rivals(calibrator, criteria, before, winner, models, lambda score: score.excess)
    assert len(second) == calibrated
    return tuple(m.effects[0] for m in found.models)


def test_where_calibrations_end_in_different_minima_the_simplest_of_near_rivals_is_named(monkeypatch) -> None:
    found = named(monkeypatch, {"cable_stiffness": 1.026, "end_stop": 1.010}, {"cable_stiffness": 1.058, "end_stop": 1.035})
    assert found == ("cable_stiffness", "end_stop")


def test_where_calibrations_agree_the_best_is_named_first(monkeypatch) -> None:
    errors = {"cable_stiffness": 1.026, "end_stop": 1.010}
    assert named(monkeypatch, errors, {name: 1.0005 * error for name, error in errors.items()}) == ("end_stop", "cable_stiffness")


def test_a_simple_model_that_leaves_more_than_calibrations_differ_by_is_not_named_first(monkeypatch) -> None:
    found = named(monkeypatch, {"cable_stiffness": 1.05, "end_stop": 1.00}, {"cable_stiffness": 1.06, "end_stop": 1.02})
    assert found[0] == "end_stop"


def test_the_simplest_of_equals_is_named_though_calibrations_agree(monkeypatch) -> None:
    errors = {"cable_stiffness": 1.0015, "end_stop": 1.000}
    assert named(monkeypatch, errors, errors) == ("cable_stiffness", "end_stop")


def test_no_rival_of_more_numbers_is_calibrated_again_beside_a_model_that_leaves_only_noise(monkeypatch) -> None:
    for left, names in ((1.001, ("cable_stiffness", "end_stop")), (2.0, ("cable_stiffness",))):
        errors = {"cable_stiffness": 1.000, "end_stop": left}
        assert named(monkeypatch, errors, errors, calibrated=0) == names


@pytest.mark.parametrize("errors", [{"cable_stiffness": 1.020, "end_stop": 1.021}, {"cable_stiffness": 1.001, "end_stop": 1.000}])
def test_beside_a_simpler_rival_or_one_that_could_leave_less_every_model_is_calibrated_again(monkeypatch, errors) -> None:
    named(monkeypatch, errors, errors, calibrated=2)


@pytest.mark.parametrize(("cost", "names"), [(1005.0, ("cable_stiffness", "end_stop")), (1007.0, ("cable_stiffness",))])
def test_far_off_rivals_are_those_whose_forecasts_are_as_likely(cost, names) -> None:
    winner, other, settings = model("cable_stiffness", 9.0), model("end_stop", 8.0), Settings()
    vars(winner)["forecast_cost"], vars(other)["forecast_cost"] = 1000.0, cost
    before = model("cable_stiffness", 40.0)
    criteria = ThresholdCriteria(before.score, before.score, True, settings)
    calibrator = SimpleNamespace(settings=settings)
    found = rivals.find_rivals(calibrator, criteria, before, winner, [other, winner], lambda score: score.excess)
    assert tuple(m.effects[0] for m in found.models) == names
