"""How much of the error an effect must remove to be worth having."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from flexarm_env.identify.hypothesis import excess, in_windows, measure_of
from flexarm_env.identify.problem import Score
from flexarm_env.identify.refit import FAR_OFF

#: A held-out error below this leaves nothing to explain.
PERFECT = 1.1
#: A model whose held-out errors in windows and freely replayed end below these is whole, whatever share was removed.
WHOLE, WHOLE_FREE_RUN = 1.2, 1.5
#: Least share of the excess error that an effect must remove to be accepted; where a model is far off; and all accepted ones.
LEAST_GAIN, LEAST_GAIN_FAR_OFF, LEAST_TOTAL_GAIN = 0.25, 0.5, 0.7
#: Least share that all accepted ones must remove in windows where the model ends near the noise: true effects go all the way.
LEAST_TOTAL_GAIN_NEAR = 0.95
#: Excess error, as a variance over the noise's, that an effect must remove at least, and as a share of that of the refitted
#: constants: what is left of a large error comes from fits that end early, too.
LEAST_REMOVED, LEAST_OF_FIRST = 0.2, 1e-3


class Acceptance:
    """The rules, for recordings on which the refitted constants leave some error."""

    def __init__(self, first: Score, noisy: bool) -> None:
        self.first, self.noisy = first, noisy

    def measure_of(self, scores: Sequence[Score]) -> Callable[[Score], float]:
        """Return the excess error by which hypotheses are judged; where torque noise is stated, no whole run says anything."""
        return in_windows if self.noisy else measure_of(scores)

    def least(self, measure: Callable[[Score], float]) -> float:
        """Return the excess error that an effect must remove at least."""
        return max(LEAST_REMOVED, LEAST_OF_FIRST * measure(self.first))

    def is_enough(self, found: Score) -> bool:
        """Whether an error leaves nothing to explain."""
        return found.windows < PERFECT or excess(found.windows) < self.least(in_windows)

    def is_worth(self, without: Score, found: Score, measure: Callable[[Score], float]) -> bool:
        """Whether one more effect removes enough of the excess error."""
        removed = measure(without) - measure(found)
        return removed >= max(LEAST_GAIN * measure(without), self.least(measure))

    def explains(self, found: Score) -> bool:
        """Whether what was found leaves nothing to explain, or explains seconds and whole runs alike, as true effects do.

        What imitates another effect often does in only one of the two, or stops short of the noise. Where torque noise is
        stated, no free run says anything.
        """
        share = LEAST_TOTAL_GAIN if found.windows > FAR_OFF else LEAST_TOTAL_GAIN_NEAR
        errors = [(self.first.windows, found.windows, WHOLE, share)]
        if not self.noisy:
            errors.append((self.first.free_run, found.free_run, WHOLE_FREE_RUN, LEAST_TOTAL_GAIN))
        return all(new <= whole or excess(new) <= (1.0 - least) * excess(old) for old, new, whole, least in errors)

    def is_whole(self, found: Score) -> bool:
        """Whether what was found explains the data and leaves hardly more than noise: what is imitated is not."""
        near = found.windows < WHOLE and excess(found.windows) < (1.0 - LEAST_TOTAL_GAIN_NEAR) * excess(self.first.windows)
        return (near or found.windows < PERFECT) and self.explains(found)


def is_lost(best: float, without: Score) -> bool:
    """Whether the best error in windows that was found is far off, or leaves most of what there was without."""
    return best > FAR_OFF or excess(best) > (1.0 - LEAST_TOTAL_GAIN) * excess(without.windows)


def stays_lost(found: Score, without: Score) -> bool:
    """Whether one more effect leaves the model far off without halving its error both in windows and freely replayed.

    What is missing then is something else, which a flexible enough effect imitates where it was fitted.
    """
    pairs = ((found.windows, without.windows), (found.free_run, without.free_run))
    return found.windows > FAR_OFF and any(excess(new) > (1.0 - LEAST_GAIN_FAR_OFF) * excess(old) for new, old in pairs)
