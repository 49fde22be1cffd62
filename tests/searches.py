"""Machines for the tests of the search, their recordings as a model takes them up, and models of stated errors."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

from flexarm_env import Arm, Recording, simulate
from flexarm_env.identify.replay.dataset import Dataset, prepare
from flexarm_env.identify.replay.error_measure import Score
from flexarm_env.identify.select.criteria import ThresholdCriteria
from flexarm_env.identify.select.model import Model
from flexarm_env.identify.select.search import Search
from flexarm_env.identify.select.trace import Accepted, Trace
from flexarm_env.identify.settings import SETTINGS
from flexarm_env.identify.workers import Workers


def recorded(machine: Arm) -> list[Recording]:
    return [simulate(machine, kind, duration=4.0, rate=200.0, seed=3) for kind in ("square", "pulse")]


def seen_by(machine: Arm, model: Arm) -> tuple[Arm, Dataset]:
    return prepare(model, recorded(machine))


def limited(arm: Arm, share: float, size: float) -> tuple[Arm, Arm]:
    """A machine whose command is limited to a share of the largest one, and the model without the limit.

    Its amplifier is commanded in units that are `size` times smaller than the arm's.
    """
    drive = arm.constants["drive"]
    values = {"drive.torque_constant": drive["torque_constant"] / size, "drive.limit": drive["limit"] * size}
    model = arm.with_values(values)
    largest = max(float(abs(run.command).max()) for run in recorded(model))
    return model.with_effect("saturation", limit=share * largest), model


def model(*effects: str, error: float = 1.0) -> Model:
    """Of the thesis's arm with some effects."""
    arm = Arm.load("thesis")
    for effect in effects:
        arm = arm.with_effect(effect)
    return Model(effects, SimpleNamespace(arm=arm), Score(error, error), Score(error, error))


def scored(score: Score, *effects: str) -> Model:
    return replace(model(*effects), score=score)


def accept(trace: Trace, model: Model, *effects: str) -> Trace:
    return trace.then("accept", model, [Accepted(effect, (effect,), model.score) for effect in effects])


def far_off() -> Search:
    """A search for what an arm lacks that is far off, with no recordings behind it."""
    workers = SimpleNamespace(deadline=SimpleNamespace(is_over=False), map_in_time=lambda tasks: [], map=Workers(1).map)
    calibrator = SimpleNamespace(settings=SETTINGS, workers=workers, dataset=SimpleNamespace(signals=()))
    return Search(calibrator, ThresholdCriteria(Score(28.0, 480.0), Score(26.0, 480.0), True, SETTINGS))
