"""The noise by which errors are divided: from the arm file where it states one, else from the recordings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.replay.readings import extent
from flexarm_env.identify.settings import Preparation
from flexarm_env.parameters import reading_noise
from flexarm_env.recordings.noise import Noise, Readings, estimate_noise
from flexarm_env.recordings.recording import Recording

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class SensorNoise:
    """The noise of one signal.

    Attributes:
        signal: its name.
        stated: standard deviation of a reading by the arm file; 0 where it is estimated instead.
        found: from the recordings; None where they show none.
        span: range of the signal in the recordings.
        rounding: standard deviation of the rounding to the steps that the arm file states.
    """

    signal: str
    stated: float
    found: Noise | None
    span: float
    rounding: float = 0.0

    def deviation(self, numbers: Preparation) -> float:
        """Standard deviation of a reading, in the signal's unit."""
        if self.stated > 0.0:
            return self.stated
        least = max(numbers.least_noise_share * self.span, numbers.least_noise, self.rounding)
        return max(self.found.total, least) if self.found else max(numbers.default_noise * self.span, least)

    def shown(self, numbers: Preparation) -> float | None:
        """Standard deviation of a reading that the recordings show, in the signal's unit; None where they show none."""
        if self.found is None:
            return None
        return self.found.total if self.stated > 0.0 else self.deviation(numbers)

    def note(self, unit: str, numbers: Preparation) -> str:
        """Describe noise that was estimated, or that disagrees with the arm file; "" otherwise."""
        if self.stated == 0.0:
            return f"{self.signal}: noise {self.deviation(numbers):.3g} {unit}, {self._origin(numbers)}"
        if self.found is None or self.found.total <= 0.0:
            return ""
        ratio, factor = self.found.total / self.stated, numbers.noise_disagrees
        # Readings of a filter scatter more than their white part: the file is wrong only where all scatter is less than it says.
        if ratio <= factor and self.found.at_most * factor >= self.stated:
            return ""
        times = f"{ratio:.2g} times as much" if ratio > 1.0 else f"1/{1.0 / ratio:.2g} of it"
        return (
            f"the arm file says noise {self.stated:.3g} {unit} for {self.signal}, the recordings show "
            f'{self.found.total:.3g} {unit}, {times}: noise = "auto"?'
        )

    def _origin(self, numbers: Preparation) -> str:
        if self.found is None:
            return "a guess: the recordings show none"
        rest, moving = self.found.rest, self.found.moving
        if rest and moving and max(rest, moving) > numbers.motion_adds * min(rest, moving):
            return f"found in the recordings ({rest:.3g} at rest, {moving:.3g} in motion)"
        return "found in the recordings"


#: The noise of sensors by signal.
NoiseBySignal = Mapping[str, SensorNoise]


def find_noise(arm: Arm, recordings: Sequence[Recording], motion: Sequence[Mapping[str, Floats]] = ()) -> NoiseBySignal:
    """Collect the stated noise of each signal of an arm, and estimate it from recordings.

    Args:
        arm: the model.
        recordings: of the machine; each of the arm's signals is in one at least.
        motion: (samples,) replayed readings of each recording by signal, which are subtracted in a second estimate: a command
            under feedback holds noise of the sensors and moves the arm as fast. Motion only adds, so the lower one counts.
    """
    found = {}
    for signal in arm.signals:
        having = [one for one in recordings if signal in one.signals]
        runs = [Readings(one.time, one.signals[signal]) for one in having]
        pairs = zip(recordings, motion, strict=True) if motion else ()
        left = [Readings(one.time, one.signals[signal], moved[signal]) for one, moved in pairs if signal in moved]
        written = reading_noise(arm.sensors[signal])
        stated, rounding = (0.0, written) if signal in arm.auto_noise else (written, 0.0)
        span = float(extent(np.concatenate([run.values for run in runs])))
        found[signal] = SensorNoise(signal, stated, estimate_noise([*runs, *left]), span, rounding)
    return found


def with_found_noise(arm: Arm, noises: Sequence[SensorNoise], numbers: Preparation) -> Arm:
    """Give an arm the noise that was found, where it states none, so that it can be simulated."""
    values: dict[str, float] = {}
    for noise in noises:
        if noise.stated == 0.0:
            values[f"sensors.{noise.signal}.noise"] = noise.deviation(numbers)
            values[f"sensors.{noise.signal}.resolution"] = 0.0  # the deviation holds it
    return replace(arm.with_values(values), auto_noise=())
