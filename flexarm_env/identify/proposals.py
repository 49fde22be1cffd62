"""The hypotheses of one more effect: which candidates are refitted, and from which constants, until one comes near."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexarm_env.identify.acceptance import Acceptance, is_lost
from flexarm_env.identify.fits import Fits
from flexarm_env.identify.hypothesis import Hypothesis
from flexarm_env.identify.problem import Score
from flexarm_env.identify.refit import Refit, as_it_is, with_effects_of
from flexarm_env.identify.screen import Trial

#: How many candidates are refitted in full in each round, and only those that lower the cost of the screening to the first
#: share, by no less than the second of what the best does.
FINALISTS = 4
LEAST_CHANGE, LEAST_OF_BEST = 0.97, 0.3
#: Those that do this share of what the best does are refitted first, the others only if none of them is enough.
NEAR_BEST = 0.6
#: A refit of the constants that leaves less than the first share of the excess error is trusted as a start; one that
#: leaves more than the second is not.
REFIT_HELPS, REFIT_FAILS = 0.2, 0.7


class Proposals:
    """What one more effect could be, after a refit of the constants that left a share of the excess error."""

    def __init__(self, fits: Fits, rules: Acceptance, left: float) -> None:
        self.fits, self.rules, self.left = fits, rules, left

    def screen(self, found: Refit, is_first: bool, done: float, share: float) -> list[Trial]:
        """Return every effect tried beside what was found."""
        return self.fits.screen(self._starts(found, is_first), done, share)

    def nearest(self, trials: list[Trial], done: float, share: float) -> list[Hypothesis]:
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

    def others(
        self,
        hypotheses: list[Hypothesis],
        trials: list[Trial],
        found: Refit,
        best: Score,
        is_first: bool,
        done: float,
        share: float,
    ) -> list[Hypothesis]:
        """Return hypotheses and, where none of them comes near, others from constants that are not bent.

        Args:
            hypotheses: refitted with the candidates that promise most.
            trials: of every effect.
            found: the arm that the effect is sought for.
            best: its errors.
            is_first: whether the arm has been given no effect yet.
            done: share of the search.
            share: of the search that this takes.
        """
        if are_lost(hypotheses, best) and not (is_first and self._refit_did_little()):
            unmoved = as_it_is(with_effects_of(found.arm, self.fits.nominal), self.fits.data)
            others = self.fits.screen([unmoved], done, 0.25 * share)
            hypotheses = self._best_of_each(hypotheses + self.nearest(others, done + 0.25 * share, 0.25 * share))
        if are_lost(hypotheses, best) and is_first:  # a second effect's fits take minutes, with the first in the arm
            tried = [h.effects[0] for h in hypotheses]
            hypotheses += self.fits.with_all_constants(found, trials, tried, done + 0.25 * share, 0.25 * share)
        pairing = found.arm.known.pairing
        lacks = bool(pairing) and pairing not in found.arm.effects
        if lacks and hypotheses and not any(self.rules.is_enough(h.score) for h in hypotheses):
            hypotheses += self.fits.with_offset(hypotheses, done + 0.5 * share, 0.5 * share)
        return hypotheses

    def _starts(self, found: Refit, is_first: bool) -> list[Refit]:
        """Constants from which candidates are tried: the refitted ones, and the nominal ones where the refit did little.

        A refit that cannot explain the data bends the constants out of shape, and an effect tried from there fails.
        """
        if not (is_first and self._refit_did_little()):
            return [found]
        unmoved = as_it_is(self.fits.nominal, self.fits.data)
        return [unmoved] if self.left > REFIT_FAILS else [found, unmoved]

    def _refit_did_little(self) -> bool:
        """Whether the refit of the constants did so little that effects are tried from the nominal ones at once."""
        return self.left >= REFIT_HELPS

    def _best_of_each(self, found: list[Hypothesis]) -> list[Hypothesis]:
        """Return the better of those that say the same."""
        if not found:
            return []
        measure = self.rules.measure_of([h.score for h in found])
        best = {h.effects: h for h in sorted(found, key=lambda h: -measure(h.score))}
        return list(best.values())


def are_lost(found: Sequence[Hypothesis], without: Score) -> bool:
    """Whether none of the hypotheses comes near."""
    return is_lost(min((h.score.windows for h in found), default=np.inf), without)
