"""Detection limits: the size up to which an absent effect would go undetected in the recordings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from flexarm_env.identify.calibrate.calibration import Calibration
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.error_measure import error_measure
from flexarm_env.identify.select.effect_size import sizeable, smallest_detectable
from flexarm_env.identify.select.signatures import Baseline, baseline


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
    base = baseline(found, dataset, (dataset.settings.process_noise.detection,))
    before = error_measure(found.arm).brief(found.arm, dataset) ** 2
    names = sizeable(found.arm)
    limits = calibrator.workers.map([(_limit, (base, name, before, dataset)) for name in names])
    return {name: limit for name, limit in zip(names, limits, strict=True) if limit}


def _limit(base: Baseline, name: str, before: float, dataset: Dataset) -> DetectionLimit | None:
    found = smallest_detectable(base, name, lambda arm: error_measure(arm).brief(arm, dataset) ** 2 - before)
    return None if found is None else DetectionLimit(found.key, found.value, base.arm.known[name].parameters[found.key].unit)
