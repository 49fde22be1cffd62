"""Search by the density of forecasts: promising effects are calibrated, and the best models extended, side by side.

Two effects may be missing of which neither stands out alone, or one may pass for both. So several models are kept at each number
of effects (beam search), from the constants as calibrated and as given, and the smallest that no larger one betters by more than
chance is chosen in the end.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from joblib import Parallel, delayed
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.calibrate.forecast_fit import fit_forecasts
from flexarm_env.identify.calibrate.parameters import FitParameters, free_parameters
from flexarm_env.identify.progress import Progress
from flexarm_env.identify.replay.density import Prediction, first_disturbances, likeliest
from flexarm_env.identify.replay.forecast import Disturbances
from flexarm_env.identify.select.criteria import Criteria
from flexarm_env.identify.select.model import Model, judge
from flexarm_env.identify.select.promise import Promise, promises
from flexarm_env.identify.select.starts import candidates, rivals_of
from flexarm_env.identify.select.trace import Accepted, Trace, Tried
from flexarm_env.identify.settings import ForecastSearching

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
    def costs(self) -> Floats:
        """Negative log density (blocks,) of whole recordings, under the disturbances that make those likeliest."""
        now = self.prediction
        return likeliest(now.arm, now.dataset.nothing_held_out(), now.disturbances).block_costs()

    @property
    def cost(self) -> float:
        """Negative log density of whole recordings."""
        return float(self.costs.sum())

    @property
    def at_bound(self) -> bool:
        """Whether a parameter of its effects ran to the end of its range: no size of the effect explains the data."""
        paths = [p for p in self.parameters if p.path.split(".")[0] == "effects" and p.path.split(".")[1] in self.effects]
        return any(self.arm.value(p.path) in (p.low, p.high) for p in paths)

    def betters(self, other: Hypothesis, numbers: ForecastSearching) -> bool:
        """Whether its density is higher than another's by some standard errors over blocks, of which none counts for many."""
        gains = other.costs - self.costs
        most = numbers.largest_block * float(np.median(np.abs(gains)))
        gains = np.clip(gains, -most, most)
        return float(gains.sum()) > max(numbers.standard_errors * _error(gains), numbers.same_density)

    def equals(self, other: Hypothesis, base: Hypothesis, numbers: ForecastSearching) -> bool:
        """Whether its density differs from another's by no more than chance, and by little of what both gain over a base."""
        gains = self.costs - other.costs
        most = min(numbers.rival_errors * _error(gains), numbers.same_share * (base.cost - other.cost))
        return float(gains.sum()) < max(most, numbers.same_density)


def _error(gains: Floats) -> float:
    """Estimate the standard error of the sum of gains (blocks,)."""
    return float(np.std(gains)) * float(np.sqrt(len(gains)))


#: Hypotheses by their effects, whose order does not count.
Hypotheses = dict[frozenset[str], Hypothesis]


@dataclass(frozen=True)
class ForecastSearch:
    """A search over effects by the density of forecasts. The effects that it finds are calibrated as those of any search.

    Attributes:
        calibrator: of the recordings.
        criteria: by which the result is judged.
    """

    calibrator: Calibrator
    criteria: Criteria

    @property
    def numbers(self) -> ForecastSearching:
        """Numbers of the search."""
        return self.calibrator.settings.forecast_searching

    def run(self, base: Model, progress: Progress) -> Trace:
        """Search from the calibrated constants and from the nominal ones."""
        trace = Trace.begin(base)
        if self.criteria.is_sufficient(base):
            return trace
        *stages, last = progress.split(*[2] * self.calibrator.settings.selecting.most_effects, 1)
        with self.calibrator.workers.threads():
            level = self._without_effects(base)
            known: Hypotheses = {frozenset(): min(level, key=lambda one: one.cost)}
            for stage in stages:
                best = min(known.values(), key=lambda one: one.cost)
                fresh, tried = self._extend(level, stage)
                trace = trace.then("screen", tried=tried) if not trace.ranking else trace
                if not fresh:
                    break
                level = self._finish(sorted(fresh.values(), key=_fitted_cost)[: self.numbers.width])
                known |= fresh | {frozenset(one.effects): one for one in level}
                if not any(one.betters(best, self.numbers) for one in level) or self._explains(level[0]):
                    break
            last.at(0.0, "calibrating the model that is chosen")
            return self._accept(trace, self._chosen(known), known)

    def _without_effects(self, base: Model) -> list[Hypothesis]:
        """Forecast with the constants as calibrated, and with the nominal ones."""
        nominal, dataset = self.calibrator.nominal, self.calibrator.dataset
        calibrated = self._calibrate((), base.arm, first_disturbances(base.arm, dataset))
        given = likeliest(nominal, dataset, first_disturbances(nominal, dataset))
        return [calibrated, Hypothesis((), free_parameters(nominal, nominal, dataset), given)]

    def _calibrate(self, effects: tuple[str, ...], arm: Arm, start: Disturbances, steps: int | None = None) -> Hypothesis:
        parameters = free_parameters(arm, self.calibrator.nominal, self.calibrator.dataset)
        return Hypothesis(effects, parameters, fit_forecasts(arm, parameters, self.calibrator.dataset, start, steps))

    def _extend(self, level: Sequence[Hypothesis], progress: Progress) -> tuple[Hypotheses, list[Tried]]:
        """Calibrate the most promising effects beside each hypothesis of a level; also give the promises beside the first."""
        fresh: Hypotheses = {}
        first: list[Tried] = []
        for number, (one, stage) in enumerate(zip(level, progress.split(*[1] * len(level)), strict=True)):
            names = candidates(one.arm)
            stage.at(0.0, f"weighing {len(names)} effects{_beside(one)}")
            found = promises(one.prediction, one.parameters, names)
            if number == 0:
                first = [Tried(p.effect, min(max(p.gain / max(one.prediction.cost, 1.0), 0.0), 1.0)) for p in found]
            wanted = self._finalists(one, found)
            stage.at(0.5, f"fitting {', '.join(p.effect for p in wanted)}{_beside(one)}")
            for new in Parallel(prefer="threads")(delayed(self._with)(one, promise) for promise in wanted):
                key = frozenset(new.effects)
                if not new.at_bound and (key not in fresh or new.cost < fresh[key].cost):
                    fresh[key] = new
        return fresh, first

    def _finalists(self, one: Hypothesis, found: Sequence[Promise]) -> list[Promise]:
        """Choose the effects to calibrate: those that promise most, others that promise nearly as much, and the companion.

        The catalogue's companion, a constant torque, hides the share of another effect, which does not promise it then.
        """
        numbers = self.numbers
        near = [p for p in found[numbers.finalists :] if p.gain >= numbers.near_promise * found[0].gain]
        rivals = set(rivals_of(found[0].effect, one.arm)) if found else set()
        near = sorted(near, key=lambda p: p.effect not in rivals)
        chosen = [*found[: numbers.finalists], *near][: numbers.most_finalists]
        return chosen + [p for p in found if one.effects and p.effect == one.arm.known.pairing and p not in chosen]

    def _with(self, one: Hypothesis, promise: Promise) -> Hypothesis:
        start = replace(one.prediction.disturbances, torque=promise.torque)
        arm = one.arm.with_effect(promise.effect, **promise.values)
        steps = self.calibrator.settings.forecast_fit.brief_iterations
        return self._calibrate((*one.effects, promise.effect), arm, start, steps)

    def _finish(self, level: Sequence[Hypothesis]) -> list[Hypothesis]:
        """Calibrate the best to the end, and others that are near it; best first."""
        done: list[Hypothesis] = []
        for one in level:
            if not done or _fitted_cost(one) < self.numbers.near_cost * _fitted_cost(done[0]):
                one = self._calibrate(one.effects, one.arm, one.prediction.disturbances)
            done = sorted([*done, one], key=_fitted_cost)
        return done

    def _explains(self, one: Hypothesis) -> bool:
        """Whether a hypothesis leaves only noise."""
        return self.calibrator.score(one.arm).windows < self.calibrator.settings.errors.explained

    def _chosen(self, known: Hypotheses) -> Hypothesis:
        """Choose the smallest hypothesis that no larger one betters; then leave out effects that it does not need."""
        chosen = known[frozenset()]
        for count in range(1, self.calibrator.settings.selecting.most_effects + 1):
            best = min((one for one in known.values() if len(one.effects) == count), key=lambda one: one.cost, default=chosen)
            if len(best.effects) > len(chosen.effects) and best.betters(chosen, self.numbers):
                chosen = best
        while len(chosen.effects) > 1:
            smaller = min(self._smaller(chosen), key=lambda one: one.cost)
            if chosen.betters(smaller, self.numbers):
                break
            chosen = smaller
        return chosen

    def _smaller(self, chosen: Hypothesis) -> Iterable[Hypothesis]:
        """Calibrate a hypothesis without each of its effects in turn."""
        for name in chosen.effects:
            left = tuple(other for other in chosen.effects if other != name)
            yield self._calibrate(left, chosen.arm.without_effect(name), chosen.prediction.disturbances)

    def _accept(self, trace: Trace, chosen: Hypothesis, known: Hypotheses) -> Trace:
        """Calibrate the chosen arm as any search does, and accept its effects if they are worth it."""
        if not chosen.effects:
            return trace
        calibrator, base = self.calibrator, trace.model
        model = judge((), calibrator.polish(calibrator.calibrate(chosen.arm)), calibrator.dataset)
        measure = self.criteria.measure([base.score, model.score])
        if not self.criteria.is_worthwhile(base, model, measure):
            return trace
        accepted, tried = [], []
        for place, name in enumerate(chosen.effects):
            alike = self._alike(chosen, name, known)
            before = known.get(frozenset(chosen.effects[: place + 1]))
            score = model.score if before is None or place + 1 == len(chosen.effects) else calibrator.score(before.arm)
            gain = min(max(1.0 - score.excess / base.score.excess, 0.0), 1.0)
            accepted.append(Accepted(name, (name, *alike), score))
            calibrations = {other: calibrator.calibrate(one.arm) for other, one in alike.items()}
            tried += [Tried(other, gain, calibration) for other, calibration in calibrations.items()]
            tried.append(Tried(name, gain, model.calibration))
        return trace.then("accept", model, accepted, tried)

    def _alike(self, chosen: Hypothesis, effect: str, known: Hypotheses) -> dict[str, Hypothesis]:
        """Find the hypotheses with another effect in the place of one that the recordings cannot tell from the chosen one."""
        beside, base = set(chosen.effects) - {effect}, known[frozenset()]
        others = [one for one in known.values() if len(one.effects) == len(chosen.effects) and beside < set(one.effects)]
        alike = [one for one in others if effect not in one.effects and one.equals(chosen, base, self.numbers)]
        return {next(iter(set(one.effects) - beside)): one for one in sorted(alike, key=lambda one: one.cost)}


def _fitted_cost(one: Hypothesis) -> float:
    """Look up the cost of the fitted part, by which a level is chosen: a model that lacks an effect may fail later."""
    return one.prediction.cost


def _beside(one: Hypothesis) -> str:
    return f" beside {' and '.join(one.effects)}" if one.effects else ""
