"""Effects change places with what moves the arm alike, and what did not is no equivalent."""

from __future__ import annotations

import pytest
from searches import accept, far_off, model, scored

from flexarm_env.identify.progress import Progress
from flexarm_env.identify.replay.error_measure import Score
from flexarm_env.identify.select.model import Model
from flexarm_env.identify.select.search import Search
from flexarm_env.identify.select.swap import RivalComparison, exchange
from flexarm_env.identify.select.trace import Accepted, Trace, Tried

PAIR = ("tach_filter", "cable_stiffness")
OTHERS = ("time_offset", "base_tilt")
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
