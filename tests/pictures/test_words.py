"""Numbers and sentences for a person."""

from __future__ import annotations

import pytest

from flexarm_env.identify.explain.budget import Budget
from flexarm_env.identify.replay.error_measure import SignalError
from flexarm_env.pictures import words


@pytest.mark.parametrize(
    ("value", "half", "text"),
    [
        (0.061234, 0.003, "0.0612"),
        (0.061234, 0.00031, "0.06123"),
        (7.911324, 0.02, "7.911"),
        (123456.0, 2000.0, "123456"),
        (1.0, 5.0, "1.0"),
        (0.0, 0.1, "0"),
        (2.5e-7, 1e-8, "2.50e-07"),
        (float("nan"), 1.0, "–"),
        (0.5, float("inf"), "0.5000"),
    ],
)
def test_a_value_has_the_digits_that_its_interval_leaves(value, half, text):
    assert words.rounded(value, value - half, value + half) == text


def test_steps_name_each_effect_once():
    error = {"nominal": 4.0, "refitted": 3.0, "backlash": 2.0, "stribeck": 1.0, "final": 1.0}
    names = [name for name, _ in words.steps_of(error, ["backlash", "stribeck"])]
    assert names == ["as given", "constants refitted", "+ backlash", "+ stribeck"]
    assert [v for _, v in words.steps_of({"nominal": 4.0, "refitted": 3.0, "final": 3.0})] == [4.0, 3.0]
    dropped = {"nominal": 4.0, "refitted": 3.0, "backlash": 1.12, "final": 1.15}
    assert words.steps_of(dropped, ["backlash"])[2:] == [("+ backlash", 1.15)]
    free = words.steps_of({"nominal": 4.0, "refitted": 3.0, "final": 1.5}, ["backlash", "stribeck"])
    assert free[2:] == [("+ backlash + stribeck", 1.5)]
    fell = words.change({"nominal": 4.0, "refitted": 3.0, "final": 1.0}, ["backlash"])
    assert fell == "falls 4.00 → 3.00 → 1.00 × the noise"


def test_sparklines_and_bars_go_from_nothing_to_the_largest():
    assert words.sparkline([0.0, 1.0, 4.0, 8.0]) == "▁▂▅█"
    assert words.sparkline([1.0, float("nan")], 8.0) == "▂ "
    assert words.sparkline([0.0, 0.0]) == "▁▁"
    assert [words.bar(share, 4) for share in (0.0, 1e-6, 0.5, 0.53125, 1.0, 2.0)] == ["", "▏", "██", "██▏", "████", "████"]
    assert words.bar(float("nan")) == ""


@pytest.mark.parametrize(
    ("errors", "said"),
    [
        ((68.3, 94.6), "rises 68.3 → 94.6 × the noise"),
        ((4299.0, 4313.0, 286.0), "goes 4299 → 4313 → 286 × the noise"),
        ((4.1, 3.7, 1.02), "falls 4.10 → 3.70 → 1.02 × the noise"),
        ((4.1, 3.7, 3.7), "falls 4.10 → 3.70 → 3.70 × the noise"),
        ((94.61, 94.62), "stays at 94.6 × the noise"),
    ],
)
def test_the_verb_of_a_sentence_follows_the_errors(errors, said):
    named = dict(zip(("nominal", "refitted", "final"), errors, strict=False))
    assert words.change(named, ["backlash"] if len(errors) == 3 else []) == said


def test_the_budget_in_words_counts_down_to_the_rest():
    found = Budget({"constants": -0.05, "backlash": 0.99, "rest": 0.06})
    sentence = words.budget_sentence(found)
    assert sentence.startswith("Of the excess error (error² − 1), constants −5 %, backlash 99 %, nothing 6 %")
    assert "less than 0" in sentence
    assert words.budget_sentence(Budget({"constants": float("nan"), "rest": float("nan")})) == ""


def test_the_table_of_the_budget_has_the_error_left_in_the_unit_of_the_signal():
    errors = {"nominal": SignalError(20.0, 0.2), "constants": SignalError(3.0, 0.03)}
    found = Budget({"constants": 0.98, "rest": 0.02}, {"strain_base": {"constants": 0.98, "rest": 0.02}}, {"strain_base": errors})
    assert words.budget_columns(found) == ["explained by", "all signals", "strain, base"]
    assert words.budget_rows(found)[-2:] == [["error left / noise", "", "3.00"], ["error left, rms", "", "0.030 V"]]
    assert [row[:2] for row in words.budget_rows(found)[:2]] == [["constants", "98 %"], ["nothing (the rest)", "2 %"]]
