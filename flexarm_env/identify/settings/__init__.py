"""Every tuned number of the method: its value, its meaning, and how it was found.

One frozen dataclass per stage; `Settings` holds them all. Results carry the settings under which they were made, and
`flexarm diagnose --settings` prints them. Errors are rms over the noise, so that 1 is perfect; an excess is a variance over that
of the noise, less 1.

In the origins of values, seeds and cases such as `null-38` are those of the benchmark of hidden effects, and EMPS, `thesis` and
`cu-flexible` are shipped arms. "No sweep recorded" means that the value was tried on the cases named, and no other is on record.
"""

from __future__ import annotations

from flexarm_env.identify.settings.calibrating import Calibrating, ForecastFit, Intervals, LeastSquares, Parameters, Refining
from flexarm_env.identify.settings.error_scale import ErrorScale
from flexarm_env.identify.settings.explaining import DetectionLimits, ExcitationLimits, Explaining, Probabilities
from flexarm_env.identify.settings.guards import (
    FAILED_ERROR,
    LARGEST_LOG,
    LEAST_COMMAND,
    LEAST_COUNT,
    LEAST_EXCESS,
    LEAST_FREQUENCY,
    LEAST_NORM,
)
from flexarm_env.identify.settings.initial_states import InitialStates
from flexarm_env.identify.settings.inspecting import Inspecting
from flexarm_env.identify.settings.motion_faults import MotionFaults
from flexarm_env.identify.settings.number import Number
from flexarm_env.identify.settings.observing import Forecasts, Observers, ProcessNoise
from flexarm_env.identify.settings.recordings import Preparation, ReferenceSizes, Thinning
from flexarm_env.identify.settings.searching import ForecastSearching, Promising, Proposing, Screening, Selecting
from flexarm_env.identify.settings.stages import SETTINGS, Settings

__all__ = [
    "FAILED_ERROR",
    "LARGEST_LOG",
    "LEAST_COMMAND",
    "LEAST_COUNT",
    "LEAST_EXCESS",
    "LEAST_FREQUENCY",
    "LEAST_NORM",
    "SETTINGS",
    "Calibrating",
    "DetectionLimits",
    "ErrorScale",
    "ExcitationLimits",
    "Explaining",
    "ForecastFit",
    "ForecastSearching",
    "Forecasts",
    "InitialStates",
    "Inspecting",
    "Intervals",
    "LeastSquares",
    "MotionFaults",
    "Number",
    "Observers",
    "Parameters",
    "Preparation",
    "Probabilities",
    "ProcessNoise",
    "Promising",
    "Proposing",
    "ReferenceSizes",
    "Refining",
    "Screening",
    "Selecting",
    "Settings",
    "Thinning",
]
