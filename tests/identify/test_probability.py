"""The probability of a named effect follows the verdict, what is left, and the effects that equal it."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.answers.figures import calibration
from benchmarks.hidden_effects.score import believed
from flexarm_env.identify.explain.probability import probabilities
from flexarm_env.identify.settings import Probabilities

NUMBERS = Probabilities()
GROUPS = st.lists(st.lists(st.sampled_from("abcdef"), min_size=1, max_size=5, unique=True), max_size=3)


@given(GROUPS, st.floats(0.0, 2.0))
def test_equivalents_share_a_probability_and_the_first_has_most(equivalent, left):
    found = probabilities(equivalent, left, NUMBERS)
    assert [len(every) for every in found] == [len(names) for names in equivalent]
    for every in found:
        assert 0.0 < sum(every) <= NUMBERS.explained + 1e-12
        assert every[0] == max(every)


def test_what_leaves_more_is_less_probable():
    (noise,), (little,), (much,) = (probabilities([["coulomb"]], left, NUMBERS)[0] for left in (0.0, 0.004, 0.3))
    assert 1.0 > noise > little > much > 0.0


def answer(named, probability, hidden):
    return {"found": {"effects": named, "probability": probability}, "case": {"effects": hidden}}


def test_a_twin_is_right_and_the_first_of_equivalents_counts():
    answers = [answer(["time_offset", "cogging"], [[0.8, 0.1], [0.9]], ["input_delay"]), answer([], [], ["coulomb"])]
    assert believed(answers) == [(0.8, True), (0.9, False)]


def test_the_calibration_error_is_that_of_groups_of_equal_probability():
    pairs = [(0.9, True)] * 8 + [(0.9, False)] * 2 + [(0.2, False)] * 5
    assert calibration("", 0.05, pairs).value == pytest.approx((10 * 0.1 + 5 * 0.2) / 15)
    assert not calibration("", 0.05, pairs).met
    assert calibration("", 0.05, [(0.5, True), (0.5, False)]).met
    assert calibration("", 0.05, []).value is None
