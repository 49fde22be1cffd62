"""The error budget: shares that sum to 1, each step with its own error, every accepted effect in its place, words that fit."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flexarm_env import Arm, Recording
from flexarm_env.experiments.simulate import simulate
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.conclude import conclude
from flexarm_env.identify.explain.budget import Budget, budget, budget_notes, rest_notes, torque_notes
from flexarm_env.identify.explain.error_steps import ErrorStep, error_steps
from flexarm_env.identify.explain.unexplained_torque import unexplained_torque
from flexarm_env.identify.percent import percent
from flexarm_env.identify.replay.dataset import Dataset, prepare
from flexarm_env.identify.replay.error_measure import Score, SignalError
from flexarm_env.identify.select.model import judge
from flexarm_env.identify.select.trace import Accepted, Trace, Tried
from flexarm_env.identify.settings import SETTINGS

NAMES = ("constants", "coulomb", "constant_torque")
TRUE = {"coulomb": {"torque": 0.05}, "constant_torque": {"torque": 0.02}}


def score(arm_angle: float, strain_base: float, noise: tuple[float, float] = (1e-3, 0.01)) -> Score:
    """Of two signals with as many readings each."""
    signals = {
        "arm_angle": SignalError(arm_angle, noise[0] * arm_angle),
        "strain_base": SignalError(strain_base, noise[1] * strain_base),
    }
    return Score(float(np.hypot(arm_angle, strain_base) / np.sqrt(2.0)), 1.0, signals)


def steps_through(*scores: Score) -> list[ErrorStep]:
    return [ErrorStep(name, *pair) for name, pair in zip(NAMES, pairwise(scores), strict=False)]


ERROR = st.floats(1.2, 1e6)


@given(st.lists(st.tuples(ERROR, ERROR), min_size=2, max_size=4))
def test_shares_sum_to_one_in_total_and_for_each_signal(errors):
    found = budget(steps_through(*(score(*pair) for pair in errors)), SETTINGS)
    for shares in (found.shares, *found.signals.values()):
        largest = max(map(abs, shares.values()))
        assert sum(shares.values()) == pytest.approx(1.0, abs=1e-9 * largest + 1e-9)
        assert list(shares) == [*NAMES[: len(errors) - 1], "rest"]


def test_shares_are_those_of_the_excess_as_a_variance():
    found = budget(steps_through(score(11.0, 2.0), score(9.0, 2.0), score(1.0, 3.0)), SETTINGS)
    assert found.signals["arm_angle"] == pytest.approx({"constants": 40 / 120, "coulomb": 80 / 120, "rest": 0.0}, abs=1e-3)
    assert found.signals["strain_base"] == pytest.approx({"constants": 0.0, "coulomb": -5 / 3, "rest": 8 / 3})
    assert found.shares["rest"] == pytest.approx((3.0**2 / 2.0 + 0.5 - 1.0) / (125.0 / 2.0 - 1.0))
    plain = found.as_json()
    assert plain["signals"]["arm_angle"] == dict(found.signals["arm_angle"])
    assert plain["left"]["strain_base"] == {"value": pytest.approx(0.03), "unit": "V"}


def test_where_nothing_is_wrong_shares_have_no_meaning():
    found = budget(steps_through(score(1.0, 1.05), score(1.0, 1.0)), SETTINGS)
    assert not found.has_meaning
    assert found.as_json()["constants"] is None
    one = budget(steps_through(score(9.0, 1.0), score(1.0, 1.0)), SETTINGS)
    assert one.has_meaning
    assert one.as_json()["signals"]["strain_base"] == {"constants": None, "rest": None}


def test_a_step_that_makes_a_signal_worse_is_told():
    steps = steps_through(score(9.0, 2.0), score(8.0, 2.1), score(1.0, 3.0))
    assert budget_notes(steps, SETTINGS) == ["adding coulomb raises the error of strain_base from 2.1 to 3 times the noise"]
    (total,) = budget_notes(steps_through(score(160.0, 160.0), score(170.0, 170.0)), SETTINGS)
    assert total == "the refit of the constants raises the held-out error from 160 to 170 times the noise"


def test_the_rest_is_told_with_its_signal_unit_and_share():
    steps = steps_through(score(20.0, 20.0), score(19.0, 19.0), score(2.0, 14.0))
    (note,) = rest_notes(budget(steps, SETTINGS), steps[-1].after.windows, SETTINGS)
    assert "errs by 10 times the noise, most in strain_base (14 times, 0.14 V rms), 75 % of the excess is explained" in note
    assert rest_notes(budget(steps_through(score(20.0, 20.0), score(1.0, 1.1)), SETTINGS), 1.05, SETTINGS) == []


@pytest.mark.parametrize(
    ("share", "text"),
    [(0.57, "57 %"), (0.994, "99.4 %"), (0.9998, "99.98 %"), (0.0002, "0.02 %"), (0.0, "0 %"), (-0.31, "−31 %")],
)
def test_a_share_has_the_digits_that_tell_it_from_none_and_all(share, text):
    assert percent(share) == text


def short(duration: float = 3.0) -> tuple[Arm, list]:
    nominal = Arm.load("cu-rigid")
    made = nominal.with_effect("coulomb", **TRUE["coulomb"]).with_effect("constant_torque", **TRUE["constant_torque"])
    return nominal, [simulate(made, "square", duration=duration, rate=100.0, seed=1)]


def squares(found: Score, dataset: Dataset) -> float:
    counts = dict(zip(dataset.signals, dataset.readings_by_signal(held_out=True), strict=True))
    return sum(counts[signal] * one.over_noise**2 for signal, one in found.signals.items()) / sum(counts.values())


@pytest.mark.parametrize("torque_noise", [0.0, 0.01])
def test_squares_by_signal_average_to_the_total(torque_noise):
    nominal, recordings = short()
    nominal = nominal.with_values({"drive.torque_noise": torque_noise})
    gaps = recordings[0].signals["arm_angle"].copy()
    gaps[::3] = np.nan
    recordings = [replace(recordings[0], signals={**recordings[0].signals, "arm_angle": gaps})]
    calibrator = Calibrator(*prepare(nominal, recordings))
    found = calibrator.score(calibrator.nominal)
    assert len(found.signals) == len(calibrator.dataset.signals) > 1
    assert squares(found, calibrator.dataset) == pytest.approx(found.windows**2)
    if not torque_noise:
        for (signal, one), noise in zip(found.signals.items(), calibrator.dataset.noise, strict=True):
            assert one.rms == pytest.approx(one.over_noise * noise), signal


def accepted_together() -> tuple[Calibrator, Trace, list]:
    """A search that accepted two effects in one step: the arm with the true ones beside one with its constants as given."""
    nominal, recordings = short()
    calibrator = Calibrator(*prepare(nominal, recordings))
    base = judge((), calibrator.uncalibrated(calibrator.nominal), calibrator.dataset)
    arm = calibrator.nominal
    for name, values in TRUE.items():
        arm = arm.with_effect(name, **values)
    both = judge(tuple(TRUE), calibrator.uncalibrated(arm), calibrator.dataset)
    accepted = [Accepted(name, (name,), both.score) for name in TRUE]
    return calibrator, Trace.begin(base).then("accept", both, accepted, [Tried("coulomb", 0.9)]), recordings


def test_effects_accepted_together_have_an_error_each():
    calibrator, trace, _ = accepted_together()
    constants, first, last = error_steps(trace.steps[0].model.score, trace, list(TRUE), calibrator)
    assert (constants.name, first.name, last.name) == ("constants", *TRUE)
    assert last.after == trace.model.score
    assert first.after == last.before
    assert first.after.windows > 2.0 * last.after.windows  # Coulomb friction alone leaves the constant torque


def test_a_model_of_the_trace_gives_the_error_between():
    calibrator, trace, _ = accepted_together()
    between = replace(trace.model, calibration=calibrator.uncalibrated(trace.model.arm.without_effect("constant_torque")))
    between = replace(between, effects=("coulomb",), score=Score(77.0, 77.0))
    known = replace(trace, chain=(*trace.chain, between))
    assert error_steps(Score(99.0, 99.0), known, list(TRUE), calibrator)[1].after == between.score


def test_every_accepted_effect_stands_in_ranking_errors_and_budget():
    calibrator, trace, recordings = accepted_together()
    nominal_score = trace.steps[0].model.score
    found = conclude("partly", trace, nominal_score, calibrator.nominal, recordings, calibrator, 0)
    assert found.effects == list(TRUE)
    assert [c.effect for c in found.ranking if c.accepted] == list(TRUE)
    assert all(c.estimates for c in found.ranking[:2])
    assert found.ranking[1].gain > 0.0
    assert list(found.error) == ["nominal", "refitted", *TRUE, "final"]
    assert found.error["coulomb"] > found.error["constant_torque"] == found.error["final"]
    assert list(found.budget.shares) == ["constants", *TRUE, "rest"]


def test_nothing_is_named_where_the_verdict_names_nothing():
    calibrator, trace, recordings = accepted_together()
    found = conclude("unknown", trace, trace.steps[0].model.score, calibrator.nominal, recordings, calibrator, 0)
    assert found.effects == []
    assert list(found.budget.shares) == ["constants", "rest"]
    assert list(found.error) == ["nominal", "refitted", "final"]


def test_the_unexplained_torque_is_that_of_the_missing_effects():
    nominal, recordings = short(4.0)  # the hub moves as long to one side as to the other
    complete = nominal
    for name, values in TRUE.items():
        complete = complete.with_effect(name, **values)
    missing, rest = (unexplained_torque(*prepare(arm, recordings)) for arm in (nominal, complete))
    assert missing == pytest.approx(np.hypot(0.05, 0.02), rel=0.1)
    assert rest < 0.3 * missing


def test_the_unexplained_torque_falls_where_the_hub_mostly_rests():
    """At rest friction has any value up to its own, with the sign of the noise: over all samples, the rest would rise."""
    nominal, missing = Arm.load("cu-rigid"), 0.05
    time = 0.004 * np.arange(2000)
    volts = 3.0 * missing / nominal.structure().torque_by_command
    pulse = np.where(time % 2.0 < 0.15, volts, np.where(time % 2.0 < 0.25, -volts, 0.0)) * np.where(time % 4.0 < 2.0, 1.0, -1.0)
    complete = nominal.with_effect("coulomb", torque=missing)
    commands = Recording.from_arrays("pulses", time, nominal.input, pulse, {"arm_angle": np.zeros_like(time)})
    recording = simulate(complete, commands, seed=2)
    before, after = (unexplained_torque(*prepare(arm, [recording])) for arm in (nominal, complete))
    assert before == pytest.approx(missing, rel=0.1)
    assert after < 0.1 * before


def test_the_unexplained_torque_is_told_from_step_to_step():
    found = Budget(torque={"nominal": 0.083, "constants": 0.081, "final": 0.004})
    (note,) = torque_notes(found, ["coulomb"])
    assert note.endswith("0.083 (as given) → 0.081 (constants refitted) → 0.004 (with coulomb) Nm")
    assert torque_notes(Budget(torque={"nominal": float("nan")}), []) == []
