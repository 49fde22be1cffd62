"""The size at which an effect would just be accepted, with what the constants could take over projected out."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.objective import ObserverBank
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.select.signatures import Baseline
from flexarm_env.identify.select.starts import candidates, sized, some_starts_of
from flexarm_env.identify.settings import DetectionLimits

#: Rise of the squared error over noise in windows that an arm with one effect more makes: the part that grows with the effect's
#: size, and the part that grows with its square.
Rise = Callable[[Arm], tuple[float, float]]


@dataclass(frozen=True)
class EffectSize:
    """An effect at a multiple of one of its starts.

    Attributes:
        base: the arm that lacks it.
        name: of the effect.
        start: its values at a multiple of 1.
        multiple: of the size.
        low: largest multiple that is known to be too small.
        high: smallest multiple that is known to be large enough.
    """

    base: Baseline
    name: str
    start: dict[str, float]
    multiple: float = 1.0
    low: float = 0.0
    high: float = math.inf

    @property
    def key(self) -> str:
        """The parameter that measures the effect's strength."""
        known = self.base.arm.known[self.name].parameters
        return next(key for key, p in known.items() if p.null is not None and self.start[key] != 0.0)

    @property
    def values(self) -> dict[str, float]:
        """Parameters at this multiple."""
        return sized(self.base.arm, self.name, self.start, self.multiple, self.base.objective.dataset)

    @property
    def value(self) -> float:
        """The present size."""
        return abs(self.values[self.key])

    @property
    def arm(self) -> Arm:
        """The arm with the effect."""
        return self.base.arm.with_effect(self.name, **self.values)

    @property
    def numbers(self) -> DetectionLimits:
        """Numbers of the steps."""
        return self.base.objective.dataset.settings.detection

    def change(self) -> tuple[float, float]:
        """Compute the variance by which the effect changes the innovations, and that which constants cannot take over.

        Each size has observers of its own: those of a large effect would change the innovations of a small one.
        """
        objective = replace(self.base.objective, observers=ObserverBank())
        change = objective.residual_of(self.arm) - self.base.residual
        left, count = self.base.unexplained(change), objective.dataset.readings(held_out=False)
        return float(np.sum(change**2) / count), float(np.sum(left**2) / count)

    def stepped(self, wanted: float, square: float, linear: float = 0.0) -> EffectSize:
        """Scale the size to where a variance is as wanted, or half way between known sizes.

        A limit of the command or a stiff joint has no such growth: up to some size it changes nothing.

        Args:
            wanted: the variance.
            square: the part of the present one that grows with the size's square.
            linear: the part that grows with the size.
        """
        half, most = 0.5 * linear, max(square, self.numbers.least_change)
        root = math.sqrt(half**2 + most * wanted)
        factor = wanted / (root + half) if half > 0.0 else (root - half) / most  # so that nothing cancels
        multiple = self.multiple * min(max(factor, 1.0 / self.numbers.step_down), self.numbers.step_up)
        low, high = (self.multiple, self.high) if square + linear < wanted else (self.low, self.multiple)
        if not low <= multiple <= high:
            multiple = math.sqrt(low * high) if low > 0.0 else high
        return replace(self, multiple=multiple, low=low, high=high)

    @property
    def is_bracketed(self) -> bool:
        """Whether a smaller size is known to be too small and a larger one large enough."""
        return self.low > 0.0 and self.high < math.inf

    def is_near(self, other: EffectSize) -> bool:
        """Whether another size is so near that no further step is worth its replays; nearer, where both sides are known."""
        numbers = self.numbers
        most = numbers.close if self.is_bracketed else math.log(numbers.step_up) - numbers.close
        return abs(math.log(self.multiple / other.multiple)) < most


def sizeable(arm: Arm, dataset: Dataset) -> list[str]:
    """List the effects that an arm could lack and that have a size."""
    known = arm.known
    return [
        name
        for name in candidates(arm, dataset)
        if known[name].fitted and any(p.null is not None for p in known[name].parameters.values())
    ]


def smallest_detectable(base: Baseline, name: str, rise_of: Rise) -> EffectSize | None:
    """Estimate the size at which one effect would just be accepted; None where no size within its bounds would be.

    Args:
        base: the arm that lacks it.
        name: of the effect.
        rise_of: measures what the effect does to the error in windows.
    """
    dataset = base.objective.dataset
    numbers, least = dataset.settings.detection, dataset.settings.selecting.least_removed
    sizes = [EffectSize(base, name, start, numbers.first) for start in some_starts_of(base.arm, name, dataset)]
    size, share = _by_innovations(sizes, least / numbers.in_windows)
    found = _by_windows(size, least, share, rise_of)
    if found is None:
        return None
    parameter = base.arm.known[name].parameters[found.key]
    return found if parameter.low < found.value < parameter.high else None


def _by_innovations(sizes: Sequence[EffectSize], wanted: float) -> tuple[EffectSize, float]:
    """Scale the size that shows least until the change of the innovations that constants cannot take over is as wanted.

    An effect with a state of its own changes them however small it is, with the gains of the observer. It keeps its first size.

    Args:
        sizes: the same multiple of each of the effect's starts.
        wanted: the variance.

    Returns:
        The size, and the share of its change that constants cannot take over; 1 where innovations do not give the size.
    """
    changes = [size.change() for size in sizes]
    first, (change, left) = min(zip(sizes, changes, strict=True), key=lambda pair: pair[1][1])
    size, share, still = first, 1.0, 0.0
    for step in range(1, first.numbers.steps + 1):
        if change > first.numbers.least_change:
            share = left / change
        else:
            still = max(still, size.multiple)
        before, size = size, size.stepped(wanted, left)
        if step == first.numbers.steps or size.is_near(before):
            break
        last, (change, left) = left, size.change()
        if size.multiple < before.multiple and left > first.numbers.stays * last:
            return first, 1.0
    return replace(size, low=still, high=math.inf), share


def _by_windows(size: EffectSize, wanted: float, share: float, rise_of: Rise) -> EffectSize | None:
    """Correct a size by the rise of the error in windows, until a correction is small; None where it never rises.

    A size below which the error no longer falls is kept: smaller ones are not resolved, as of a compliance.
    """
    before, last, rises = size, math.inf, False
    for _ in range(size.numbers.window_steps):
        linear, square = rise_of(size.arm)
        rise = linear + square
        if size.multiple < before.multiple and rise >= last:
            return before
        rises = rises or rise > 0.0
        before, last, size = size, rise, size.stepped(wanted, share * square, share * linear)
        if size.is_near(before):
            break
    return size if rises else None
