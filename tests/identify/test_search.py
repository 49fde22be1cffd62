"""The search for missing effects: effects change places, and an effect that begins too large begins again."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from flexarm_env import Arm
from flexarm_env.experiments.simulate import simulate
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.progress import Progress
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.error_measure import Score, error_measure, score
from flexarm_env.identify.select import fits
from flexarm_env.identify.select.choose import simplest, with_forecasts
from flexarm_env.identify.select.criteria import ThresholdCriteria
from flexarm_env.identify.select.model import Model, judge
from flexarm_env.identify.select.screen import Trial
from flexarm_env.identify.select.search import Search
from flexarm_env.identify.select.starts import rivals_of
from flexarm_env.identify.select.swap import RivalComparison, exchange
from flexarm_env.identify.select.trace import Accepted, Trace, Tried
from flexarm_env.identify.settings import SETTINGS
from flexarm_env.identify.workers import Workers
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


def accept(trace: Trace, model: Model, *effects: str) -> Trace:
    return trace.then("accept", model, [Accepted(effect, (effect,), model.score) for effect in effects])


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


def model(*effects: str, error: float = 1.0) -> Model:
    """Of the thesis's arm with some effects."""
    arm = Arm.load("thesis")
    for effect in effects:
        arm = arm.with_effect(effect)
    return Model(effects, SimpleNamespace(arm=arm), Score(error, error), Score(error, error))


EQUIVALENT = (("cable_stiffness", "base_tilt", "air_drag"), ("tach_filter",))
SCORES = (Score(3.0, 3.0), Score(1.2, 1.2))


def two_accepted(equivalent: tuple[tuple[str, ...], ...] = EQUIVALENT, **tried: Model) -> Trace:
    accepted = [Accepted(names[0], names, error) for names, error in zip(equivalent, SCORES, strict=True)]
    ranked = [Tried("cable_stiffness", 0.9), Tried("constant_torque", 0.7, model("constant_torque").calibration)]
    ranked += [Tried(effect, 0.7, found.calibration) for effect, found in tried.items()]
    now = model("cable_stiffness", "tach_filter", error=1.2)
    return Trace.begin(model()).then("accept", now, accepted, ranked)


def test_an_effect_in_anothers_place_keeps_the_error_after_it():
    taken = model("constant_torque", "tach_filter")
    alike = {"asymmetric_coulomb": model("asymmetric_coulomb", "tach_filter")}
    tried = frozenset(["cable_stiffness", "base_tilt", *alike, "constant_torque"])
    trace = exchange(two_accepted(), 0, RivalComparison("constant_torque", taken, alike, tried))
    first, second = trace.accepted
    assert (first.effect, first.score) == ("constant_torque", Score(3.0, 3.0))
    assert (second.effect, second.score) == ("tach_filter", Score(1.0, 1.0))
    assert first.equivalent == ("constant_torque", "asymmetric_coulomb", "air_drag")  # air_drag was not tried again
    assert trace.ranking["constant_torque"] == Tried("constant_torque", 0.9, taken.calibration)
    assert trace.model.calibration is taken.calibration


def test_rivals_that_lost_are_equivalent_no_more():
    before = two_accepted()
    tried = frozenset(["cable_stiffness", "base_tilt", "constant_torque"])
    trace = exchange(before, 0, RivalComparison("cable_stiffness", before.model, {}, tried))
    left = Accepted("cable_stiffness", ("cable_stiffness", "air_drag"), Score(3.0, 3.0), frozenset(["tach_filter"]))
    assert trace.accepted[0] == left
    assert trace.model == before.model


def test_open_hypotheses_have_everything_else_that_was_accepted():
    equivalent = (("cable_stiffness", "constant_torque", "asymmetric_coulomb"), ("tach_filter",))
    # the arm with a constant torque lacks the tachometer's filter
    assert list(two_accepted(equivalent).open_hypotheses) == [""]
    beside = model("constant_torque", "tach_filter")
    trace = two_accepted(equivalent, constant_torque=beside)
    assert trace.open_hypotheses == {"cable_stiffness": trace.model.arm, "constant_torque": beside.arm}


def test_the_trace_as_plain_data_tells_each_step_from_the_one_before():
    first, second = two_accepted().as_json()
    assert first["error"] == {"before": 1.0, "after": 1.0}
    assert second["action"] == "accept"
    assert second["effects"] == ["cable_stiffness", "tach_filter"]
    assert second["error"] == {"before": 1.0, "after": 1.2}
    assert second["tried"][0] == {"effect": "cable_stiffness", "gain": 0.9}


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


def far_off() -> Search:
    """A search for what an arm lacks that is far off, with no recordings behind it."""
    workers = SimpleNamespace(deadline=SimpleNamespace(is_over=False), map_in_time=lambda tasks: [], map=Workers(1).map)
    calibrator = SimpleNamespace(settings=SETTINGS, workers=workers, dataset=SimpleNamespace(signals=()))
    return Search(calibrator, ThresholdCriteria(Score(28.0, 480.0), Score(26.0, 480.0), True, SETTINGS))


def scored(score: Score, *effects: str) -> Model:
    return replace(model(*effects), score=score)


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


def test_when_one_effect_has_given_way_the_others_are_compared_anew(monkeypatch):
    def compare(self: Search, trace: Trace, place: int, progress: Progress, left_out: frozenset[str]) -> Trace:
        compared.append(trace.effects[place])
        names = [PAIR[0], "base_tilt"] if place == 1 else trace.effects
        return accept(trace, scored(Score(1.5, 1.5)), *names)

    compared: list[str] = []
    monkeypatch.setattr(Search, "_compare", compare)
    trace = accept(Trace.begin(model()), scored(Score(2.0, 2.0)), *PAIR)
    assert far_off().swap(trace, Progress()).effects == [PAIR[0], "base_tilt"]
    assert compared == [*PAIR, PAIR[0]]


def test_effects_that_give_way_to_each_other_are_compared_until_one_pair_comes_again(monkeypatch):
    turns = dict(zip((*PAIR, *OTHERS), (*OTHERS, *PAIR), strict=True))

    def compare(self: Search, trace: Trace, place: int, progress: Progress, left_out: frozenset[str]) -> Trace:
        names = [turns[n] if at == place else n for at, n in enumerate(trace.effects)]
        return accept(trace, scored(Score(2.0, 2.0)), *names)

    monkeypatch.setattr(Search, "_compare", compare)
    found = far_off().swap(accept(Trace.begin(model()), scored(Score(2.0, 2.0)), *PAIR), Progress())
    assert found.effects == list(PAIR)


def test_an_effect_that_gave_way_is_compared_with_what_took_its_place(monkeypatch):
    """It was not calibrated beside the others as its rivals were."""

    def compare(calibrator, criteria, accepted: Accepted, now: Model, progress: Progress, compared: frozenset[str]):
        left_out.append(compared)
        tried = frozenset([accepted.effect, "base_tilt", "air_drag"])
        return RivalComparison("base_tilt", model("base_tilt", PAIR[0]), {}, tried)

    left_out: list[frozenset[str]] = []
    monkeypatch.setattr("flexarm_env.identify.select.search.compare_rivals", compare)
    trace = accept(Trace.begin(model()), scored(Score(1.0, 1.0), *PAIR), *PAIR)
    assert far_off()._compare(trace, 1, Progress()).effects == [PAIR[0], "base_tilt"]
    assert left_out == [frozenset(), frozenset(["base_tilt", "air_drag"])]


@pytest.mark.parametrize(("beside", "compared"), [("coulomb", "base_tilt"), ("tach_filter", "constant_torque")])
def test_equivalents_that_were_found_beside_another_effect_are_compared_anew_at_the_noise(monkeypatch, beside, compared):
    """Where they were found beside the same one, only what is simpler and was not tried is left to be compared."""

    def compare(self: Search, trace: Trace, place: int, progress: Progress, left_out: frozenset[str]) -> Trace:
        seen.append(trace.effects[place])
        rivals.extend({"base_tilt", "constant_torque"} - left_out)
        return trace

    seen: list[str] = []
    rivals: list[str] = []
    monkeypatch.setattr(Search, "_compare", compare)
    error = Score(1.0, 1.0)
    equivalent = Accepted("cable_stiffness", ("cable_stiffness", "base_tilt"), error, frozenset([beside]))
    accepted = [equivalent, Accepted("tach_filter", ("tach_filter",), error)]
    trace = Trace.begin(model()).then("accept", scored(error, "cable_stiffness", "tach_filter"), accepted)
    far_off().swap(trace, Progress())
    assert seen == ["cable_stiffness"]
    assert compared in rivals
    assert (len(rivals) == 1) == (beside == "tach_filter")


def test_what_was_tried_is_not_compared_again_at_the_noise(monkeypatch):
    monkeypatch.setattr(Search, "_compare", lambda *given: pytest.fail("compared"))
    error = Score(1.0, 1.0)
    accepted = [Accepted("cable_stiffness", ("cable_stiffness",), error)]
    found = scored(error, "cable_stiffness")
    trace = Trace.begin(model()).then("fit", tried=[Tried("constant_torque", 0.1, found.calibration)])
    assert far_off().swap(trace.then("accept", found, accepted), Progress()).effects == ["cable_stiffness"]


@pytest.mark.parametrize(("left", "compares"), [(Score(8.9, 19.0), True), (Score(20.0, 200.0), False), (Score(2.9, 300.0), True)])
def test_rivals_are_compared_far_off_only_where_most_is_explained(left, compares):
    assert far_off().criteria.can_compare_rivals(scored(left)) == compares


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


def simplest_far_off(models, before):
    search = far_off()
    measure = search.criteria.measure([m.score for m in models])
    return simplest(search.calibrator, search.criteria, models, scored(before), measure)


def test_an_effect_that_windows_ask_for_is_chosen_though_whole_runs_end_elsewhere():
    """A delay, beside a stop that is missing as well: where a run ends is up to the stop."""
    models = [scored(Score(15.5, 125.9), "input_delay", "constant_torque"), scored(Score(7.0, 139.7), "input_delay")]
    for one, cost in zip(models, (20_000.0, 9_000.0), strict=True):
        vars(one)["forecast_cost"] = cost
    assert simplest_far_off(models, Score(36.2, 147.5)).effects == ("input_delay",)


@pytest.mark.parametrize(("whole_run", "verdict"), [(60.0, "effects"), (258.0, "effects"), (470.0, "unknown")])
def test_where_torque_noise_is_stated_effects_that_worsen_whole_runs_are_not_named(whole_run, verdict):
    """Hidden effects that were found on a pendulum under such noise left less than a tenth of the error of whole runs."""
    found = scored(Score(1.04, whole_run), *PAIR)
    criteria = ThresholdCriteria(Score(3.3, 250.0), Score(1.52, 250.0), False, SETTINGS)
    assert criteria.verdict(PAIR, scored(Score(1.52, 250.0)), found) == verdict


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
