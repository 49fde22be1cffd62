"""The fits that a search asks for, in parallel: every effect tried, every effect with all constants, hypotheses refitted."""

from __future__ import annotations

from collections.abc import Sequence

from joblib import Parallel, delayed

from flexarm_env.arm import Arm
from flexarm_env.identify.data import Data
from flexarm_env.identify.hypothesis import (
    Hypothesis,
    asks_for_offset,
    excess,
    fit_briefly,
    fit_from_signature,
    fit_hypothesis,
    try_effect,
)
from flexarm_env.identify.least_squares import in_threads
from flexarm_env.identify.refit import FAR_OFF, Progress, Refit, put_back
from flexarm_env.identify.screen import SMALL, Trial, attempt, best_trials, candidates, first_start, screening_bases, sized

#: Constants that strayed by more standard deviations than this are put back before every effect is fitted briefly with all
#: constants. An effect that then leaves more than this share of what none would leave is dropped; so many are refitted in full.
BENT, BRIEFLY_BETTER, MOST_LOST = 1.0, 0.9, 4
#: A brief fit that leaves so many times what none does began with too large an effect.
TOO_LARGE = 1.03
#: Share of the residual that a constant torque's signature must explain beside an effect for the two to be fitted together.
LEAST_OFFSET = 0.01


class Fits:
    """Fits of an arm to recordings in some processes."""

    def __init__(self, nominal: Arm, data: Data, jobs: int, say: Progress) -> None:
        self.nominal, self.data, self.jobs, self.say = nominal, data, jobs, say

    def screen(self, starts: Sequence[Refit], done: float, share: float) -> list[Trial]:
        """Return every effect tried from some refits, and nothing tried."""
        bases = screening_bases(starts, self.data)
        names = candidates(starts[0].arm)
        tasks = [delayed(try_effect)(base, name) for name in names for base in bases]
        trials = [attempt(bases[0], None)]
        for i, found in enumerate(self._parallel(tasks)):
            trials += found
            self.say(done + share * (i + 1) / len(tasks), f"trying {len(names)} effects")
        return best_trials(trials)

    def refit_all(
        self, effects: Sequence[tuple[str, ...]], arms: Sequence[Arm], done: float, share: float, thorough: bool = False
    ) -> list[Hypothesis]:
        """Return arms refitted with the effects that they have been given; if thorough, from nominal constants as well."""
        pairs = zip(effects, arms, strict=True)
        tasks = [delayed(fit_hypothesis)(e, arm, self.nominal, self.data, thorough) for e, arm in pairs]
        out = []
        for i, hypothesis in enumerate(self._parallel(tasks)):
            out.append(hypothesis)
            self.say(done + share * (i + 1) / len(tasks), f"refitting with {' and '.join(hypothesis.effects)}")
        return out

    def with_all_constants(
        self, found: Refit, trials: list[Trial], tried: Sequence[str], done: float, share: float
    ) -> list[Hypothesis]:
        """Return the best hypotheses when every effect is fitted together with all constants, none of them bent out of shape.

        Constants that made up for the missing effect leave nothing for its signature to explain.
        """
        names = [n for n in candidates(found.arm) if found.arm.known[n].fitted and n not in tried]
        straight = put_back(found, self.nominal, BENT)
        starts = [(n, start) for n in names for start in self._starts_of(n, straight, trials)]
        fits = self._briefly([("", straight), *((n, straight.with_effect(n, **start)) for n, start in starts)], done, 0.5 * share)
        control = fits.pop("")[0]
        for smaller in SMALL:  # with a size of zero an effect would leave what none does: it began too large
            worse = [n for n in names if fits[n][0] > TOO_LARGE * control]
            small = [(n, sized(straight, n, first_start(straight, n, self.data.scales), smaller)) for n in worse]
            again = self._briefly([(n, straight.with_effect(n, **start)) for n, start in small], done + 0.5 * share, 0.1 * share)
            fits |= {n: min(fit, fits[n], key=lambda f: f[0]) for n, fit in again.items()}
        enough = BRIEFLY_BETTER * excess(control)
        better = [(error, name, fitted) for name, (error, fitted) in fits.items() if excess(error) < enough]
        best = sorted(better, key=lambda fit: fit[0])[:MOST_LOST]
        chosen = [f.arm for _, _, f in best]
        far = best[0][0] > FAR_OFF if best else False
        return self.refit_all([(n,) for _, n, _ in best], chosen, done + 0.6 * share, 0.4 * share, thorough=far)

    def _briefly(self, arms: Sequence[tuple[str, Arm]], done: float, share: float) -> dict[str, tuple[float, Refit]]:
        """Return the best brief fit of each effect from some arms, and its error on the fitted part."""
        tasks = [delayed(fit_briefly)(arm, self.nominal, self.data) for _, arm in arms]
        fits: dict[str, tuple[float, Refit]] = {}
        for i, ((name, _), fit) in enumerate(zip(arms, self._parallel(tasks), strict=True)):
            fits[name] = min(fit, fits.get(name, fit), key=lambda f: f[0])
            self.say(done + share * (i + 1) / len(tasks), f"fitting {name or 'nothing'} and all constants")
        return fits

    def _starts_of(self, effect: str, arm: Arm, trials: list[Trial]) -> list[dict[str, float]]:
        """Return what an effect is fitted from: where its trial ended, and its own start if that did not help."""
        control = next(t.cost for t in trials if not t.effect)
        own = [(t.arm.effects[effect], t.cost < control) for t in trials if t.effect == effect]
        first = [] if any(helped for _, helped in own) else [first_start(arm, effect, self.data.scales)]
        return [dict(start) for start, _ in own] + first

    def instead(self, without: Arm, effects: Sequence[str], done: float) -> list[Hypothesis]:
        """Return an arm refitted with each effect, started where it explains most of what the arm leaves."""
        tasks = [delayed(fit_from_signature)(effect, without, self.nominal, self.data) for effect in effects]
        out = []
        for hypothesis in self._parallel(tasks):
            out.append(hypothesis)
            self.say(done, f"refitting with {hypothesis.effects[0]} instead")
        return out

    def with_offset(self, found: list[Hypothesis], done: float, share: float) -> list[Hypothesis]:
        """Return the hypotheses with a constant torque beside each: alone it hides what friction explains, and it them."""
        pairing = self.nominal.known.pairing
        others = [h for h in found if h.effects != (pairing,)]
        asks = self._parallel([delayed(asks_for_offset)(h.refit, self.data) for h in others])
        pairs = [h for h, share in zip(others, asks, strict=True) if share > LEAST_OFFSET]
        absent = self.nominal.known[pairing].null_values()
        arms = [h.refit.arm.with_effect(pairing, **absent) for h in pairs]
        far = min(h.score.windows for h in found) > FAR_OFF
        return self.refit_all([(*h.effects, pairing) for h in pairs], arms, done, share, thorough=far)

    def _parallel(self, tasks):  # type: ignore[no-untyped-def]
        if len(tasks) > 1:
            yield from Parallel(n_jobs=self.jobs, return_as="generator")(tasks)
        for function, positional, named in tasks if len(tasks) == 1 else []:
            with in_threads(self.jobs):
                found = function(*positional, **named)
            yield found
