"""The figures by which publishers judge a model of their rig, of any arm on any recordings of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.explain.compare import compare
from flexarm_env.identify.explain.comparison import Replay
from flexarm_env.recordings.recording import Recording
from flexarm_env.rigs.inverse import Recipe, predicted_and_recorded

Floats = NDArray[np.float64]


class Metric(Protocol):
    """A figure of an arm on recordings."""

    @property
    def unit(self) -> str:
        """Of the figure."""
        ...

    @property
    def words(self) -> str:
        """Describe the figure."""
        ...

    @property
    def higher_is_better(self) -> bool:
        """Whether a better model has the larger figure."""
        ...

    def of(self, arm: Arm, recordings: Sequence[Recording]) -> float:
        """Compute the figure."""
        ...


@dataclass(frozen=True)
class CommandError:
    """Error of the command by inverse dynamics, of the measured motion, as regressions have it.

    Attributes:
        recipe: by which motion and command are filtered.
        unit: "%" for 100 ‖e‖/‖command‖, else that of the command, of the rms error.
    """

    recipe: Recipe
    unit: str = "%"
    higher_is_better: ClassVar[bool] = False

    @property
    def words(self) -> str:
        """Describe the figure."""
        return f"{'relative' if self.unit == '%' else 'rms'} error of the command, by inverse dynamics"

    def of(self, arm: Arm, recordings: Sequence[Recording]) -> float:
        """Compute the figure over all samples."""
        pairs = [predicted_and_recorded(arm, recording, self.recipe) for recording in recordings]
        predicted, recorded = (np.concatenate(part) for part in zip(*pairs, strict=True))
        error = float(np.linalg.norm(recorded - predicted))
        return 100.0 * error / float(np.linalg.norm(recorded)) if self.unit == "%" else error / float(np.sqrt(len(recorded)))


@dataclass(frozen=True)
class SignalFit:
    """Fit 100 (1 − ‖e‖/‖y − ȳ‖) [%] of a signal, the least of all recordings.

    Attributes:
        signal: its name.
        closed: whether it is replayed in closed loop; else once, under the recorded command.
    """

    signal: str = "arm_angle"
    closed: bool = False
    unit: ClassVar[str] = "%"
    higher_is_better: ClassVar[bool] = True

    @property
    def words(self) -> str:
        """Describe the figure."""
        return f"fit of {self.signal.replace('_', ' ')}, {'in closed loop' if self.closed else 'one free run'}"

    def of(self, arm: Arm, recordings: Sequence[Recording]) -> float:
        """Compute the figure."""
        fits = []
        for measured, modelled in _modelled(arm, recordings, self.signal, self.closed):
            spread = float(np.linalg.norm(measured - measured.mean()))
            fits.append(100.0 * (1.0 - float(np.linalg.norm(measured - modelled)) / spread))
        return min(fits)


@dataclass(frozen=True)
class AngleError:
    """Error of the arm's angle in one free run from the recording's first state [rad], the mean of all recordings.

    Attributes:
        mean_absolute: whether it is the mean absolute error; else the rms error.
    """

    mean_absolute: bool = False
    unit: ClassVar[str] = "rad"
    higher_is_better: ClassVar[bool] = False

    @property
    def words(self) -> str:
        """Describe the figure."""
        return f"{'mean absolute' if self.mean_absolute else 'rms'} error of the angle, one free run"

    def of(self, arm: Arm, recordings: Sequence[Recording]) -> float:
        """Compute the figure."""
        errors = [measured - modelled for measured, modelled in _modelled(arm, recordings, "arm_angle", closed=False)]
        if self.mean_absolute:
            return float(np.mean([np.mean(np.abs(error)) for error in errors]))
        return float(np.mean([np.sqrt(np.mean(error**2)) for error in errors]))


def _modelled(arm: Arm, recordings: Sequence[Recording], signal: str, closed: bool) -> Iterator[tuple[Floats, Floats]]:
    """Yield the readings of a signal, and the model's beside them, of each recording."""
    for replay in compare(arm, recordings).replays:
        measured, modelled = replay.measured[signal], _replayed(replay, closed)[signal]
        there = ~np.isnan(measured)
        yield measured[there], modelled[there]


def _replayed(replay: Replay, closed: bool) -> dict[str, Floats]:
    if closed and not replay.closed:
        raise ValueError(f"{replay.name} was not replayed in closed loop")
    return replay.closed if closed else replay.free
