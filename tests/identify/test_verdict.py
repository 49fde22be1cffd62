"""What a search's errors make of a verdict."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from flexarm_env import Arm
from flexarm_env.identify.replay.error_measure import Score, SignalError, error_measure
from flexarm_env.identify.select.criteria import ThresholdCriteria
from flexarm_env.identify.select.model import Model
from flexarm_env.identify.settings import SETTINGS


def verdict(
    before: Score, first: Score, best: Score, accepted: list[str], arm: str = "thesis", fitted: Score | None = None
) -> str:
    """By held-out errors: of the arm as given, with constants, with effects; and by the constants' on the fitted part."""
    criteria = ThresholdCriteria(before, first, error_measure(Arm.load(arm)).judges_free_run, SETTINGS)
    return criteria.verdict(accepted, Model((), None, first, fitted or first), Model((), None, best, best))


BEFORE, FIRST = Score(20.0, 60.0), Score(3.0, 12.0)


@pytest.mark.parametrize(
    ("best", "accepted", "said"),
    [
        (Score(1.01, 1.03), ["backlash"], "effects"),
        (Score(1.18, 1.19), ["backlash"], "effects"),
        (Score(1.18, 6.0), ["backlash"], "effects"),  # a whole run is not at the noise, but most of its error is gone
        (Score(1.5, 1.6), ["friction_warmup"], "partly"),  # comes near, and stops short of the noise
        (Score(1.1, 11.0), ["friction_warmup"], "unknown"),  # explains the seconds that it was fitted to, no whole run
        (Score(2.6, 2.8), ["cogging"], "unknown"),
        (Score(2.0, 8.0), ["brush_drop"], "unknown"),  # most of the one, not of the other
        (FIRST, [], "unknown"),
    ],
)
def test_an_effect_is_named_if_it_explains_windows_and_whole_runs(best, accepted, said):
    assert verdict(BEFORE, FIRST, best, accepted) == said


@pytest.mark.parametrize(
    ("best", "said"),
    [
        (Score(1.19, 1.4), "effects"),
        (Score(2.0, 2.0), "partly"),  # 3 % left
        (Score(2.9, 2.9), "partly"),  # 7 % left, near the noise
        (Score(5.0, 5.0), "partly"),  # 24 % left, where no model comes near, as of a real machine
        (Score(6.0, 6.0), "unknown"),
    ],
)
def test_effects_that_leave_more_than_the_noise_explain_a_part_and_no_less_than_most(best, said):
    assert verdict(BEFORE, Score(10.0, 10.0), best, ["coulomb"]) == said


def test_a_free_run_says_nothing_where_noise_drives_the_arm():
    assert verdict(BEFORE, FIRST, Score(1.0, 11.0), ["asymmetric_viscous"], "emps") == "effects"


def test_a_weak_effect_is_named_though_a_whole_run_gains_nothing():
    assert verdict(BEFORE, Score(1.32, 1.34), Score(1.05, 1.46), ["saturation"]) == "effects"


def test_constants_are_blamed_where_nothing_else_is_left():
    assert verdict(BEFORE, Score(1.0, 1.0), Score(1.0, 1.0), []) == "parameters"
    assert verdict(Score(1.0, 1.0), Score(1.0, 1.0), Score(1.0, 1.0), []) == "nothing_missing"


@pytest.mark.parametrize("accepted", [[], ["pot_nonlinearity"]])
def test_something_is_missing_where_the_fitted_part_alone_shows_it(accepted):
    """Of a stop that was touched once, before what is held out; an effect that imitates it there explains no whole run."""
    first = Score(1.08, 640.0)
    assert verdict(first, first, Score(1.07, 600.0), accepted, fitted=Score(134.0, 590.0)) == "unknown"


def rival(fitted: float, held: float, parameters: int = 10) -> float:
    """Its criterion on 2600 fitted and 1400 held-out samples of one signal."""
    dataset = SimpleNamespace(readings=lambda held_out: 1400 if held_out else 2600)
    own = SimpleNamespace(parameters=[None] * parameters)
    model = Model((), own, fitted_score=Score(fitted, fitted), score=Score(held, held))
    return model.bic(dataset)


def test_all_of_the_data_decide_between_rivals():
    assert rival(1.0, 1.02) == pytest.approx(2600.0 + 1400.0 * 1.02**2 + 10 * np.log(4000.0))
    assert rival(1.0, 1.02) < rival(1.02, 1.0)  # more samples were fitted than held out
    assert rival(1.0, 1.0) < rival(1.0, 1.0, parameters=11)
    assert rival(1.0, 1.0, parameters=11) < rival(1.01, 1.0)


def of_signals(windows: float, **errors: float) -> Score:
    return Score(windows, windows, {signal: SignalError(error, error) for signal, error in errors.items()})


@pytest.mark.parametrize(
    ("strain_before", "strain_after", "said"),
    [
        (9.0, 1.6, "partly"),  # touched, and more than the noise is left in it
        (47.0, 1.43, "effects"),  # touched, and 0.05 % of its excess is left in it
        (9.0, 1.3, "effects"),
        (1.65, 1.6, "effects"),  # not touched
    ],
)
def test_each_signal_that_effects_touch_ends_near_the_noise(strain_before, strain_after, said):
    first = of_signals(10.0, arm_angle=11.0, strain_base=strain_before)
    assert verdict(BEFORE, first, of_signals(1.19, arm_angle=1.0, strain_base=strain_after), ["coulomb"]) == said
