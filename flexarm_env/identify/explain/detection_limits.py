"""Detection limits: the size up to which an absent effect would go undetected in the recordings."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.calibration import Calibration
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.error_measure import error_measure
from flexarm_env.identify.select.signatures import Baseline, baseline
from flexarm_env.identify.select.starts import candidates, sized, starts_of
from flexarm_env.identify.settings import DetectionLimits


@dataclass(frozen=True)
class DetectionLimit:
    """The size up to which an effect could be there without raising the error enough to be accepted.

    Attributes:
        parameter: the one that measures the effect's strength.
        value: its largest undetected value, or its smallest where a small value is strong.
        unit: of the value.
    """

    parameter: str
    value: float
    unit: str

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data."""
        return {"parameter": self.parameter, "value": self.value, "unit": self.unit}


def detection_limits(calibrator: Calibrator, found: Calibration) -> dict[str, DetectionLimit]:
    """Estimate the size of each effect that the arm lacks at which it would just be accepted.

    The measure is the rise of the error in windows, less the part that the constants could take over: the share of the
    effect's change of the innovations that lies along their slopes.

    Args:
        calibrator: of the recordings.
        found: the arm that is left in the end.
    """
    dataset, known = calibrator.dataset, found.arm.known
    base = baseline(found, dataset, (dataset.settings.process_noise.detection,))
    before = error_measure(found.arm).brief(found.arm, dataset) ** 2
    names = [
        name
        for name in candidates(found.arm)
        if known[name].fitted and any(p.null is not None for p in known[name].parameters.values())
    ]
    limits = calibrator.workers.map([(_limit, (base, name, before, dataset)) for name in names])
    return {name: limit for name, limit in zip(names, limits, strict=True) if limit}


def _limit(base: Baseline, name: str, before: float, dataset: Dataset) -> DetectionLimit | None:
    """Estimate the size at which one effect would just be accepted; None where no size within its bounds would be."""
    numbers, least = dataset.settings.detection, dataset.settings.selecting.least_removed
    starts = starts_of(base.arm, name, dataset)
    some = starts[:: -(-len(starts) // numbers.most_starts)]
    tried = [_scaled_to(_Size(base, name, start), least / numbers.in_windows) for start in some]
    limit = max(tried, key=lambda one: one.multiple)
    rise = 0.0
    for _ in range(1 if limit.converged else numbers.window_steps):
        change, left = limit.change() if limit.converged else (1.0, 1.0)
        rise = error_measure(limit.arm).brief(limit.arm, dataset) ** 2 - before
        limit = limit.stepped(least, rise * left / max(change, numbers.least_change))
    parameter = base.arm.known[name].parameters[limit.key]
    if rise <= 0.0 or not parameter.low < limit.value < parameter.high:
        return None
    return DetectionLimit(limit.key, limit.value, parameter.unit)


@dataclass(frozen=True)
class _Size:
    """An effect at a multiple of one of its starts.

    Attributes:
        base: the arm that lacks it.
        name: of the effect.
        start: its values at a multiple of 1.
        multiple: of the size.
        converged: whether the innovations give the multiple; windows must where they do not.
    """

    base: Baseline
    name: str
    start: dict[str, float]
    multiple: float = 1.0
    converged: bool = True

    @property
    def key(self) -> str:
        """The parameter that measures the effect's strength."""
        known = self.base.arm.known[self.name].parameters
        return next(key for key, p in known.items() if p.null is not None and self.start[key] != 0.0)

    @property
    def values(self) -> dict[str, float]:
        """Parameters at this multiple."""
        return sized(self.base.arm, self.name, self.start, self.multiple)

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
        """Compute the variance by which the effect changes the innovations, and that which constants cannot take over."""
        change = self.base.change(self.name, self.values)
        left, count = self.base.unexplained(change), self.base.objective.dataset.readings(held_out=False)
        return float(np.sum(change**2) / count), float(np.sum(left**2) / count)

    def stepped(self, wanted: float, rise: float) -> _Size:
        """Scale the size to where a variance that grows with its square is as wanted."""
        factor = math.sqrt(wanted / max(rise, self.numbers.least_change))
        factor = min(max(factor, 1.0 / self.numbers.step_down), self.numbers.step_up)
        return replace(self, multiple=self.multiple * factor)


def _scaled_to(size: _Size, wanted: float) -> _Size:
    """Scale a size until the change of the innovations that constants cannot take over is as wanted.

    An effect with a state of its own changes them however small it is, with the gains of the observer.
    """
    last = math.inf
    for _ in range(size.numbers.steps):
        left = size.change()[1]
        if size.multiple < 1.0 and left > size.numbers.stays * last:
            return replace(size, multiple=1.0, converged=False)
        last, before = left, size.multiple
        size = size.stepped(wanted, left)
        if abs(math.log(size.multiple / before)) < size.numbers.close:
            break
    return size
