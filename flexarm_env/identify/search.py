"""Search for the effects that a model lacks: add the best, refit, and again, until nothing is left or nothing helps."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.acceptance import Acceptance, is_lost, stays_lost
from flexarm_env.identify.data import Data
from flexarm_env.identify.fits import Fits
from flexarm_env.identify.hypothesis import OFFSET, Hypothesis, at_bound, excess, in_windows, judged
from flexarm_env.identify.least_squares import in_threads
from flexarm_env.identify.problem import Score, score
from flexarm_env.identify.refit import FAR_OFF, Progress, Refit, as_it_is, polish, refit, with_effects_of
from flexarm_env.identify.rivals import SAME_GAIN, Place, in_place_of, order_of, same
from flexarm_env.identify.screen import Trial

#: How many candidates are refitted in full in each round, and only those that lower the cost of the screening to the first
#: share, by no less than the second of what the best does.
FINALISTS = 4
LEAST_CHANGE, LEAST_OF_BEST = 0.97, 0.3
#: Those that do this share of what the best does are refitted first, the others only if none of them is enough.
NEAR_BEST = 0.6
MOST_EFFECTS = 3
#: A refit of the constants that leaves less than the first share of the excess error is trusted as a start; one that
#: leaves more than the second is not.
REFIT_HELPS, REFIT_FAILS = 0.2, 0.7
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
        self.base, self.before, self.first = base, before, first
        self.rules = Acceptance(first, self.noisy)
        self.found, self.best = base, first
        done = 0.1
        while len(self.accepted) < MOST_EFFECTS and self._add_one(done, 0.3):
            done = min(done + 0.3, 0.7)
            if len(self.accepted) > 1:  # what is wrong in its place asks for one more
                self._swap(done)
        if len(self.accepted) == 1:
            self._swap(done)
        self._drop_useless()

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
        trials = self.fits.screen(self._starts(), done, 0.6 * share)
        if not self.ranking:
            self._rank_screened(trials)
        if enough:
            return False
        found = self._hypotheses(trials, done, share)
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

    def _hypotheses(self, trials: list[Trial], done: float, share: float) -> list[Hypothesis]:
        """Refit with the candidates that promise most; where none comes near, with others from constants that are not bent."""
        found = self._refit_best(trials, done + 0.6 * share, 0.1 * share)
        if self._is_lost(found) and (self.accepted or not self._refit_did_little()):
            unmoved = as_it_is(with_effects_of(self.found.arm, self.nominal), self.data)
            others = self.fits.screen([unmoved], done + 0.6 * share, 0.1 * share)
            found = self._best_of_each(found + self._refit_best(others, done + 0.7 * share, 0.1 * share))
        if self._is_lost(found) and not self.accepted:  # a second effect's fits take minutes, with the first in the arm
            tried = [h.effects[0] for h in found]
            found += self.fits.with_all_constants(self.found, trials, tried, done + 0.7 * share, 0.1 * share)
        offset = OFFSET not in self.found.arm.effects
        if offset and found and not any(self.rules.is_enough(h.score) for h in found):
            found += self.fits.with_offset(found, done + 0.8 * share, 0.2 * share)
        return found

    def _best_of_each(self, found: list[Hypothesis]) -> list[Hypothesis]:
        """Return the better of those that say the same."""
        if not found:
            return []
        measure = self.rules.measure_of([h.score for h in found])
        best = {h.effects: h for h in sorted(found, key=lambda h: -measure(h.score))}
        return list(best.values())

    def _is_lost(self, found: Sequence[Hypothesis]) -> bool:
        """Whether none of the hypotheses comes near."""
        return is_lost(min((h.score.windows for h in found), default=np.inf), self.best)

    def _refit_best(self, trials: list[Trial], done: float, share: float) -> list[Hypothesis]:
        """Refit with the candidates that lower the cost most."""
        control = next(t for t in trials if not t.effect)
        lowest = min(t.cost for t in trials)
        level = min(LEAST_CHANGE * control.cost, control.cost - LEAST_OF_BEST * (control.cost - lowest))
        near = control.cost - NEAR_BEST * (control.cost - lowest)
        better = [t for t in trials if t.effect and t.cost < level][:FINALISTS]
        found: list[Hypothesis] = []
        for part in ([t for t in better if t.cost <= near], [t for t in better if t.cost > near]):
            if not any(self.rules.is_enough(h.score) for h in found):
                found += self.fits.refit_all([(t.effect,) for t in part], [t.arm for t in part], done, share)
        return found

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

    def _starts(self) -> list[Refit]:
        """Constants from which candidates are tried: the refitted ones, and the nominal ones where the refit did little.

        A refit that cannot explain the data bends the constants out of shape, and an effect tried from there fails.
        """
        if self.accepted or not self._refit_did_little():
            return [self.found]
        unmoved = as_it_is(self.nominal, self.data)
        return [unmoved] if self._helped() > REFIT_FAILS else [self.found, unmoved]

    def _refit_did_little(self) -> bool:
        """Whether the refit of the constants did so little that effects are tried from the nominal ones at once."""
        return self._helped() >= REFIT_HELPS

    def _helped(self) -> float:
        """Return the share of the excess error that the refit of the constants leaves."""
        return excess(self.first.windows) / excess(self.before.windows)

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
            if effect == OFFSET or max(now.score.windows, now.fitted.windows) > AT_NOISE:
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
