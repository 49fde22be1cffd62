"""Numbers and sentences for a person."""

from __future__ import annotations

import pytest

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
    assert words.arrows({"nominal": 4.0, "refitted": 3.0, "final": 1.0}, ["backlash"]) == "4.00 → 3.00 → 1.00"


def test_sparklines_and_bars_go_from_nothing_to_the_largest():
    assert words.sparkline([0.0, 1.0, 4.0, 8.0]) == "▁▂▅█"
    assert words.sparkline([1.0, float("nan")], 8.0) == "▂ "
    assert words.sparkline([0.0, 0.0]) == "▁▁"
    assert [words.bar(share, 4) for share in (0.0, 1e-6, 0.5, 0.53125, 1.0, 2.0)] == ["", "▏", "██", "██▏", "████", "████"]
    assert words.bar(float("nan")) == ""
