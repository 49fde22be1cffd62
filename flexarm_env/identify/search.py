"""Search for the effects that a model lacks: add the best, refit, and again, until nothing is left or nothing helps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.acceptance import WHOLE, Acceptance, stays_lost
from flexarm_env.identify.data import Data
from flexarm_env.identify.fits import Fits
from flexarm_env.identify.hypothesis import Hypothesis, at_bound, excess, in_windows, judged
from flexarm_env.identify.least_squares import in_threads
from flexarm_env.identify.one_by_one import one_by_one
from flexarm_env.identify.problem import Score, score
from flexarm_env.identify.proposals import Proposals, are_lost
from flexarm_env.identify.refit import FAR_OFF, Progress, Refit, polish, refit, with_effects_of
from flexarm_env.identify.rivals import SAME_GAIN, Place, in_place_of, order_of, same
from flexarm_env.identify.screen import Trial

MOST_EFFECTS = 3
#: An error above this may be for a rival to remove.
AT_NOISE = 1.01


class Search:
    """Forward search: add the best effect, refit, and again, until nothing is left or nothing helps."""

    def __init__(self, nominal: Arm, data: Data, jobs: int, say: Progress) -> None:
        self.nominal, self.data, self.jobs = nominal, data, jobs
        self.fits = Fits(nominal, data, jobs, say)
        self.noisy = nominal.constants["drive"]["torque_noise"] > 0.0
        self.accepted: list[str] = []
        self.equivalent: list[list[str]] = []
        self.steps: dict[str, Score] = {}
        self.ranking: dict[str, tuple[float, Refit | None]] = {}

    def run(self, base: Refit, before: Score, first: Score) -> None:
        """Search from the refitted constants, given the errors before and after the refit."""
        self.base, self.first = base, first
        self.rules = Acceptance(first, self.noisy)
        self.proposals = Proposals(self.fits, self.rules, excess(first.windows) / excess(before.windows))
        self.found, self.best = base, first
        self.chain = [judged((), base, self.data)]
        done = 0.1
        while len(self.accepted) < MOST_EFFECTS and self._add_one(done, 0.3):
            done = min(done + 0.3, 0.7)
            if len(self.accepted) > 1:  # what is wrong in its place asks for one more
                self._swap(done)
        if len(self.accepted) == 1:
            self._swap(done)
        self._drop_useless()
        if self.first.windows > WHOLE and not self.rules.explains(self.best) and self._add_one_by_one(done, bent=True):
            self._swap(done)
            self._drop_useless()

    def _add_one_by_one(self, done: float, bent: bool) -> bool:
        """Take effects that explain the data only together, if there are some.

        Args:
            done: share of the search.
            bent: whether the constants may have made up for what is missing.
        """
        self.chain = one_by_one(self.chain, self.fits, self.rules, MOST_EFFECTS, done, bent) if self.chain else []
        if not self.chain or not self.rules.is_whole(self.chain[-1].score):
            return False
        last = self.chain[-1]
        self.accepted = list(last.effects)
        self.equivalent = [[effect] for effect in last.effects]
        self.steps = {h.effects[-1]: h.score for h in self.chain[1:]}
        for without, step in pairwise(self.chain):
            gain = 1.0 - in_windows(step.score) / in_windows(without.score)
            self.ranking[step.effects[-1]] = (float(np.clip(gain, 0.0, 1.0)), last.refit)
        self.found, self.best = last.refit, last.score
        return True

    def open_hypotheses(self) -> dict[str, Arm]:
        """Return the arms between which the recordings do not decide, by effect; the arm that is left, where they do."""
        for names in self.equivalent:
            beside = set(self.accepted) - {names[0]}
            rivals = {name: self.ranking[name][1] for name in names[1:] if name in self.ranking}
            fitted = {name: r.arm for name, r in rivals.items() if r is not None and beside <= set(r.arm.effects)}
            if fitted:
                return {names[0]: self.found.arm, **fitted}
        return {"": self.found.arm}

    def _add_one(self, done: float, share: float) -> bool:
        enough = self.rules.is_enough(self.best)
        if enough and self.ranking:
            return False
        is_first = not self.accepted
        trials = self.proposals.screen(self.found, is_first, done, 0.6 * share)
        if not self.ranking:
            self._rank_screened(trials)
        if enough:
            return False
        found = self.proposals.nearest(trials, done + 0.6 * share, 0.1 * share)
        if is_first and self._come_together(found, done + 0.7 * share):
            return True
        found = self.proposals.others(found, trials, self.found, self.best, is_first, done + 0.7 * share, 0.3 * share)
        if self.accepted:
            self._go_on()
        if not found:
            return False
        measure = self.rules.measure_of([h.score for h in found])
        found.sort(key=lambda h: measure(h.score))
        for hypothesis in reversed(found):
            gain = 1.0 - measure(hypothesis.score) / measure(self.best)
            if len(hypothesis.effects) == 1:
                self._remember(hypothesis.effects[0], gain, hypothesis.refit)
        possible = [h for h in found if not at_bound(h)]
        return bool(possible) and self._accept(possible)

    def _come_together(self, found: list[Hypothesis], done: float) -> bool:
        """Take the first effect and more beside it where none comes near alone, but some explain the data together."""
        possible = [h for h in found if not at_bound(h)]
        if not possible:
            return False
        measure = self.rules.measure_of([h.score for h in possible])
        self.chain.append(min(possible, key=lambda h: measure(h.score)))
        return are_lost(found, self.best) and self._add_one_by_one(done, bent=False)

    def _accept(self, found: list[Hypothesis]) -> bool:
        """Take the best hypothesis if it removes enough; the simplest of those that remove nearly as much."""
        measure = self.rules.measure_of([h.score for h in found])
        now = measure(self.best)
        singles = [h for h in found if len(h.effects) == 1]
        winner = found[0]
        if len(winner.effects) > 1 and singles:
            ways = (measure, in_windows)  # of models that are far off, one may rest where it should move, and err little
            if not any(self.rules.is_worth(singles[0].score, winner.score, way) for way in ways):
                winner = singles[0]
        removed = now - measure(winner.score)
        if not self.rules.is_worth(self.best, winner.score, measure) or (self.accepted and stays_lost(winner.score, self.best)):
            return False
        rivals = self._rivals(winner, [h for h in found if len(h.effects) == len(winner.effects)], removed, measure)
        winner, alike = rivals[0], [h.effects[0] for h in rivals]
        with in_threads(self.jobs):
            refitted = polish(winner.refit, self.nominal, self.data)
        value = score(refitted.arm, self.data)
        for effect in winner.effects:
            self.accepted.append(effect)
            self.equivalent.append(alike if effect == winner.effects[0] else [effect])
            self.steps[effect] = value
        self.found, self.best = refitted, value
        return True

    def _rivals(
        self, winner: Hypothesis, found: Sequence[Hypothesis], removed: float, measure: Callable[[Score], float]
    ) -> list[Hypothesis]:
        """Return the hypotheses between which the data do not decide, best first, each refitted from nominal constants.

        What tells near ones apart is less than what a fit leaves that began where constants had made up for the missing effect.
        """
        first = [h for h in found if h is winner or measure(h.score) <= measure(winner.score) + SAME_GAIN * removed]
        if len(first) == 1:
            return first
        arms = [with_effects_of(h.refit.arm, self.nominal) for h in first]
        again = self.fits.refit_all([h.effects for h in first], arms, 0.7, 0.05)
        order = order_of(winner.score, self.data, measure)
        better = [min(pair, key=order) for pair in zip(first, again, strict=True)]
        for hypothesis in better if len(winner.effects) == 1 else []:
            self._remember(hypothesis.effects[0], 1.0 - measure(hypothesis.score) / measure(self.best), hypothesis.refit)
        left = min(measure(h.score) for h in better)
        return sorted([h for h in better if measure(h.score) <= left + same(removed, left)], key=order)

    def _go_on(self) -> None:
        """Refit once more without anything new: what that gains is no merit of another effect."""
        with in_threads(self.jobs):
            found = refit(self.found.arm, self.nominal, self.data)
        value = score(found.arm, self.data)
        if value.windows < self.best.windows:
            self.found, self.best = found, value
            self.steps[self.accepted[-1]] = value

    def _remember(self, effect: str, gain: float, found: Refit | None) -> None:
        if effect not in self.accepted:
            self.ranking[effect] = (float(np.clip(gain, 0.0, 1.0)), found)

    def _rank_screened(self, trials: list[Trial]) -> None:
        reference = next(t for t in trials if not t.effect)
        for trial in trials:
            if trial.effect:
                gain = 1.0 - trial.held_out / reference.held_out
                self.ranking[trial.effect] = (float(np.clip(gain, 0.0, 1.0)), None)

    def _drop_useless(self) -> None:
        """Take out an effect that the later ones have made needless."""
        for effect in list(self.accepted) if len(self.accepted) > 1 else []:
            without = refit(self.found.arm.without_effect(effect), self.nominal, self.data)
            value = score(without.arm, self.data)
            measure = self.rules.measure_of([value, self.best])
            if not self.rules.is_worth(value, self.best, measure):
                self.found, self.best = without, value
                place = self.accepted.index(effect)
                del self.accepted[place], self.equivalent[place], self.steps[effect]

    def _swap(self, done: float) -> None:
        """Put what an effect is confused with in its place, if that fits better beside everything else.

        An effect that came in first was held against its rivals where others were missing still, and a constant torque that
        came in beside another effect against none.
        """
        for place, effect in enumerate(list(self.accepted)):
            if self.best.windows > FAR_OFF:  # so much is missing that no rival can be told from another
                break
            now = judged(tuple(self.accepted), self.found, self.data)
            if self.found.arm.known[effect].pairs_with_all or max(now.score.windows, now.fitted.windows) > AT_NOISE:
                self._put(place, in_place_of(effect, now, self.fits, self.rules, done))
        self.equivalent = [[n for n in names if n == names[0] or n not in self.accepted] for names in self.equivalent]

    def _put(self, place: int, found: Place) -> None:
        """Put the effect that fits best in a place, and what these recordings cannot tell from it."""
        name, before = found.effect, self.accepted[place]
        gain = max((self.ranking[n][0] for n in (name, before) if n in self.ranking), default=0.0)
        for rival, hypothesis in {name: found.best, **found.alike}.items():
            self.ranking[rival] = (self.ranking[rival][0] if rival in self.ranking else gain, hypothesis.refit)
        untried = [n for n in self.equivalent[place] if n not in found.tried]
        self.equivalent[place] = [name, *found.alike, *untried]
        if name != before:
            self.ranking[name] = (gain, found.best.refit)
            self.found, self.best = found.best.refit, found.best.score
            self.accepted[place] = name
            self.steps[name] = self.steps.pop(before)
            self.steps[self.accepted[-1]] = self.best
