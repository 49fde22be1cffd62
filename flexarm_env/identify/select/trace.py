"""The history of a search: its steps, from which accepted effects, ranking and errors are read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.calibration import Calibration
from flexarm_env.identify.deadline import Deadline
from flexarm_env.identify.replay.error_measure import Score
from flexarm_env.identify.select.criteria import Measure
from flexarm_env.identify.select.model import Model

#: Action of a calibration on all of the data.
SETTLE = "settle"


@dataclass(frozen=True)
class Tried:
    """One effect that was tried.

    Attributes:
        effect: its name.
        gain: share of the excess error that it removes, 0 to 1.
        calibration: with it; None where it was only screened.
    """

    effect: str
    gain: float
    calibration: Calibration | None = None


@dataclass(frozen=True)
class Accepted:
    """One accepted effect.

    Attributes:
        effect: its name.
        equivalent: all that the data cannot tell from it, itself first.
        score: errors after it was added.
        beside: the other effects of the model in which these equivalents were found.
        near: simpler ones that came near it when it was accepted.
    """

    effect: str
    equivalent: tuple[str, ...]
    score: Score
    beside: frozenset[str] = frozenset()
    near: tuple[str, ...] = ()


@dataclass(frozen=True)
class Step:
    """One step of a search.

    Attributes:
        action: "calibrate", "screen", "fit", "recalibrate", "accept", "combine", "forecast", "swap", "drop" or "settle".
        model: the best one after the step.
        accepted: effects after the step.
        tried: effects that the step compared.
    """

    action: str
    model: Model
    accepted: tuple[Accepted, ...] = ()
    tried: tuple[Tried, ...] = ()


@dataclass(frozen=True)
class Stop:
    """The stop of a search as its time was over.

    Attributes:
        after: time [s] at which it stopped.
        left_out: the first that was left out, as in "an effect was tried".
    """

    after: float
    left_out: str

    @property
    def note(self) -> str:
        """One line for a person."""
        return f"stopped after {self.after:.1f} s, before {self.left_out}"


@dataclass(frozen=True)
class Trace:
    """The history of a search.

    Attributes:
        steps: in their order; the first one calibrates the constants.
        chain: models of one more effect each, which stepwise addition goes on with.
        stop: of the search, as its time was over; None where nothing was left out.
    """

    steps: tuple[Step, ...]
    chain: tuple[Model, ...]
    stop: Stop | None = None

    @classmethod
    def begin(cls, base: Model) -> Trace:
        """Begin with the calibrated constants."""
        return cls((Step("calibrate", base),), (base,))

    def then(
        self, action: str, model: Model | None = None, accepted: Sequence[Accepted] | None = None, tried: Sequence[Tried] = ()
    ) -> Trace:
        """Append a step; model and accepted effects stay as they are where they are left out.

        The model is kept under the names of all accepted effects.
        """
        taken = self.accepted if accepted is None else tuple(accepted)
        found = replace(model or self.model, effects=tuple(a.effect for a in taken))
        return replace(self, steps=(*self.steps, Step(action, found, taken, tuple(tried))))

    def stopped_before(self, left_out: str, deadline: Deadline) -> Trace:
        """Record what is left out as the time is over; only the first counts."""
        return replace(self, stop=self.stop or Stop(deadline.elapsed, left_out))

    @property
    def notes(self) -> list[str]:
        """Lines for a person: what was left out for lack of time, and whether the last errors are of data that a fit saw."""
        settled = ["nothing was held out of the last fit and its error: the held-out part alone determines a value of the model"]
        return [*([self.stop.note] if self.stop else []), *(settled if self.steps[-1].action == SETTLE else [])]

    @property
    def model(self) -> Model:
        """The best model so far."""
        return self.steps[-1].model

    @property
    def accepted(self) -> tuple[Accepted, ...]:
        """The effects accepted so far."""
        return self.steps[-1].accepted

    @property
    def effects(self) -> list[str]:
        """Names of the accepted effects."""
        return [a.effect for a in self.accepted]

    @property
    def ranking(self) -> dict[str, Tried]:
        """Every effect that was tried, as it was tried last."""
        return {tried.effect: tried for step in self.steps for tried in step.tried}

    @property
    def open_hypotheses(self) -> dict[str, Arm]:
        """The arms between which the recordings do not decide, by effect; the best one alone, where they do."""
        ranking = self.ranking
        for accepted in self.accepted:
            beside = set(self.effects) - {accepted.effect}
            tried = {name: ranking[name].calibration for name in accepted.equivalent[1:] if name in ranking}
            fitted = {name: c.arm for name, c in tried.items() if c is not None and beside <= set(c.arm.effects)}
            if fitted:
                return {accepted.effect: self.model.arm, **fitted}
        return {"": self.model.arm}

    def as_json(self) -> list[dict[str, Any]]:
        """Convert to plain data: of each step its action, effects, errors before and after, and tried effects."""
        rows = []
        for before, step in zip((self.steps[0], *self.steps), self.steps, strict=False):
            rows.append(
                {
                    "action": step.action,
                    "effects": [a.effect for a in step.accepted],
                    "equivalent": [list(a.equivalent) for a in step.accepted],
                    "error": {"before": before.model.score.windows, "after": step.model.score.windows},
                    "free_run": {"before": before.model.score.free_run, "after": step.model.score.free_run},
                    "tried": [{"effect": t.effect, "gain": t.gain} for t in step.tried],
                }
            )
        return rows


def others_of(effects: Sequence[str], place: int) -> frozenset[str]:
    """Collect all effects but the one in a place."""
    return frozenset(effects) - {effects[place]}


def placed(accepted: Sequence[Accepted], place: int, entry: Accepted) -> list[Accepted]:
    """Put an entry in the place of an accepted effect."""
    return [*accepted[:place], entry, *accepted[place + 1 :]]


def with_last_score(accepted: Sequence[Accepted], model: Model) -> list[Accepted]:
    """Give the last accepted effect the score of a model with all of them."""
    return [*accepted[:-1], replace(accepted[-1], score=model.score)]


def gains(trace: Trace, models: Sequence[Model], measure: Measure) -> list[Tried]:
    """Compute the gains of models of one effect each, but for effects that are accepted already."""
    before = measure(trace.model.score)
    single = [m for m in models if len(m.effects) == 1 and m.effects[0] not in trace.effects]
    return [Tried(m.effects[0], share(1.0 - measure(m.score) / before), m.calibration) for m in single]


def beside(left_out: str, trace: Trace) -> str:
    """Add the accepted effects to what is left out."""
    return f"{left_out} beside {' and '.join(trace.effects)}" if trace.effects else left_out


def share(gain: float) -> float:
    """Limit a gain to a share, 0 to 1."""
    return float(np.clip(gain, 0.0, 1.0))
