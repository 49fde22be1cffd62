"""An accepted effect beside its rivals: which one takes its place, and what stays equivalent."""

from __future__ import annotations

from contextlib import nullcontext
from types import SimpleNamespace

import pytest

from flexarm_env import Arm
from flexarm_env.identify.progress import Progress
from flexarm_env.identify.replay.error_measure import Score
from flexarm_env.identify.select import swap
from flexarm_env.identify.select.criteria import ThresholdCriteria
from flexarm_env.identify.select.model import Model
from flexarm_env.identify.select.trace import Accepted
from flexarm_env.identify.settings import SETTINGS
from flexarm_env.identify.workers import Workers

NUMBERS = {"constant_torque": 1, "asymmetric_coulomb": 1, "cable_stiffness": 2, "end_stop": 4}
BASE = 3  # numbers of the constants


def model(effect: str, error: float | Score, beside: tuple[str, ...] = ()) -> Model:
    """Of the thesis's arm with an effect, beside others that a model has."""
    arm, score = Arm.load("thesis"), error if isinstance(error, Score) else Score(error, error)
    for name in (effect, *beside):
        arm = arm.with_effect(name)
    free = SimpleNamespace(arm=arm, parameters=[SimpleNamespace(path=f"hub.{i}") for i in range(BASE + NUMBERS[effect])])
    return Model((effect, *beside), free, score, score)


def compared(
    monkeypatch: pytest.MonkeyPatch,
    effect: str,
    error: float | Score,
    rivals: dict[str, float | Score | None],
    equivalent: tuple[str, ...] = (),
    gain: float = 0.0,
) -> swap.RivalComparison:
    """An effect beside a limit of the command's rate, compared with rivals in its place.

    By the errors that they leave, and what each of the rivals gains in the log density of forecasts.
    """
    now = model(effect, error, beside=("rate_limit",))
    fitted = {name: left and model(name, left) for name, left in rivals.items()}
    monkeypatch.setattr(Model, "forecast_cost", property(lambda m: 0.0 if m.effects[0] == effect else -gain))
    by_calibration = {id(m.calibration): m for m in (now, *fitted.values()) if m}
    monkeypatch.setattr(swap, "fit_in_place", lambda _, without, effects, *a, **b: [fitted.get(name) for name in effects])
    monkeypatch.setattr(swap, "judge", lambda effects, calibration, dataset: by_calibration[id(calibration)])
    calibrator = SimpleNamespace(
        settings=SETTINGS,
        workers=SimpleNamespace(threads=nullcontext, map=Workers(1).map),
        dataset=SimpleNamespace(
            signals=(), noise=(), scales={}, middle_of_travel=0.0, settings=SETTINGS, readings=lambda held_out: 2000
        ),
        polish=lambda calibration: calibration,
        calibrate_on_all_data=lambda calibration: calibration,
    )
    criteria = ThresholdCriteria(Score(100.0, 900.0), Score(100.0, 900.0), True, SETTINGS)
    return swap.compare_rivals(calibrator, criteria, Accepted(effect, (effect, *equivalent), now.score), now, Progress())


def test_an_equivalent_that_cannot_be_a_rival_at_the_noise_is_none_any_more(monkeypatch):
    found = compared(monkeypatch, "cable_stiffness", 1.0, {}, equivalent=("air_drag",))
    assert "air_drag" in found.tried
    assert not found.alike


@pytest.mark.parametrize("stop", [None, 1.048])
def test_a_rival_that_fits_best_does_not_keep_a_simpler_one_from_the_place(monkeypatch, stop):
    """Stops on either side of a cable's rest fit as the cable does; a constant torque does so with one number."""
    found = compared(monkeypatch, "cable_stiffness", 1.05, {"end_stop": stop, "constant_torque": 1.0519}, ("end_stop",))
    assert found.effect == "constant_torque"
    assert set(found.alike) == {"cable_stiffness"} | ({"end_stop"} if stop else set())


def test_a_simpler_rival_that_leaves_more_does_not_take_the_place(monkeypatch):
    found = compared(monkeypatch, "cable_stiffness", 1.05, {"end_stop": 1.048, "constant_torque": 1.2}, ("end_stop",))
    assert found.effect == "cable_stiffness"


@pytest.mark.parametrize("first", ["constant_torque", "asymmetric_coulomb"])
def test_of_exact_twins_the_law_of_fewer_quantities_has_the_place_whatever_stands_beside_it(monkeypatch, first):
    (other,) = {"constant_torque", "asymmetric_coulomb"} - {first}
    found = compared(monkeypatch, first, 1.05, {other: 1.05})
    assert found.effect == "constant_torque"
    assert set(found.alike) == {"asymmetric_coulomb"}


@pytest.mark.parametrize(
    ("windows", "gain", "first"),
    [
        (18.0, 900.0, "constant_torque"),
        (15.0, 900.0, "cable_stiffness"),
        (15.0, 5.0, "constant_torque"),
        (15.0, -900.0, "constant_torque"),
    ],
)
def test_far_off_a_rival_of_more_numbers_is_better_in_forecasts_and_in_windows(monkeypatch, windows, gain, first):
    """A cable imitates a constant torque in whole runs: a student's arm, whose errors in windows differ by 1 %."""
    rivals = {"cable_stiffness": Score(windows, 61.3)}
    assert compared(monkeypatch, "constant_torque", Score(18.2, 71.1), rivals, gain=gain).effect == first
