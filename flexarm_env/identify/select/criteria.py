"""By which criteria a search accepts, exchanges and drops effects, and reaches its verdict."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.error_measure import Score, excess
from flexarm_env.identify.select.model import Model
from flexarm_env.identify.settings import Settings

#: The excess error of a score by which models are compared.
Measure = Callable[[Score], float]


class Criteria(Protocol):
    """Decisions of a search: pure functions of scores and models."""

    def measure(self, scores: Sequence[Score]) -> Measure:
        """Choose the excess error by which models with these scores are compared."""

    def is_sufficient(self, found: Model) -> bool:
        """Whether an error leaves nothing to explain, so that the search ends."""

    def is_worthwhile(self, without: Model, found: Model, measure: Measure) -> bool:
        """Whether one more effect removes enough of the excess error."""

    def explains(self, found: Model) -> bool:
        """Whether a model explains the data, so that its effects are named."""

    def is_fully_explained(self, found: Model) -> bool:
        """Whether a model explains the data down to the noise."""

    def is_inadequate(self, best: float, without: Model) -> bool:
        """Whether the best error in windows of several models shows that none of them is the missing effect."""

    def stays_inadequate(self, found: Model, without: Model) -> bool:
        """Whether one more effect leaves a model inadequate that was so without it."""

    def trusts_constants(self) -> bool:
        """Whether calibrating the constants alone removed enough to start from them."""

    def rejects_constants(self) -> bool:
        """Whether calibrating the constants alone removed so little that nothing starts from them."""

    def rank(self, best: Score, measure: Measure, dataset: Dataset) -> Callable[[Model], float]:
        """Choose the key by which rivals of a model with this score are ordered, best first."""

    def can_compare_rivals(self, found: Model) -> bool:
        """Whether a model comes near enough for rivals of its effects to be compared."""

    def leaves_room(self, found: Model) -> bool:
        """Whether a model leaves an error that a rival of one of its effects could remove."""

    def ranks_by_forecasts(self, best: Score) -> bool:
        """Whether models, the best of which has this score, are ordered by the density of their forecasts."""

    def replaces(self, rival: Model, now: Model, measure: Measure, dataset: Dataset) -> bool:
        """Whether a rival fits so much better that it takes an effect's place."""

    def comes_near(self, removed: float, most: float) -> bool:
        """Whether the excess that an effect removes comes near to the most that one removes, while others may be missing."""

    def contender_difference(self, removed: float) -> float:
        """Compute the difference of the excess up to which models are calibrated again as rivals of the best one."""

    def equivalent_difference(self, removed: float, left: float) -> float:
        """Compute the largest difference of the excess that equivalent effects leave."""

    def equivalence_level(self, best: Score, measure: Measure) -> float:
        """Compute the largest excess that an effect leaves that is equivalent to the best one."""

    def verdict(self, accepted: Sequence[str], base: Model, found: Model) -> str:
        """Reach the verdict of a search from the effects that it accepted, the model without them and the one that has them."""


#: Builds criteria from the score of the arm as given, that with its constants calibrated, whether the free run says anything of
#: the model, and the settings.
CriteriaFactory = Callable[[Score, Score, bool, Settings], Criteria]


@dataclass(frozen=True)
class ThresholdCriteria:
    """Fixed shares of the excess error, tuned on machines with known hidden effects.

    Attributes:
        nominal: score of the arm as given.
        refitted: score with its constants calibrated.
        judges_free_run: false where torque noise is stated, so that no free run says anything.
        settings: the thresholds.
    """

    nominal: Score
    refitted: Score
    judges_free_run: bool
    settings: Settings

    def measure(self, scores: Sequence[Score]) -> Measure:
        """Choose the excess error in windows where a model comes near the noise.

        Otherwise the free run counts as much, since it shows the long-term error; and alone, where even windows are far off.
        """
        best = min(s.windows for s in scores)
        if self.judges_free_run and best > self.settings.errors.far_off:
            return lambda s: s.free_run_excess
        if self.judges_free_run and best > self.settings.errors.close:
            return lambda s: s.mean_excess
        return lambda s: s.excess

    def is_sufficient(self, found: Model) -> bool:
        """Whether the error is near the noise, or the excess below the least that an effect must remove.

        Where the fitted part is not explained, what is missing shows there alone.
        """
        score, errors = found.score, self.settings.errors
        little = score.windows < errors.nothing_left or score.excess < self._least(lambda s: s.excess)
        return little and found.fitted_score.windows < errors.explained

    def is_worthwhile(self, without: Model, found: Model, measure: Measure) -> bool:
        """Whether one more effect removes a share of the excess, and more than fits leave that end early.

        It counts on the fitted part where that alone shows that something is missing, such as a stop that was touched once.
        """
        explained = self.settings.errors.explained
        is_early = without.score.windows < explained <= without.fitted_score.windows
        before, after = (measure(m.fitted_score if is_early else m.score) for m in (without, found))
        return before - after >= max(self.settings.selecting.least_gain * before, self._least(measure))

    def explains(self, found: Model) -> bool:
        """Whether a model leaves nothing to explain, or explains windows and free runs alike, as true effects do.

        An imitation of another effect often succeeds in only one of the two, or stops short of the noise.
        """
        score, errors, shares = found.score, self.settings.errors, self.settings.selecting
        if self._worsens_whole_runs(score):
            return False
        share = shares.least_total_gain if score.windows > errors.far_off else shares.least_total_gain_near
        pairs = [(self.refitted.windows, score.windows, errors.explained, share)]
        if self.judges_free_run:
            pairs.append((self.refitted.free_run, score.free_run, errors.free_run_explained, shares.least_total_gain))
        return all(new <= enough or excess(new) <= (1.0 - least) * excess(old) for old, new, enough, least in pairs)

    def explains_most(self, score: Score) -> bool:
        """Whether effects remove most of the excess, in windows and in whole runs alike, though more than the noise is left."""
        if self._worsens_whole_runs(score):
            return False
        pairs = [(self.refitted.excess, score.excess)]
        if self.judges_free_run:
            pairs.append((self.refitted.free_run_excess, score.free_run_excess))
        return all(left <= (1.0 - self.settings.selecting.least_total_gain) * before for before, left in pairs)

    def _worsens_whole_runs(self, score: Score) -> bool:
        """Whether effects raise the excess of whole runs as much as they would have to lower it elsewhere.

        Where torque noise is stated that is all they say: it alone moves the error of a real axis by some percent either way.
        """
        most = self.refitted.free_run_excess / (1.0 - self.settings.selecting.least_total_gain)
        return not self.judges_free_run and score.free_run_excess > most

    def leaves_only_noise(self, score: Score) -> bool:
        """Whether windows end at the noise, in all signals together, and in each that the effects touch near it.

        A signal that is a small part of the readings may end further off, as long as hardly any of its excess is left.
        """
        errors, numbers = self.settings.errors, self.settings.selecting
        pairs = [(self.refitted.signals[signal], one) for signal, one in score.signals.items()]
        touched = [pair for pair in pairs if abs(pair[1].over_noise - pair[0].over_noise) > numbers.noticed * pair[0].over_noise]
        near = [one.over_noise <= errors.close or one.excess <= numbers.signal_rest * was.excess for was, one in touched]
        return score.windows <= errors.explained and all(near)

    def is_fully_explained(self, found: Model) -> bool:
        """Whether a model explains the data and leaves hardly more than noise: an imitation does not."""
        score, errors, shares = found.score, self.settings.errors, self.settings.selecting
        near = score.windows < errors.explained
        near = near and score.excess < (1.0 - shares.least_total_gain_near) * self.refitted.excess
        return (near or score.windows < errors.nothing_left) and self.explains(found)

    def is_inadequate(self, best: float, without: Model) -> bool:
        """Whether the best error in windows is far off, or leaves most of the excess without it."""
        share = 1.0 - self.settings.selecting.least_total_gain
        return best > self.settings.errors.far_off or excess(best) > share * without.score.excess

    def stays_inadequate(self, found: Model, without: Model) -> bool:
        """Whether one more effect leaves the model far off without removing most of its excess, in windows and in the free run.

        Something else is missing then, which a flexible enough effect imitates where it was fitted.
        """
        share = 1.0 - self.settings.selecting.least_total_gain
        new, old = found.score, without.score
        pairs = ((new.excess, old.excess), (new.free_run_excess, old.free_run_excess))
        return new.windows > self.settings.errors.far_off and any(left > share * before for left, before in pairs)

    def trusts_constants(self) -> bool:
        """Whether the calibrated constants leave little of the nominal excess."""
        return self._left < self.settings.proposing.refit_helps

    def rejects_constants(self) -> bool:
        """Whether they leave most of it."""
        return self._left > self.settings.proposing.refit_fails

    def ranks_by_forecasts(self, best: Score) -> bool:
        """Whether whole runs say little: the best model is far off, or torque noise is stated, which forecasts pay for."""
        return best.windows > self.settings.errors.far_off or not self.judges_free_run

    def rank(self, best: Score, measure: Measure, dataset: Dataset) -> Callable[[Model], float]:
        """Order rivals by forecasts where whole runs say little; else by the held-out excess, or by BIC near the noise."""
        if self.ranks_by_forecasts(best):
            return lambda model: model.forecast_cost
        near = best.windows < self.settings.errors.close
        return (lambda model: model.bic(dataset)) if near else (lambda model: measure(model.score))

    def can_compare_rivals(self, found: Model) -> bool:
        """Whether the model is not far off, or removes most of what was: else no rival can be told from another."""
        return found.score.windows <= self.settings.errors.far_off or self.explains_most(found.score)

    def leaves_room(self, found: Model) -> bool:
        """Whether held-out or fitted errors are above the noise."""
        return max(found.score.windows, found.fitted_score.windows) > self.settings.errors.at_noise

    def replaces(self, rival: Model, now: Model, measure: Measure, dataset: Dataset) -> bool:
        """Whether the rival ranks first; by more than chance, where the model does not come near the noise.

        There a rival of more numbers lowers the excess in windows as well: it may imitate another effect in whole runs alone.
        """
        rank = self.rank(now.score, measure, dataset)
        if now.score.windows < self.settings.errors.close:
            return rank(rival) < rank(now)
        share, has_more = self.settings.selecting.least_gain, now.numbers < rival.numbers
        most, by_forecasts = 1.0 - share, self.ranks_by_forecasts(now.score)
        chance = self.settings.forecast_searching.least_log_gain if by_forecasts else share * rank(now)
        return rank(rival) < rank(now) - chance and (not has_more or rival.score.excess < most * now.score.excess)

    def comes_near(self, removed: float, most: float) -> bool:
        """Whether it is a share of the most."""
        return removed >= self.settings.selecting.near_gain * most

    def contender_difference(self, removed: float) -> float:
        """Compute a share of the removed excess."""
        return self.settings.selecting.same_gain * removed

    def equivalent_difference(self, removed: float, left: float) -> float:
        """Compute a share of the removed excess, but no more than the remaining one, or `same_excess` if larger."""
        return min(self.contender_difference(removed), max(left, self.settings.selecting.same_excess))

    def equivalence_level(self, best: Score, measure: Measure) -> float:
        """Add that difference to the excess that the best one leaves."""
        left = measure(best)
        return left + self.equivalent_difference(measure(self.refitted) - left, left)

    def verdict(self, accepted: Sequence[str], base: Model, found: Model) -> str:
        """Name effects that explain the data or most of them; else say whether the constants do, of the fitted part as well.

        A stop may be touched in that part alone: what is held out then ends at the noise, and says nothing of it.
        """
        if accepted and self.explains(found) and self.leaves_only_noise(found.score):
            return "effects"
        if accepted and (self.explains(found) or self.explains_most(found.score)):
            return "partly"
        if max(base.score.windows, base.fitted_score.windows) > self.settings.errors.explained:
            return "unknown"
        wrong = self.nominal.excess > self.settings.selecting.refit_needed * self.refitted.excess
        return "parameters" if wrong and self.nominal.windows > self.settings.errors.nothing_left else "nothing_missing"

    @property
    def _left(self) -> float:
        """Share of the nominal excess that the calibrated constants leave."""
        return self.refitted.excess / self.nominal.excess

    def _least(self, measure: Measure) -> float:
        """Compute the excess that an effect must remove at least.

        A calibration may end early and leave a share of what there was, but not more than keeps it close to the noise.
        """
        numbers = self.settings.selecting
        return max(
            numbers.least_removed, min(numbers.least_of_first * measure(self.refitted), excess(self.settings.errors.close))
        )
