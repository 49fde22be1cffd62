"""Detection limits: the size up to which an absent effect would go undetected in the recordings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.calibration import Calibration
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.error_measure import error_measure
from flexarm_env.identify.replay.readings import bounded
from flexarm_env.identify.replay.replay import WindowStates
from flexarm_env.identify.select.effect_size import sizeable, smallest_detectable
from flexarm_env.identify.select.signatures import Baseline, baseline

Floats = NDArray[np.float64]


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
    dataset = calibrator.dataset
    with calibrator.workers.threads():
        base = baseline(found, dataset, (dataset.settings.process_noise.detection,))
    begun = error_measure(found.arm).states_before(found.arm, dataset)
    without = _Windows.of(found.arm, dataset, begun)
    names = sizeable(found.arm, dataset)
    limits = calibrator.workers.map([(_limit, (base, name, without, dataset)) for name in names])
    return {name: limit for name, limit in zip(names, limits, strict=True) if limit}


@dataclass(frozen=True)
class _Windows:
    """Held-out readings of an arm in windows, over the noise, where something was measured.

    Attributes:
        readings: (readings,).
        measured: the same of the recordings.
        begun: states before them.
    """

    readings: Floats
    measured: Floats
    begun: Sequence[WindowStates]

    @classmethod
    def of(cls, arm: Arm, dataset: Dataset, begun: Sequence[WindowStates]) -> _Windows:
        """Replay an arm."""
        replayed = np.concatenate(error_measure(arm).brief_readings(arm, dataset, begun))
        measured = np.concatenate([run.measured[~run.train] / dataset.noise for run in dataset.runs])
        there = ~np.isnan(measured)
        return cls(replayed[there], measured[there], begun)

    def rise_to(self, other: _Windows) -> tuple[float, float]:
        """Compute the rise of the squared error to another arm's: the parts that are linear and square in the change."""
        change = bounded(other.readings - self.readings)
        errors = bounded(self.measured - self.readings)
        return float(-2.0 * np.mean(errors * change)), float(np.mean(change**2))


def _limit(base: Baseline, name: str, without: _Windows, dataset: Dataset) -> DetectionLimit | None:
    # An offset of a sensor moves the state itself, which observers follow slowly.
    begun = () if base.arm.known[name].per_sensor else without.begun
    found = smallest_detectable(base, name, lambda arm: without.rise_to(_Windows.of(arm, dataset, begun)))
    if found is None:
        return None
    parameter = base.arm.known[name].parameters[found.key]
    return DetectionLimit(found.key, found.value, parameter.under(base.arm.input).unit)
