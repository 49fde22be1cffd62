"""Search for the effects that a model lacks: forward, swap, drop; by forecasts where that leaves more than noise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.progress import Progress
from flexarm_env.identify.select.choose import best_of, comes_near, removes_enough, simplest, with_forecasts
from flexarm_env.identify.select.criteria import Criteria, Measure
from flexarm_env.identify.select.fits import fit_in_place
from flexarm_env.identify.select.forecast_search import ForecastSearch
from flexarm_env.identify.select.model import Model, judge
from flexarm_env.identify.select.propose import nearest, none_comes_near, others, starts_of_search
from flexarm_env.identify.select.rivals import find_rivals
from flexarm_env.identify.select.screen import Trial, control_of, screen
from flexarm_env.identify.select.starts import candidates, shows_part_of_period
from flexarm_env.identify.select.stepwise import extend_chain
from flexarm_env.identify.select.swap import compare_rivals, exchange
from flexarm_env.identify.select.trace import (
    SETTLE,
    Accepted,
    Trace,
    Tried,
    beside,
    gains,
    others_of,
    placed,
    share,
    with_last_score,
)


@dataclass(frozen=True)
class Search:
    """A search over effects. Every method takes the trace so far and gives a longer one.

    Attributes:
        calibrator: of the recordings.
        criteria: by which models are judged.
    """

    calibrator: Calibrator
    criteria: Criteria

    @property
    def is_late(self) -> bool:
        """Whether the time that the search may take is over: what has not begun is left out, and the trace so far stands."""
        return self.calibrator.workers.deadline.is_over

    def _stop(self, trace: Trace, left_out: str) -> Trace:
        return trace.stopped_before(left_out, self.calibrator.workers.deadline)

    def run(self, base: Model, progress: Progress) -> Trace:
        """Search from the calibrated constants: add the best effect, calibrate, again, until nothing is left or nothing helps.

        Where more than noise is left, forecasts are asked for another model, and the search goes on beside that.
        """
        stepwise, forecasting, beside_forecast = progress.split(23, 4, 4)
        trace = self._forward(Trace.begin(base), stepwise)
        explained = self.criteria.is_fully_explained(trace.model)
        leaves_nothing = explained and trace.model.score.windows < self.calibrator.settings.errors.nothing_left
        if leaves_nothing or base.score.windows <= self.calibrator.settings.errors.explained:
            return trace
        asked = self.ask_forecasts(trace, forecasting)
        if asked.model is trace.model or self.criteria.is_fully_explained(asked.model):
            return asked
        return self._forward(asked, beside_forecast)

    def hold_out_late(self, trace: Trace) -> Calibrator:
        """Make a calibrator that sees more of the recordings where a model that was tried explains only what fits saw.

        Then another effect comes into play late, which no fit could see. The calibrator is the same where something explains
        everything, or nothing that much.
        """
        if self.is_late or self.criteria.is_fully_explained(trace.model):
            return self.calibrator
        tried = (trace.model.calibration, *(t.calibration for t in trace.ranking.values() if t.calibration))
        best = min(tried, key=lambda c: self.calibrator.score(c.arm, held_out=False).windows)
        return self.calibrator.hold_out_late(best.arm)

    def settle(self, trace: Trace) -> Trace:
        """Calibrate the final model on all of the data where it fails in whole runs of the held-out part alone.

        The fitted part may leave a value uncertain, such as a limit that is reached once. It is kept if it explains everything
        then.
        """
        model, most = trace.model, self.calibrator.settings.errors.nothing_left
        right = max(model.score.windows, model.fitted_score.windows, model.fitted_score.free_run) <= most
        if self.is_late or not trace.accepted or not right or self.criteria.explains(model):
            return trace
        with self.calibrator.workers.threads():
            calibration = self.calibrator.calibrate_on_all_data(model.calibration)
        settled = judge(model.effects, calibration, self.calibrator.dataset)
        if not self.criteria.is_fully_explained(settled):
            return trace
        return trace.then(SETTLE, settled, with_last_score(trace.accepted, settled))

    def _forward(self, trace: Trace, progress: Progress) -> Trace:
        """Add the best effect, exchange those that another fits better, again, and drop what later ones made useless."""
        most, fewest = self.calibrator.settings.selecting.most_effects, len(trace.accepted)
        *rounds, swapping = progress.split(*([5, 2] * most), 2)
        for adding, exchanging in zip(rounds[::2], rounds[1::2], strict=True):
            if len(trace.accepted) >= most:
                break
            longer = self.add(trace, adding)
            added, trace = len(longer.accepted) > len(trace.accepted), longer
            if added and len(trace.accepted) > 1:  # an effect in the wrong place calls for one more
                trace = self.swap(trace, exchanging, untried=trace.steps[-1].action == "combine")
            if not added:
                break
        if len(trace.accepted) == 1 > fewest:
            trace = self.swap(trace, swapping)
        return self.drop_useless(trace) if len(trace.accepted) > fewest else trace

    def add(self, trace: Trace, progress: Progress) -> Trace:
        """Add the effect that removes most, if it is worthwhile; record all that were tried."""
        sufficient = self.criteria.is_sufficient(trace.model)
        if sufficient and trace.ranking:
            return trace
        if self.is_late:
            return self._stop(trace, beside("an effect was tried", trace))
        screening, fitting, more = progress.split(6, 1, 3)
        starts = starts_of_search(self.calibrator, self.criteria, trace.model)
        screened = screen(self.calibrator, starts, screening, briefly=sufficient)
        if not trace.ranking:
            trace = trace.then("screen", tried=_gains_of_screening(screened.trials))
        if screened.untried:
            trace = self._stop(trace, beside(f"these effects were tried: {', '.join(screened.untried)}", trace))
        if sufficient:
            return trace
        return self._fit_screened(trace, screened.trials, fitting, more)

    def _fit_screened(self, trace: Trace, trials: Sequence[Trial], fitting: Progress, more: Progress) -> Trace:
        """Calibrate what screening found promising, and accept what is worthwhile."""
        models = nearest(self.calibrator, self.criteria, trials, fitting)
        if not trace.accepted and not self.is_late:
            models = self._restarted(trace, models)
            trace = self._combine_at_once(trace, models, more)
            if trace.accepted:
                return trace
        if not self.is_late:
            models = others(self.calibrator, self.criteria, models, trials, trace.model, more)
        if not trace.accepted and len(trace.chain) == 1 and not self.is_late:
            trace = self._combine_at_once(trace, models, more)
            if trace.accepted:
                return trace
        if self.is_late:
            trace = self._stop(trace, beside("every promising effect was calibrated", trace))
        elif trace.accepted:
            trace = self._recalibrate(trace)
        if not models:
            return trace
        measure = self.criteria.measure([m.score for m in models])
        models = sorted(models, key=lambda m: measure(m.score))
        trace = trace.then("fit", tried=gains(trace, models[::-1], measure))
        possible = [m for m in models if not m.at_bound]
        return self._accept(trace, possible, more) if possible else trace

    def ask_forecasts(self, trace: Trace, progress: Progress) -> Trace:
        """Accept the model that forecasts ask for in place of another, if it explains the data, or removes most of the rest.

        Errors over a second or more show what is missing where one effect is. Where several hide each other, forecasts over a
        fraction of that are less misled.
        """
        left_out = "models were compared by their forecasts"
        if self.is_late:
            return self._stop(trace, left_out)

        now, least = trace.model, self.calibrator.settings.selecting.least_removed
        is_explained = self.criteria.is_fully_explained(now)
        if is_explained and self._is_rough(now):
            return trace
        enough = now.score.excess - least if is_explained else np.inf

        most = (1.0 - self.calibrator.settings.selecting.least_total_gain) * now.score.excess

        def is_better(found: Model) -> bool:
            is_worthwhile = self.criteria.is_worthwhile(now, found, lambda s: s.excess) and self.criteria.explains(found)
            removes_most = is_worthwhile and found.score.excess <= most
            return found.score.excess <= enough and (removes_most or self.criteria.is_fully_explained(found))

        calibrated = frozenset(trace.effects if is_explained else ())
        found = ForecastSearch(self.calibrator).propose(trace.steps[0].model, calibrated, is_better, progress)
        if found is None:
            return self._stop(trace, f"all {left_out}") if self.is_late else trace
        longer = trace.then("forecast", found.model, found.accepted, found.tried)
        return self.drop_useless(self.swap(longer, progress, untried=True))

    def _is_rough(self, found: Model) -> bool:
        """Whether two calibrations of one model differ by a share of what they leave, which then says nothing of another effect.

        Where teeth or a stop make contact, a thousandth of a gap moves the error by more than the noise.
        """
        calibrator, left = self.calibrator, found.score.excess
        with calibrator.workers.threads():
            other = calibrator.calibrate(calibrator.nominal_with_effects_of(found.arm))
        return abs(calibrator.score(other.arm).excess - left) > calibrator.settings.selecting.rough * left

    def combine(self, trace: Trace, progress: Progress) -> Trace:
        """Accept effects that explain the data only together, if there are some."""
        chain = extend_chain(self.calibrator, self.criteria, trace.chain, progress) if trace.chain else ()
        trace = replace(trace, chain=chain)
        if not chain or not self.criteria.is_fully_explained(chain[-1]):
            return trace
        accepted = [Accepted(m.effects[-1], (m.effects[-1],), m.score) for m in chain[1:]]
        tried = [
            Tried(step.effects[-1], share(1.0 - step.score.excess / without.score.excess), chain[-1].calibration)
            for without, step in pairwise(chain)
        ]
        return trace.then("combine", chain[-1], accepted, tried)

    def swap(self, trace: Trace, progress: Progress, untried: bool = False) -> Trace:
        """Give an effect's place to one that it is confused with, where that fits better beside everything else.

        An effect that came in first was compared with its rivals while others were missing still, and a companion with none. One
        that a simpler effect equals may fit better only because the simpler one's calibration ended early. Each is compared anew
        when one beside it has given way, and so is one whose equivalents, or simpler effects near to it, were found beside
        others. At the noise the others are compared with those simpler ones alone that were not tried.

        Args:
            trace: so far.
            progress: of this stage.
            untried: whether no effect was compared with any, so that each is, though hardly more than noise is left.
        """
        compared: dict[str, frozenset[str]] = {}
        seen: set[frozenset[str]] = set()
        while (found := self._next_place(trace, compared, untried)) is not None and frozenset(trace.effects) not in seen:
            place, left_out = found
            if self.is_late:
                trace = self._stop(trace, f"{trace.effects[place]} was compared with its rivals")
                break
            before = frozenset(trace.effects)
            trace = self._compare(trace, place, progress, left_out)
            compared[trace.effects[place]] = others_of(trace.effects, place)
            if frozenset(trace.effects) != before:
                seen.add(before)
        names = trace.effects
        kept = [
            replace(a, equivalent=tuple(n for n in a.equivalent if n == a.equivalent[0] or n not in names))
            for a in trace.accepted
        ]
        return trace if kept == list(trace.accepted) else trace.then("swap", accepted=kept)

    def _compare(self, trace: Trace, place: int, progress: Progress, compared: frozenset[str] = frozenset()) -> Trace:
        """Compare an accepted effect with its rivals, and what takes its place with those of its own that are new.

        The one that gave way is calibrated anew then, too: its calibration was not from its signature, and may have ended early.
        """
        effect = trace.effects[place]
        comparison = compare_rivals(self.calibrator, self.criteria, trace.accepted[place], trace.model, progress, compared)
        trace = exchange(trace, place, comparison)
        if comparison.untried:
            return self._stop(trace, f"{effect} was compared with {', '.join(comparison.untried)}")
        if comparison.effect == effect or self.is_late:
            return trace
        return self._compare(trace, place, progress, compared | (comparison.tried - {effect}))

    def _next_place(
        self, trace: Trace, compared: Mapping[str, frozenset[str]], untried: bool
    ) -> tuple[int, frozenset[str]] | None:
        """Find the first effect that was not compared yet beside the others as they are now, and may give way to a rival.

        Returns:
            Its place, and the effects with which it need not be compared.
        """
        if not self.criteria.can_compare_rivals(trace.model):
            return None
        every = untried or self.criteria.leaves_room(trace.model)
        for place, (effect, accepted) in enumerate(zip(trace.effects, trace.accepted, strict=True)):
            others = others_of(trace.effects, place)
            if compared.get(effect) == others:
                continue
            is_outdated = accepted.beside != others and (len(accepted.equivalent) > 1 or len(accepted.near) > 0)
            if every or is_outdated or self._may_be_another(trace, place):
                return place, frozenset()
            if simpler := self._untried_and_simpler(trace, place):
                return place, frozenset(trace.model.arm.known) - simpler
        return None

    def _may_be_another(self, trace: Trace, place: int) -> bool:
        """Whether an accepted effect may stand for a simpler one, or for one that was not compared with it."""
        arm, accepted = trace.model.arm, trace.accepted[place]
        own = arm.known[accepted.effect]
        simpler = any(len(arm.known[n].parameters) < len(own.parameters) for n in accepted.equivalent)
        return simpler or own.pairs_with_all or shows_part_of_period(arm, accepted.effect, self.calibrator.dataset)

    def _untried_and_simpler(self, trace: Trace, place: int) -> frozenset[str]:
        """Find effects of fewer numbers with which an accepted one is confused, and that screening found not worth a trial."""
        known, own = trace.model.arm.known, trace.model.arm.known[trace.effects[place]]
        others = [n for n in own.confused_with if n in known and n not in trace.effects and n not in trace.ranking]
        return frozenset(n for n in others if len(known[n].parameters) < len(own.parameters))

    def drop_useless(self, trace: Trace) -> Trace:
        """Drop an effect that later ones have made useless, or that only makes up for the wrong one of several equivalents."""
        for effect in trace.effects if len(trace.accepted) > 1 else []:
            if self.is_late:
                return self._stop(trace, f"the model without {effect} was calibrated")
            without = self._without(trace.model, effect)
            kept = [a for a in trace.accepted if a.effect != effect]
            if without and self._is_useless_beside(without, trace.model):
                trace = trace.then("drop", without, kept)
                continue
            for place, other in enumerate(kept):
                rest = trace.model.arm.without_effect(effect).without_effect(other.effect)
                equivalent = [n for n in other.equivalent[1:] if n not in trace.effects]
                names = [n for n in equivalent if n in candidates(rest, self.calibrator.dataset)]
                models = fit_in_place(
                    self.calibrator, rest, names, Progress(), thorough=True, rivals_of_noise=self._is_near(trace.model)
                )
                better = [m for m in models if m and not m.at_bound and self._is_useless_beside(m, trace.model)]
                if better:
                    best = min(better, key=lambda m: m.score.windows)
                    name = best.effects[0]
                    alike = (name, *(m.effects[0] for m in better if m is not best))
                    entry = Accepted(name, alike, best.score, others_of([a.effect for a in kept], place))
                    return trace.then("drop", best, placed(kept, place, entry))
        return trace

    def _without(self, found: Model, effect: str) -> Model | None:
        """Calibrate a model without one of its effects; None where that cannot leave only noise, and the model does."""
        calibrator, arm = self.calibrator, found.arm.without_effect(effect)
        calibration = calibrator.calibrate_rival(arm, thorough=True) if self._is_near(found) else calibrator.calibrate(arm)
        return None if calibration is None else judge((), calibration, calibrator.dataset)

    def _is_near(self, found: Model) -> bool:
        """Whether a model leaves hardly more than noise, so that one that is as good does, too."""
        return found.score.windows <= self.calibrator.settings.errors.explained

    def _is_useless_beside(self, without: Model, found: Model) -> bool:
        """Whether a model without an effect is as good as one with it, in windows too where whole runs are what counts."""
        measures: tuple[Measure, ...] = (self.criteria.measure([without.score, found.score]), lambda s: s.excess)
        return not any(self.criteria.is_worthwhile(without, found, measure) for measure in measures)

    def _combine_at_once(self, trace: Trace, models: Sequence[Model], progress: Progress) -> Trace:
        """Accept the first effect and more beside it where none comes near alone, but some explain the data together."""
        best = best_of(self.criteria, models)
        if best is None:
            return trace
        trace = replace(trace, chain=(*trace.chain, best))
        if not none_comes_near(self.criteria, models, trace.model):
            return trace
        return self.combine(trace, progress)

    def _combine_beside(self, trace: Trace, found: Model, progress: Progress) -> Trace:
        """Accept an effect that leaves the model far off beside one more, if both explain the data; one is accepted so far."""
        if len(trace.accepted) + len(found.effects) > 2:
            return trace
        both = replace(found, effects=(*trace.effects, *found.effects))
        return self.combine(replace(trace, chain=(trace.steps[0].model, trace.model, both)), progress)

    def _restarted(self, trace: Trace, models: list[Model]) -> list[Model]:
        """Calibrate the best model from the nominal constants, too, where none comes near: it alone may be what is missing."""
        best = best_of(self.criteria, models)
        if best is None or not none_comes_near(self.criteria, models, trace.model):
            return models
        with self.calibrator.workers.threads():
            calibration = self.calibrator.restart_from_nominal(best.calibration)
        again = judge(best.effects, calibration, self.calibrator.dataset)
        return [again if m is best else m for m in models]

    def _recalibrate(self, trace: Trace) -> Trace:
        """Calibrate once more without anything new: that gain is no merit of another effect."""
        with self.calibrator.workers.threads():
            calibration = self.calibrator.calibrate(trace.model.arm)
        again = judge((), calibration, self.calibrator.dataset)
        if again.score.windows >= trace.model.score.windows:
            return trace
        return trace.then("recalibrate", again, with_last_score(trace.accepted, again))

    def _accept(self, trace: Trace, models: Sequence[Model], progress: Progress) -> Trace:
        """Accept the best model if it removes enough; the simplest of those that remove nearly as much."""
        measure, before = self.criteria.measure([m.score for m in models]), trace.model
        models = with_forecasts(self.calibrator, self.criteria, models, min((m.score for m in models), key=measure))
        winner = simplest(self.calibrator, self.criteria, models, before, measure)
        if not removes_enough(self.criteria, before, winner, measure):
            return trace
        if trace.accepted and self.criteria.stays_inadequate(winner, before):
            return self._combine_beside(trace, winner, progress)
        alike = [m for m in models if len(m.effects) == len(winner.effects)]
        rivals = find_rivals(self.calibrator, self.criteria, before, winner, alike, measure)
        if not rivals.is_complete:
            trace = self._stop(trace, f"rivals of {winner.effects[0]} were calibrated again")
        elif rivals.tried and len(winner.effects) == 1:
            trace = trace.then("fit", tried=gains(trace, rivals.tried, rivals.measure))
        winner, names = rivals.models[0], tuple(m.effects[0] for m in rivals.models)
        model = self._polish(winner)
        first, *companions = winner.effects
        beside_first = frozenset([*trace.effects, *companions])
        simpler = [m for m in alike if m.numbers < winner.numbers]
        near = tuple(m.effects[0] for m in simpler if comes_near(self.criteria, before, m, winner, measure))
        added = [Accepted(first, names, model.score, beside_first, near), *(Accepted(n, (n,), model.score) for n in companions)]
        return trace.then("accept", model, [*trace.accepted, *added])

    def _polish(self, model: Model) -> Model:
        """Continue the calibration of a model, as long as there is time."""
        if self.is_late:
            return model
        with self.calibrator.workers.threads():
            calibration = self.calibrator.polish(model.calibration)
        return judge((), calibration, self.calibrator.dataset)


def _gains_of_screening(trials: Sequence[Trial]) -> list[Tried]:
    control = control_of(trials)
    return [Tried(t.effect, share(1.0 - t.held_out / control.held_out)) for t in trials if t.effect]
