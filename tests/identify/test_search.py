"""The search for missing effects, one by one and together; an effect that begins too large begins again."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from searches import accept, far_off, model, scored

from flexarm_env import Arm
from flexarm_env.experiments.simulate import simulate
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.progress import Progress
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.error_measure import Score, error_measure, score
from flexarm_env.identify.select import fits
from flexarm_env.identify.select.criteria import ThresholdCriteria
from flexarm_env.identify.select.model import judge
from flexarm_env.identify.select.screen import Trial
from flexarm_env.identify.select.search import Search
from flexarm_env.identify.select.starts import rivals_of
from flexarm_env.identify.select.trace import Trace
from flexarm_env.recordings.recording import Recording

TRUE = {
    "asymmetric_coulomb": {"torque": 0.05},
    "constant_torque": {"torque": 0.05},
}


def begun(nominal: Arm, recordings: list[Recording]) -> tuple[Search, Trace]:
    """A search that has calibrated the constants."""
    calibrator = Calibrator(*prepare(nominal, recordings))
    base = judge((), calibrator.calibrate_constants(), calibrator.dataset)
    before = calibrator.score(calibrator.nominal)
    judges_free_run = error_measure(calibrator.nominal).judges_free_run
    criteria = ThresholdCriteria(before, base.score, judges_free_run, calibrator.settings)
    return Search(calibrator, criteria), Trace.begin(base)


@pytest.mark.parametrize("taken", sorted(TRUE))
@pytest.mark.parametrize("hidden", sorted(TRUE))
def test_an_accepted_effect_gives_way_to_one_that_fits_better(hidden, taken):
    nominal = Arm.load("thesis")
    made = nominal.with_effect(hidden, **TRUE[hidden])
    search, trace = begun(nominal, [simulate(made, kind, seed=3, duration=8.0) for kind in ("square", "sweep")])
    found = search.calibrator.calibrate(search.calibrator.nominal.with_effect(taken, torque=0.04))
    trace = search.swap(accept(trace, judge((taken,), found, search.calibrator.dataset), taken), Progress())
    (accepted,) = trace.accepted
    assert accepted.effect == accepted.equivalent[0] == hidden
    assert trace.model.score.windows < 1.05


def test_an_effect_that_began_too_large_begins_again(monkeypatch):
    nominal = Arm.load("thesis-fem")
    made = nominal.with_effect("backlash", gap=0.0007).with_values({"hub.inertia": 1.2 * nominal.value("hub.inertia")})
    arm, data = prepare(nominal, [simulate(made, "pulse", seed=1, duration=5.0)])
    monkeypatch.setattr(fits, "candidates", lambda arm, dataset: ["backlash", "current_lag"])
    calibrator = Calibrator(arm, data)
    base = calibrator.calibrate_constants()
    found = fits.fit_with_all_constants(calibrator, base, [Trial("", base.arm, 0.0, 0.0)], [], Progress())
    assert found[0].effects == ("backlash",)
    assert found[0].arm.effects["backlash"]["gap"] == pytest.approx(0.0007, rel=0.1)
    assert found[0].score.windows < 0.5 * score(base.arm, data).windows


def test_an_effect_that_another_one_modifies_has_no_rivals():
    nominal = Arm.load("thesis")
    arm, dataset = prepare(nominal, [simulate(nominal, "square", duration=2.0)])
    assert "dead_zone" in rivals_of("brush_drop", arm, dataset)
    assert "stiction" in arm.effects
    assert rivals_of("coulomb", arm.without_effect("coulomb"), dataset) == []


@pytest.mark.slow
def test_effects_that_explain_only_together_are_added_one_by_one():
    nominal = Arm.load("thesis")
    made = nominal.with_effect("cable_stiffness", stiffness=0.2, rest_angle=0.0).with_effect("tach_filter", time=0.02)
    search, trace = begun(nominal, [simulate(made, experiment, seed=3, duration=6.0) for experiment in ("square", "sweep")])
    found = search.combine(trace, Progress())
    assert [a.equivalent for a in found.accepted] == [(effect,) for effect in found.effects]
    assert found.model.score.windows < 1.05 < found.accepted[0].score.windows < trace.model.score.windows
    assert all(0.0 < found.ranking[name].gain <= 1.0 for name in found.effects)
    # Stops that meet where the cable rests move the arm as it does, and give way to it, since it is simpler.
    assert sorted(search.swap(found, Progress(), untried=True).effects) == ["cable_stiffness", "tach_filter"]


@pytest.mark.slow
def test_what_no_catalogue_holds_is_not_explained_one_by_one():
    nominal = Arm.load("thesis")
    run = simulate(nominal, "square", seed=3, duration=6.0)
    buzz = run.signals["strain_base"] + 0.1 * np.sign(np.sin(2.0 * np.pi * 7.3 * run.time))
    search, trace = begun(nominal, [replace(run, signals={**run.signals, "strain_base": buzz})])
    assert trace.model.score.windows > 3.0
    found = search.combine(trace, Progress())
    assert found.effects == []
    assert found.model == trace.model


PAIR = ("tach_filter", "cable_stiffness")
OTHERS = ("time_offset", "base_tilt")


@pytest.mark.parametrize(("windows", "kept"), [(28.0, PAIR), (5.4, PAIR[1:])])
def test_an_effect_is_useless_only_where_windows_do_not_need_it_either(monkeypatch, windows, kept):
    """Where a model is far off, its free run is chaotic and may end nearer without an effect that it has."""
    without = {"tach_filter": scored(Score(windows, 82.0), PAIR[1])}
    monkeypatch.setattr(Search, "_without", lambda self, found, effect: without.get(effect))
    trace = accept(Trace.begin(model()), scored(Score(5.4, 205.0), *PAIR), *PAIR)
    assert tuple(far_off().drop_useless(trace).effects) == kept


@pytest.mark.parametrize(("left", "found"), [(5.4, PAIR), (1.0, PAIR[:1])])
def test_an_effect_is_added_beside_what_forecasts_ask_for_unless_that_explains_all(monkeypatch, left, found):
    def add(self: Search, trace: Trace, progress: Progress) -> Trace:
        return accept(trace, scored(Score(1.0, 1.0), *PAIR), *PAIR) if trace.effects == [PAIR[0]] else trace

    asked = scored(Score(left, left), PAIR[0])
    monkeypatch.setattr(Search, "add", add)
    monkeypatch.setattr(Search, "swap", lambda self, trace, progress, untried=False: trace)
    monkeypatch.setattr(Search, "drop_useless", lambda self, trace: trace)
    monkeypatch.setattr(Search, "ask_forecasts", lambda self, trace, progress: accept(trace, asked, PAIR[0]))
    assert tuple(far_off().run(scored(Score(26.0, 480.0)), Progress()).effects) == found


@pytest.mark.parametrize("left", [1.0, 5.0])
def test_an_effect_beside_which_much_is_left_is_accepted_with_one_that_explains_the_rest(monkeypatch, left):
    """A stop beside a delay: windows hardly need it until the springs of the friction are there as well."""
    stop, both = scored(Score(5.5, 20.0), "end_stop"), ["input_delay", "end_stop"]
    vars(stop)["forecast_cost"] = 0.0
    whole = scored(Score(left, left), *both, "presliding")
    chains = []

    def extend(calibrator, criteria, chain, progress):
        chains.append([list(m.effects) for m in chain])
        return (*chain, whole)

    monkeypatch.setattr("flexarm_env.identify.select.search.extend_chain", extend)
    trace = accept(Trace.begin(scored(Score(36.0, 147.0))), scored(Score(7.0, 139.7), "input_delay"), "input_delay")
    found = far_off()._accept(trace, [stop], Progress())
    assert chains == [[[], ["input_delay"], both]]
    assert found.effects == ([*both, "presliding"] if left == 1.0 else ["input_delay"])
