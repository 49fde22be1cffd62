"""The noise by which errors are divided: from the arm file where it states one, else from the recordings."""

from __future__ import annotations

from collections.abc import Sequence
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


def find_noise(arm: Arm, recordings: Sequence[Recording], motion: Sequence[Floats] | None = None) -> tuple[SensorNoise, ...]:
    """Collect the stated noise of each signal of an arm, and estimate it from recordings.

    Args:
        arm: the model.
        recordings: of the machine, with all the arm's signals.
        motion: (samples, signals) replayed readings of each recording, which are subtracted in a second estimate: a command
            under feedback holds noise of the sensors and moves the arm as fast. Motion only adds, so the lower one counts.
    """
    found = []
    for i, signal in enumerate(arm.signals):
        runs = [Readings(r.time, r.signals[signal]) for r in recordings]
        if motion is not None:
            runs += [replace(run, motion=replayed[:, i]) for run, replayed in zip(runs, motion, strict=True)]
        written = reading_noise(arm.sensors[signal])
        stated, rounding = (0.0, written) if signal in arm.auto_noise else (written, 0.0)
        span = float(extent(np.concatenate([run.values for run in runs])))
        found.append(SensorNoise(signal, stated, estimate_noise(runs), span, rounding))
    return tuple(found)


def is_open(noises: Sequence[SensorNoise], numbers: Preparation) -> bool:
    """Whether the noise of a signal is not stated, or disagrees with the arm file."""
    return any(noise.note("", numbers) for noise in noises)


def with_found_noise(arm: Arm, noises: Sequence[SensorNoise], numbers: Preparation) -> Arm:
    """Give an arm the noise that was found, where it states none, so that it can be simulated."""
    values: dict[str, float] = {}
    for noise in noises:
        if noise.stated == 0.0:
            values[f"sensors.{noise.signal}.noise"] = noise.deviation(numbers)
            values[f"sensors.{noise.signal}.resolution"] = 0.0  # the deviation holds it
    return replace(arm.with_values(values), auto_noise=())
