"""The search for what is missing: effects change places, and what begins too large begins again."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from flexarm_env import Arm
from flexarm_env.experiments.simulate import simulate
from flexarm_env.identify import fits
from flexarm_env.identify.acceptance import Acceptance
from flexarm_env.identify.data import Data, prepare
from flexarm_env.identify.hypothesis import Hypothesis, judged
from flexarm_env.identify.problem import Score, score
from flexarm_env.identify.refit import best_refit, refit
from flexarm_env.identify.rivals import Place, rivals_of
from flexarm_env.identify.search import Search
from flexarm_env.recordings.recording import Recording

TRUE = {
    "asymmetric_coulomb": {"torque": 0.05},
    "constant_torque": {"torque": 0.05},
}


def searched(taken: str, data: Data, nominal: Arm) -> Search:
    """A search that has taken an effect already."""
    search = Search(nominal, data, 1, lambda done, text: None)
    search.first = score(best_refit(nominal, data).arm, data)
    search.rules = Acceptance(search.first, search.noisy)
    search.found = refit(nominal.with_effect(taken, torque=0.04), nominal, data)
    search.best = score(search.found.arm, data)
    search.accepted, search.equivalent, search.steps = [taken], [[taken]], {taken: search.best}
    return search


@pytest.mark.parametrize("taken", sorted(TRUE))
@pytest.mark.parametrize("hidden", sorted(TRUE))
def test_what_was_taken_gives_way_to_what_fits_better(hidden, taken):
    nominal = Arm.load("thesis")
    made = nominal.with_effect(hidden, **TRUE[hidden])
    arm, data = prepare(nominal, [simulate(made, experiment, seed=3, duration=8.0) for experiment in ("square", "sweep")])
    search = searched(taken, data, arm)
    search._swap(0.5)
    assert search.accepted == [hidden]
    assert search.equivalent[0][0] == hidden
    assert list(search.steps) == [hidden]
    assert search.best.windows < 1.05


def test_an_effect_that_began_too_large_begins_again(monkeypatch):
    nominal = Arm.load("thesis-fem")
    made = nominal.with_effect("backlash", gap=0.0007).with_values({"hub.inertia": 1.2 * nominal.value("hub.inertia")})
    arm, data = prepare(nominal, [simulate(made, "pulse", seed=1, duration=5.0)])
    monkeypatch.setattr(fits, "candidates", lambda arm: ["backlash", "current_lag"])
    base = best_refit(arm, data)
    untried = fits.Trial("", base.arm, 0.0, 0.0)
    found = fits.Fits(arm, data, 1, lambda done, text: None).with_all_constants(base, [untried], [], 0.0, 1.0)
    assert found[0].effects == ("backlash",)
    assert found[0].refit.arm.effects["backlash"]["gap"] == pytest.approx(0.0007, rel=0.1)
    assert found[0].score.windows < 0.5 * score(base.arm, data).windows


def hypothesis(*effects: str, error: float = 1.0) -> Hypothesis:
    """Of the thesis's arm with some effects."""
    arm = Arm.load("thesis")
    for effect in effects:
        arm = arm.with_effect(effect)
    return Hypothesis(effects, SimpleNamespace(arm=arm), Score(error, error), Score(error, error))


def two_accepted() -> Search:
    search = Search(Arm.load("thesis"), None, 1, lambda done, text: None)
    search.accepted = ["cable_stiffness", "tach_filter"]
    search.equivalent = [["cable_stiffness", "base_tilt", "air_drag"], ["tach_filter"]]
    search.steps = {"cable_stiffness": Score(3.0, 3.0), "tach_filter": Score(1.2, 1.2)}
    search.ranking = {"cable_stiffness": (0.9, None), "constant_torque": (0.7, hypothesis("constant_torque").refit)}
    return search


def test_an_effect_in_anothers_place_keeps_the_error_after_it():
    search = two_accepted()
    taken = hypothesis("constant_torque", "tach_filter")
    alike = {"asymmetric_coulomb": hypothesis("asymmetric_coulomb", "tach_filter")}
    search._put(0, Place("constant_torque", taken, alike, frozenset(["cable_stiffness", "base_tilt", *alike, "constant_torque"])))
    assert search.accepted == ["constant_torque", "tach_filter"]
    assert search.steps == {"constant_torque": Score(3.0, 3.0), "tach_filter": Score(1.0, 1.0)}
    assert search.equivalent[0] == ["constant_torque", "asymmetric_coulomb", "air_drag"]  # air_drag was not tried again
    assert search.ranking["constant_torque"] == (0.9, taken.refit)
    assert search.found is taken.refit


def test_rivals_that_lost_are_equivalent_no_more():
    search = two_accepted()
    search.found = search.best = None
    now = hypothesis("cable_stiffness", "tach_filter")
    search._put(0, Place("cable_stiffness", now, {}, frozenset(["cable_stiffness", "base_tilt", "constant_torque"])))
    assert search.equivalent[0] == ["cable_stiffness", "air_drag"]
    assert search.steps["cable_stiffness"] == Score(3.0, 3.0)
    assert search.found is None


def test_open_hypotheses_have_everything_else_that_was_found():
    search = two_accepted()
    search.found = hypothesis(*search.accepted).refit
    search.equivalent[0] = ["cable_stiffness", "constant_torque", "asymmetric_coulomb"]
    assert list(search.open_hypotheses()) == [""]  # that with a constant torque lacks the tachometer's filter
    beside = hypothesis("constant_torque", "tach_filter").refit
    search.ranking["constant_torque"] = (0.7, beside)
    assert search.open_hypotheses() == {"cable_stiffness": search.found.arm, "constant_torque": beside.arm}


def test_what_another_effect_changes_has_no_rivals():
    arm = Arm.load("thesis")
    assert "dead_zone" in rivals_of("brush_drop", arm)
    assert "stiction" in arm.effects
    assert rivals_of("coulomb", arm.without_effect("coulomb")) == []


def fruitless(nominal: Arm, recordings: list[Recording]) -> Search:
    """A search that has found nothing."""
    arm, data = prepare(nominal, recordings)
    search = Search(arm, data, 1, lambda done, text: None)
    search.base = search.found = best_refit(arm, data)
    search.first = search.best = score(search.base.arm, data)
    search.rules = Acceptance(search.first, search.noisy)
    search.chain = [judged((), search.base, data)]
    return search


@pytest.mark.slow
def test_effects_that_explain_only_together_are_added_one_by_one():
    nominal = Arm.load("thesis")
    made = nominal.with_effect("cable_stiffness", stiffness=0.2, rest_angle=0.0).with_effect("tach_filter", time=0.02)
    search = fruitless(nominal, [simulate(made, experiment, seed=3, duration=6.0) for experiment in ("square", "sweep")])
    assert search._add_one_by_one(0.8, bent=True)
    assert sorted(search.accepted) == ["cable_stiffness", "tach_filter"]
    assert [names[0] for names in search.equivalent] == search.accepted == list(search.steps)
    assert search.best.windows < 1.05 < search.steps[search.accepted[0]].windows < search.first.windows
    assert all(0.0 < search.ranking[name][0] <= 1.0 for name in search.accepted)


@pytest.mark.slow
def test_what_no_catalogue_holds_is_not_explained_one_by_one():
    nominal = Arm.load("thesis")
    run = simulate(nominal, "square", seed=3, duration=6.0)
    buzz = run.signals["strain_base"] + 0.1 * np.sign(np.sin(2.0 * np.pi * 7.3 * run.time))
    search = fruitless(nominal, [replace(run, signals={**run.signals, "strain_base": buzz})])
    assert search.first.windows > 3.0
    assert not search._add_one_by_one(0.8, bent=True)
    assert search.accepted == []
    assert search.found is search.base
