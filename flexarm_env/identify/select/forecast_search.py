"""Search by the density of forecasts: promising effects are calibrated, and the best models extended, side by side.

Two effects may be missing of which neither stands out alone, or one may pass for both. So several models are kept at each number
of effects (beam search), from the constants as calibrated and as given. The smallest that explains the recordings is chosen.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.calibrate.forecast_fit import fit_briefly, fit_forecasts
from flexarm_env.identify.calibrate.parameters import FitParameters, free_parameters
from flexarm_env.identify.progress import Progress
from flexarm_env.identify.replay.density import Prediction, first_disturbances, likeliest
from flexarm_env.identify.replay.forecast import Disturbances
from flexarm_env.identify.select.model import Model, judge, sizes_at_bound
from flexarm_env.identify.select.promise import Promise, promises
from flexarm_env.identify.select.starts import candidates, rivals_of
from flexarm_env.identify.select.trace import Accepted, Tried
from flexarm_env.identify.settings import ForecastSearching
from flexarm_env.identify.threads import in_threads

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Hypothesis:
    """Effects that an arm was given, and its forecasts.

    Attributes:
        effects: in the order in which they were added.
        parameters: of the values that were calibrated.
        prediction: forecasts of the calibrated arm.
    """

    effects: tuple[str, ...]
    parameters: FitParameters
    prediction: Prediction

    @property
    def arm(self) -> Arm:
        """The calibrated arm."""
        return self.prediction.arm

    @functools.cached_property
    def cost(self) -> float:
        """Negative log density of whole recordings, under the disturbances that make those likeliest."""
        now = self.prediction
        return likeliest(now.arm, now.dataset.nothing_held_out(), now.disturbances).cost

    @property
    def at_bound(self) -> bool:
        """Whether the size of one of its effects ran to the end of its range: none explains the data."""
        return sizes_at_bound(self.arm, self.parameters, self.effects)


#: Hypotheses by their effects, whose order does not count.
Hypotheses = dict[frozenset[str], Hypothesis]


@dataclass(frozen=True)
class Proposal:
    """The model that forecasts ask for, calibrated as any other.

    Attributes:
        model: with all its effects.
        accepted: its effects.
        tried: the same, with what each gains.
    """

    model: Model
    accepted: Sequence[Accepted]
    tried: Sequence[Tried]


@dataclass(frozen=True)
class ForecastSearch:
    """A search over effects by the density of forecasts.

    Attributes:
        calibrator: of the recordings.
    """

    calibrator: Calibrator

    @property
    def numbers(self) -> ForecastSearching:
        """Numbers of the search."""
        return self.calibrator.settings.forecast_searching

    @property
    def _is_late(self) -> bool:
        return self.calibrator.workers.deadline.is_over

    def propose(
        self, base: Model, calibrated: frozenset[str], explains: Callable[[Model], bool], progress: Progress
    ) -> Proposal | None:
        """Search from the calibrated constants and from the nominal ones: the smallest model that explains the recordings.

        Args:
            base: the model without effects, its constants calibrated.
            calibrated: effects of a model that is calibrated already, and not again; none where there is none.
            explains: whether a model does so.
            progress: of this search.

        Returns:
            What is proposed; None where no model explains them, or none that was found in time.
        """
        with self.calibrator.workers.threads():
            level = self._without_effects(base)
            known: Hypotheses = {frozenset(): min(level, key=lambda one: one.cost)}
            for stage in progress.split(*[1] * self.calibrator.settings.selecting.most_effects):
                if self._is_late:
                    break
                best = min(one.cost for one in known.values())
                searching, calibrating = stage.split(4, 1)
                fresh = self._extend(level, searching)
                level = self._finish(fresh, min(_fitted_cost(one) for one in level))
                known |= fresh | {frozenset(one.effects): one for one in level}
                chosen = min(level, key=lambda one: one.cost, default=None)
                if chosen is None or chosen.cost > best - self.numbers.least_log_gain:
                    break
                if calibrated == frozenset(chosen.effects):
                    continue
                calibrating.at(0.0, f"calibrating {' and '.join(chosen.effects)}")
                model = self._model(chosen)
                if explains(model):
                    return self._proposal(base, model, known)
        return None

    def _without_effects(self, base: Model) -> list[Hypothesis]:
        """Forecast with the constants as calibrated, and with the nominal ones."""
        nominal, dataset = self.calibrator.nominal, self.calibrator.dataset
        calibrated = self._calibrate((), base.arm, first_disturbances(base.arm, dataset))
        given = likeliest(nominal, dataset, first_disturbances(nominal, dataset))
        return [calibrated, Hypothesis((), free_parameters(nominal, nominal, dataset), given)]

    def _calibrate(self, effects: tuple[str, ...], arm: Arm, start: Disturbances) -> Hypothesis:
        parameters = free_parameters(arm, self.calibrator.nominal, self.calibrator.dataset)
        return Hypothesis(effects, parameters, fit_forecasts(arm, parameters, self.calibrator.dataset, start))

    def _extend(self, level: Sequence[Hypothesis], progress: Progress) -> Hypotheses:
        """Calibrate the most promising effects beside each hypothesis of a level."""
        fresh: Hypotheses = {}
        for one, stage in zip(level, progress.split(*[1] * len(level)), strict=True):
            if self._is_late:
                break
            names = candidates(one.arm, self.calibrator.dataset)
            stage.at(0.0, f"weighing {len(names)} effects{_beside(one)}")
            found = promises(one.prediction, one.parameters, names)
            wanted = self._finalists(one, found)
            stage.at(0.5, f"fitting {', '.join(p.effect for p in wanted)}{_beside(one)}")
            for new in in_threads(self._with, [(one, promise) for promise in wanted]):
                key = frozenset(new.effects)
                if not new.at_bound and (key not in fresh or _fitted_cost(new) < _fitted_cost(fresh[key])):
                    fresh[key] = new
        return fresh

    def _finalists(self, one: Hypothesis, found: Sequence[Promise]) -> list[Promise]:
        """Choose the effects to calibrate: those that promise most, others that promise nearly as much, and the companion.

        The catalogue's companion, a constant torque, hides the share of another effect, which does not promise it then.
        """
        numbers = self.numbers
        near = [p for p in found[numbers.finalists :] if p.gain >= numbers.near_promise * found[0].gain]
        rivals = set(rivals_of(found[0].effect, one.arm, self.calibrator.dataset)) if found else set()
        near = sorted(near, key=lambda p: p.effect not in rivals)
        chosen = [*found[: numbers.finalists], *near][: numbers.most_finalists]
        return chosen + [p for p in found if one.effects and p.effect == one.arm.known.pairing and p not in chosen]

    def _with(self, one: Hypothesis, promise: Promise) -> Hypothesis:
        dataset, start = self.calibrator.dataset, replace(one.prediction.disturbances, torque=promise.torque)
        arm = one.arm.with_effect(promise.effect, **promise.values)
        parameters = free_parameters(arm, self.calibrator.nominal, dataset)
        found = fit_briefly(arm, parameters, dataset, start, promise.slopes)
        return Hypothesis((*one.effects, promise.effect), parameters, found)

    def _finish(self, fresh: Hypotheses, before: float) -> list[Hypothesis]:
        """Calibrate to the end, and keep, the best and others that gain nearly as much on a cost; best first."""
        done: list[Hypothesis] = []
        for one in sorted(fresh.values(), key=_fitted_cost)[: self.numbers.width]:
            least = self.numbers.near_gain * (before - _fitted_cost(done[0])) if done else -np.inf
            if before - _fitted_cost(one) >= least:
                finished = self._calibrate(one.effects, one.arm, one.prediction.disturbances)
                done = sorted([*done, finished], key=_fitted_cost)
        return done

    def _model(self, one: Hypothesis) -> Model:
        """Calibrate a hypothesis as any search does."""
        calibrator = self.calibrator
        return judge(one.effects, calibrator.polish(calibrator.calibrate(one.arm)), calibrator.dataset)

    def _proposal(self, base: Model, model: Model, known: Hypotheses) -> Proposal:
        """Share what a model gains among its effects, in the order in which they were added."""
        accepted, tried = [], []
        for place, name in enumerate(model.effects):
            before = known.get(frozenset(model.effects[: place + 1])) if place + 1 < len(model.effects) else None
            score = self.calibrator.score(before.arm) if before else model.score
            gain = min(max(1.0 - score.excess / base.score.excess, 0.0), 1.0)
            accepted.append(Accepted(name, (name,), score))
            tried.append(Tried(name, gain, model.calibration))
        return Proposal(model, accepted, tried)


def _fitted_cost(one: Hypothesis) -> float:
    """Look up the cost of the fitted part, by which a level is chosen: a model that lacks an effect may fail later."""
    return one.prediction.cost


def _beside(one: Hypothesis) -> str:
    return f" beside {' and '.join(one.effects)}" if one.effects else ""
