"""How probable each named effect is: as often as answers of its kind were right on machines whose effects are known."""

from __future__ import annotations

from collections.abc import Sequence

from flexarm_env.identify.settings import Probabilities


def probabilities(equivalent: Sequence[Sequence[str]], left: float, numbers: Probabilities) -> list[list[float]]:
    """Estimate the probability that a machine has each named effect.

    Args:
        equivalent: for each accepted effect all that the recordings cannot tell from it, itself first.
        left: share of the excess that is left; 0 where that is only noise.
        numbers: shares of right answers.

    Returns:
        A probability for each name, in the same order.

    Example:
        >>> alone, equals = probabilities([["coulomb"], ["cogging", "position_friction"]], 0.0, Probabilities())
        >>> alone, [round(one, 2) for one in equals]
        ([0.98], [0.9, 0.08])
    """
    every = numbers.explained if left == 0.0 else numbers.mostly if left < numbers.little else numbers.partly
    return [_shared(every, len(names), numbers.first) for names in equivalent]


def _shared(every: float, count: int, first: float) -> list[float]:
    if count == 1:
        return [every]
    return [every * first, *[every * (1.0 - first) / (count - 1)] * (count - 1)]
