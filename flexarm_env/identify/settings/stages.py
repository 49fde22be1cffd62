"""All stages of the method together, and the settings of published results."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from flexarm_env.identify.settings.calibrating import Calibrating, ForecastFit, Intervals, LeastSquares, Parameters, Refining
from flexarm_env.identify.settings.error_scale import ErrorScale
from flexarm_env.identify.settings.explaining import DetectionLimits, ExcitationLimits, Explaining, Probabilities
from flexarm_env.identify.settings.initial_states import InitialStates
from flexarm_env.identify.settings.inspecting import Inspecting
from flexarm_env.identify.settings.motion_faults import MotionFaults
from flexarm_env.identify.settings.number import Number
from flexarm_env.identify.settings.observing import Forecasts, Observers, ProcessNoise
from flexarm_env.identify.settings.recordings import Preparation, ReferenceSizes, Thinning
from flexarm_env.identify.settings.searching import ForecastSearching, Promising, Proposing, Screening, Selecting


@dataclass(frozen=True)
class Settings:
    """Every tuned number of the method, by stage.

    Example:
        >>> from dataclasses import replace
        >>> settings = Settings()
        >>> settings.errors.far_off
        3.0
        >>> replace(settings, errors=replace(settings.errors, far_off=4.0)).errors.far_off
        4.0
    """

    errors: ErrorScale = field(default_factory=ErrorScale)
    preparation: Preparation = field(default_factory=Preparation)
    thinning: Thinning = field(default_factory=Thinning)
    reference: ReferenceSizes = field(default_factory=ReferenceSizes)
    initial_states: InitialStates = field(default_factory=InitialStates)
    process_noise: ProcessNoise = field(default_factory=ProcessNoise)
    observers: Observers = field(default_factory=Observers)
    forecasts: Forecasts = field(default_factory=Forecasts)
    forecast_fit: ForecastFit = field(default_factory=ForecastFit)
    promising: Promising = field(default_factory=Promising)
    forecast_searching: ForecastSearching = field(default_factory=ForecastSearching)
    parameters: Parameters = field(default_factory=Parameters)
    least_squares: LeastSquares = field(default_factory=LeastSquares)
    calibrating: Calibrating = field(default_factory=Calibrating)
    refining: Refining = field(default_factory=Refining)
    intervals: Intervals = field(default_factory=Intervals)
    screening: Screening = field(default_factory=Screening)
    proposing: Proposing = field(default_factory=Proposing)
    selecting: Selecting = field(default_factory=Selecting)
    probabilities: Probabilities = field(default_factory=Probabilities)
    detection: DetectionLimits = field(default_factory=DetectionLimits)
    excitation: ExcitationLimits = field(default_factory=ExcitationLimits)
    explaining: Explaining = field(default_factory=Explaining)
    inspecting: Inspecting = field(default_factory=Inspecting)
    motion: MotionFaults = field(default_factory=MotionFaults)

    def numbers(self) -> Iterator[Number]:
        """Yield every number with its stage, meaning and origin."""
        for stage in dataclasses.fields(self):
            values = getattr(self, stage.name)
            for number in dataclasses.fields(values):
                facts = number.metadata
                value = getattr(values, number.name)
                yield Number(stage.name, number.name, value, facts["unit"], facts["meaning"], facts["found"])

    def as_json(self) -> dict[str, dict[str, Any]]:
        """Convert to plain data: the value of each number by stage and name."""
        return {stage: dict(values) for stage, values in dataclasses.asdict(self).items()}

    def digest(self) -> str:
        """Compute the first 12 hexadecimal digits of the SHA-256 of the numbers as JSON, by which results name their settings.

        Example:
            >>> Settings().digest() == SETTINGS.digest()
            True
        """
        numbers = json.dumps(self.as_json(), sort_keys=True)
        return hashlib.sha256(numbers.encode()).hexdigest()[:12]


#: The settings of every published result.
SETTINGS = Settings()
