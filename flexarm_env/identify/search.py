"""Search for the effects that a model lacks: add the best, refit, and again, until nothing is left or nothing helps."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from joblib import Parallel, delayed

from flexarm_env.arm import Arm
from flexarm_env.identify.data import Data
from flexarm_env.identify.hypothesis import (
    OFFSET,
    Hypothesis,
    asks_for_offset,
    at_bound,
    criterion,
    excess,
    fit_briefly,
    fit_hypothesis,
    in_windows,
    judged,
    measure_of,
    try_effect,
)
from flexarm_env.identify.least_squares import in_threads
from flexarm_env.identify.problem import Score, score
from flexarm_env.identify.refit import FAR_OFF, NEAR, Progress, Refit, as_it_is, polish, put_back, refit, with_effects_of
from flexarm_env.identify.screen import Trial, attempt, best_trials, candidates, first_start, screening_bases

#: How many candidates are refitted in full in each round.
FINALISTS = 4
#: Constants that strayed by more standard deviations than this are put back before every effect is fitted briefly with all
#: constants. One that leaves more than this share of what no effect would leave is dropped.
BENT, BRIEFLY_BETTER = 1.0, 0.9
#: And only those that lower the cost of the screening to the first share, by no less than the second of what the best does.
LEAST_CHANGE, LEAST_OF_BEST = 0.97, 0.3
#: Those that do this share of what the best does are refitted first, the others only if none of them is enough.
NEAR_BEST = 0.6
#: A held-out error below this leaves nothing to explain.
PERFECT = 1.1
#: Least share of the excess error that an effect must remove to be accepted; where a model is far off; and all accepted ones.
LEAST_GAIN, LEAST_GAIN_FAR_OFF, LEAST_TOTAL_GAIN = 0.25, 0.5, 0.7
#: Excess error, as a variance over the noise's, that an effect must remove at least, and as a share of that of the refitted
#: constants: what is left of a large error comes from fits that end early, too.
LEAST_REMOVED, LEAST_OF_FIRST = 0.2, 1e-3
#: Share of the residual that a constant torque's signature must explain beside an effect for the two to be fitted together.
LEAST_OFFSET = 0.01
MOST_EFFECTS = 3
#: Two effects are equivalent if the excess error that they leave differs by less than the first share of what they remove, and
#: by less than one of them leaves, or the second, whichever is more.
SAME_GAIN, SAME_EXCESS = 0.03, 0.1
#: A refit of the constants that leaves less than the first share of the excess error is trusted as a start; one that
#: leaves more than the second is not.
REFIT_HELPS, REFIT_FAILS = 0.2, 0.7


class Search:
    """Forward search: add the best effect, refit, and again, until nothing is left or nothing helps."""

    def __init__(self, nominal: Arm, data: Data, jobs: int, say: Progress) -> None:
        self.nominal, self.data, self.jobs, self.say = nominal, data, jobs, say
        self.noisy = nominal.constants["drive"]["torque_noise"] > 0.0
        self.accepted: list[str] = []
        self.equivalent: list[list[str]] = []
        self.steps: dict[str, Score] = {}
        self.ranking: dict[str, tuple[float, Refit | None]] = {}

    def run(self, base: Refit, before: Score, first: Score) -> None:
        """Search from the refitted constants, given the errors before and after the refit."""
        self.base, self.before, self.first = base, before, first
        self.found, self.best = base, first
        done = 0.1
        while len(self.accepted) < MOST_EFFECTS and self._add_one(done, 0.3):
            done = min(done + 0.3, 0.7)
        self._drop_useless()
        # Where much is missing still, no rival of an offset can be told from another.
        if OFFSET in self.accepted and self.equivalent[self.accepted.index(OFFSET)] == [OFFSET] and self.best.windows <= FAR_OFF:
            self._swap_offset()

    def open_hypotheses(self) -> dict[str, Arm]:
        """Return the arms between which the recordings do not decide, by effect; the arm that is left, where they do."""
        for names in self.equivalent:
            rivals = {name: self.ranking[name][1] for name in names[1:] if name in self.ranking}
            fitted = {name: refitted.arm for name, refitted in rivals.items() if refitted is not None}
            if fitted:
                return {names[0]: self.found.arm, **fitted}
        return {"": self.found.arm}

    def _add_one(self, done: float, share: float) -> bool:
        enough = self._is_enough(self.best)
        if enough and self.ranking:
            return False
        trials = self._screen(done, 0.6 * share)
        if not self.ranking:
            self._rank_screened(trials)
        if enough:
            return False
        control = next(t for t in trials if not t.effect)
        lowest = min(t.cost for t in trials)
        level = min(LEAST_CHANGE * control.cost, control.cost - LEAST_OF_BEST * (control.cost - lowest))
        near = control.cost - NEAR_BEST * (control.cost - lowest)
        better = [t for t in trials if t.effect and t.cost < level][:FINALISTS]
        found: list[Hypothesis] = []
        for part in ([t for t in better if t.cost <= near], [t for t in better if t.cost > near]):
            if not any(self._is_enough(h.score) for h in found):
                found += self._refit_all([(t.effect,) for t in part], [t.arm for t in part], done + 0.5 * share, 0.1 * share)
        best = min((h.score.windows for h in found), default=np.inf)
        lost = best > FAR_OFF or excess(best) > (1.0 - LEAST_TOTAL_GAIN) * excess(self.best.windows)
        if lost and not self.accepted:  # a second effect's fits take minutes, with the first in the arm
            found += self._try_all(trials, [h.effects[0] for h in found], done + 0.6 * share, 0.2 * share)
        if found and not any(self._is_enough(h.score) for h in found):
            found += self._with_offset(found, done + 0.8 * share, 0.2 * share)
        if self.accepted:
            self._go_on()
        if not found:
            return False
        measure = self._measure_of([h.score for h in found])
        found.sort(key=lambda h: measure(h.score))
        for hypothesis in reversed(found):
            gain = 1.0 - measure(hypothesis.score) / measure(self.best)
            if len(hypothesis.effects) == 1:
                self._remember(hypothesis.effects[0], gain, hypothesis.refit)
        possible = [h for h in found if not at_bound(h)]
        return bool(possible) and self._accept(possible)

    def _try_all(self, trials: list[Trial], tried: Sequence[str], done: float, share: float) -> list[Hypothesis]:
        """Return the best hypotheses when every effect is fitted together with all constants, none of them bent out of shape.

        Constants that made up for the missing effect leave nothing for its signature to explain.
        """
        names = [n for n in candidates(self.found.arm) if self.found.arm.known[n].fitted and n not in tried]
        straight = put_back(self.found, self.nominal, BENT)
        starts = [(n, start) for n in names for start in self._starts_of(n, straight, trials)]
        arms = [straight.with_effect(n, **start) for n, start in starts]
        tasks = [delayed(fit_briefly)(arm, self.nominal, self.data) for arm in (straight, *arms)]
        fits: dict[str, tuple[float, Refit]] = {}
        for i, (name, fit) in enumerate(zip(["", *(n for n, _ in starts)], self._parallel(tasks), strict=True)):
            fits[name] = min(fit, fits.get(name, fit), key=lambda f: f[0])
            self.say(done + 0.6 * share * (i + 1) / len(tasks), f"fitting {name or 'nothing'} and all constants")
        control = excess(fits.pop("")[0])
        better = [(error, name, found) for name, (error, found) in fits.items() if excess(error) < BRIEFLY_BETTER * control]
        best = sorted(better, key=lambda fit: fit[0])[:FINALISTS]
        chosen = [f.arm for _, _, f in best]
        far = best[0][0] > FAR_OFF if best else False
        return self._refit_all([(n,) for _, n, _ in best], chosen, done + 0.6 * share, 0.4 * share, thorough=far)

    def _starts_of(self, effect: str, arm: Arm, trials: list[Trial]) -> list[dict[str, float]]:
        """Return what an effect is fitted from: where its trial ended, and its own start if that did not help."""
        control = next(t.cost for t in trials if not t.effect)
        own = [(t.arm.effects[effect], t.cost < control) for t in trials if t.effect == effect]
        first = [] if any(helped for _, helped in own) else [first_start(arm, effect, self.data.scales)]
        return [dict(start) for start, _ in own] + first

    def _accept(self, found: list[Hypothesis]) -> bool:
        """Take the best hypothesis if it removes enough; the simplest of those that remove nearly as much."""
        measure = self._measure_of([h.score for h in found])
        now = measure(self.best)
        singles = [h for h in found if len(h.effects) == 1]
        winner = found[0]
        if len(winner.effects) > 1 and singles:
            ways = (measure, in_windows)  # of models that are far off, one may rest where it should move, and err little
            if not any(self._is_worth(singles[0].score, winner.score, way) for way in ways):
                winner = singles[0]
        removed = now - measure(winner.score)
        if not self._is_worth(self.best, winner.score, measure) or (self.accepted and self._stays_lost(winner.score)):
            return False
        rivals = self._rivals(winner, [h for h in found if len(h.effects) == len(winner.effects)], removed, measure)
        winner, same = rivals[0], [h.effects[0] for h in rivals]
        with in_threads(self.jobs):
            refitted = polish(winner.refit, self.nominal, self.data)
        value = score(refitted.arm, self.data)
        for effect in winner.effects:
            self.accepted.append(effect)
            self.equivalent.append(same if effect == winner.effects[0] else [effect])
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
        again = self._refit_all([h.effects for h in first], arms, 0.7, 0.05)
        order = self._order(winner.score, measure)
        better = [min(pair, key=order) for pair in zip(first, again, strict=True)]
        for hypothesis in better if len(winner.effects) == 1 else []:
            self._remember(hypothesis.effects[0], 1.0 - measure(hypothesis.score) / measure(self.best), hypothesis.refit)
        left = min(measure(h.score) for h in better)
        same = [h for h in better if measure(h.score) <= left + min(SAME_GAIN * removed, max(left, SAME_EXCESS))]
        return sorted(same, key=order)

    def _order(self, best: Score, measure: Callable[[Score], float]) -> Callable[[Hypothesis], float]:
        """Return what rivals are ordered by: all of the data where the best comes near the noise, else what was held out."""
        return (lambda h: criterion(h, self.data)) if best.windows < NEAR[1] else (lambda h: measure(h.score))

    def _measure_of(self, scores: Sequence[Score]) -> Callable[[Score], float]:
        """Return the excess error by which hypotheses are judged; where torque noise is stated, no whole run says anything."""
        return in_windows if self.noisy else measure_of(scores)

    def _least(self, measure: Callable[[Score], float]) -> float:
        """Return the excess error that an effect must remove at least."""
        return max(LEAST_REMOVED, LEAST_OF_FIRST * measure(self.first))

    def _is_enough(self, found: Score) -> bool:
        """Whether an error leaves nothing to explain."""
        return found.windows < PERFECT or excess(found.windows) < self._least(in_windows)

    def _is_worth(self, without: Score, found: Score, measure: Callable[[Score], float]) -> bool:
        """Whether one more effect removes enough of the excess error."""
        removed = measure(without) - measure(found)
        return removed >= max(LEAST_GAIN * measure(without), self._least(measure))

    def _stays_lost(self, found: Score) -> bool:
        """Whether one more effect leaves the model far off without halving its error both in windows and freely replayed.

        What is missing then is something else, which a flexible enough effect imitates where it was fitted.
        """
        pairs = ((found.windows, self.best.windows), (found.free_run, self.best.free_run))
        return found.windows > FAR_OFF and any(excess(new) > (1.0 - LEAST_GAIN_FAR_OFF) * excess(old) for new, old in pairs)

    def _with_offset(self, found: list[Hypothesis], done: float, share: float) -> list[Hypothesis]:
        """Return the hypotheses with a constant torque beside each: alone it hides what friction explains, and it them."""
        if OFFSET in self.found.arm.effects:
            return []
        others = [h for h in found if h.effects != (OFFSET,)]
        asks = self._parallel([delayed(asks_for_offset)(h.refit, self.data) for h in others])
        pairs = [h for h, share in zip(others, asks, strict=True) if share > LEAST_OFFSET]
        arms = [h.refit.arm.with_effect(OFFSET, torque=0.0) for h in pairs]
        far = min(h.score.windows for h in found) > FAR_OFF
        return self._refit_all([(*h.effects, OFFSET) for h in pairs], arms, done, share, thorough=far)

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

    def _screen(self, done: float, share: float) -> list[Trial]:
        bases = screening_bases(self._starts(), self.data)
        names = candidates(self.found.arm)
        tasks = [delayed(try_effect)(base, name) for name in names for base in bases]
        trials = [attempt(bases[0], None)]
        for i, found in enumerate(self._parallel(tasks)):
            trials += found
            self.say(done + share * (i + 1) / len(tasks), f"trying {len(names)} effects")
        return best_trials(trials)

    def _starts(self) -> list[Refit]:
        """Constants from which candidates are tried: the refitted ones, and the nominal ones where the refit did little.

        A refit that cannot explain the data bends the constants out of shape, and an effect tried from there fails.
        """
        helped = excess(self.first.windows) / excess(self.before.windows)
        if self.accepted or helped < REFIT_HELPS:
            return [self.found]
        unmoved = as_it_is(self.nominal, self.data)
        return [unmoved] if helped > REFIT_FAILS else [self.found, unmoved]

    def _refit_all(
        self, effects: Sequence[tuple[str, ...]], arms: Sequence[Arm], done: float, share: float, thorough: bool = False
    ) -> list[Hypothesis]:
        pairs = zip(effects, arms, strict=True)
        tasks = [delayed(fit_hypothesis)(e, arm, self.nominal, self.data, thorough) for e, arm in pairs]
        out = []
        for i, hypothesis in enumerate(self._parallel(tasks)):
            out.append(hypothesis)
            self.say(done + share * (i + 1) / len(tasks), f"refitting with {' and '.join(hypothesis.effects)}")
        return out

    def _parallel(self, tasks):  # type: ignore[no-untyped-def]
        if len(tasks) > 1:
            yield from Parallel(n_jobs=self.jobs, return_as="generator")(tasks)
        for function, positional, named in tasks if len(tasks) == 1 else []:
            with in_threads(self.jobs):
                found = function(*positional, **named)
            yield found

    def _drop_useless(self) -> None:
        """Take out an effect that the later ones have made needless."""
        for effect in list(self.accepted) if len(self.accepted) > 1 else []:
            without = refit(self.found.arm.without_effect(effect), self.nominal, self.data)
            value = score(without.arm, self.data)
            measure = self._measure_of([value, self.best])
            if not self._is_worth(value, self.best, measure):
                self.found, self.best = without, value
                place = self.accepted.index(effect)
                del self.accepted[place], self.equivalent[place], self.steps[effect]

    def _swap_offset(self) -> None:
        """Put what a constant torque is confused with in its place, which came in beside another effect, untried."""
        place = self.accepted.index(OFFSET)
        without = self.found.arm.without_effect(OFFSET)
        lacking = candidates(without)
        rivals = [(name,) for name in without.known[OFFSET].confused_with if name in lacking]
        arms = [without.with_effect(name) for (name,) in rivals]
        found = self._refit_all(rivals, arms, 0.9, 0.05, thorough=False)
        found = [h for h in found if not at_bound(h)]
        measure = self._measure_of([self.best, *(h.score for h in found)])
        level = measure(self.best) + SAME_GAIN * (measure(self.first) - measure(self.best))
        order = self._order(self.best, measure)
        best = min(found, key=order, default=None)
        same = [h.effects[0] for h in found if measure(h.score) <= level]
        least = LEAST_GAIN if self.best.windows >= NEAR[1] else 0.0
        if best is None or order(best) >= (1.0 - least) * order(judged(tuple(self.accepted), self.found, self.data)):
            self.equivalent[place] += same
            return
        name = best.effects[0]
        near = measure(best.score) + SAME_GAIN * (measure(self.first) - measure(best.score))
        also = [OFFSET] if measure(self.best) <= near else []
        self.found, self.best, self.accepted[place] = best.refit, best.score, name
        self.equivalent[place] = [name, *also, *(other for other in same if other != name)]
        self.steps[name] = best.score
        del self.steps[OFFSET]
