"""The comparison of an arm with recordings: errors by part, and the curves."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.display import Shown

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Replay:
    """One recording beside the model's replay of it.

    Attributes:
        name: of the recording.
        time: (samples,) [s].
        measured: (samples,) by signal, SI units.
        free: (samples,) by signal: replayed once from the start.
        windows: (samples,) by signal: replayed in windows of 1 s from estimated states.
        regime: (samples,) 0 stuck, 1 moving slowly, 2 moving fast, from the measured motion.
        closed: (samples,) by signal, and the command by its kind, "current" or "voltage": replayed in closed loop; empty where
            the recording's control loop is not known.
    """

    name: str
    time: Floats
    measured: dict[str, Floats]
    free: dict[str, Floats]
    windows: dict[str, Floats]
    regime: NDArray[np.int64]
    closed: dict[str, Floats] = field(default_factory=dict)


@dataclass(frozen=True)
class Row:
    """One line of a comparison: the errors of one signal in one part of the data.

    Attributes:
        recording: its name, or "all" for all of several taken together.
        signal: its name, or "all".
        part: "all", a regime ("moving fast", "moving slowly", "stuck") or a frequency band ("0-2 Hz", …).
        error: rms error over the noise's standard deviation, in windows of 1 s from estimated states; 1 is perfect.
        free_run: the same, replayed once from the start; NaN for a frequency band.
        fit: 100 (1 − ‖e‖/‖y − ȳ‖) of the free run [%]; NaN where it has no meaning.
        samples: how many samples went in.
    """

    recording: str
    signal: str
    part: str
    error: float
    free_run: float
    fit: float
    samples: int


@dataclass(frozen=True)
class LoopRow:
    """The errors of one quantity of one recording, replayed in closed loop.

    Attributes:
        recording: its name.
        quantity: a signal, or the kind of the command, "current" or "voltage".
        error: rms error over the noise's standard deviation; NaN for the command.
        fit: 100 (1 − ‖e‖/‖y − ȳ‖) [%].
        relative: 100 ‖e‖/‖y‖ [%].
    """

    recording: str
    quantity: str
    error: float
    fit: float
    relative: float


@dataclass(frozen=True)
class Comparison(Shown):
    """An arm against recordings: where it fails.

    Attributes:
        arm: the arm.
        rows: the errors by recording, signal, regime and band.
        replays: the curves.
        noise: standard deviation of each signal's noise, SI units.
        error: rms over noise of everything, in windows of 1 s.
        free_run: the same, replayed once from the start.
        notes: findings of the check of the recordings, a line each (gaps, saturation, poor excitation, the control law).
        closed_loop: the same as free_run, in closed loop where the recordings were made in a known one; None where none was.
        loop_rows: errors in closed loop by recording and quantity.
        rate: samples per second that were kept [Hz], of which the replays are; 0 for all.
    """

    arm: Arm
    rows: list[Row]
    replays: list[Replay]
    noise: dict[str, float]
    error: float
    free_run: float
    notes: list[str] = field(default_factory=list)
    closed_loop: float | None = None
    loop_rows: list[LoopRow] = field(default_factory=list)
    rate: float = 0.0

    def __repr__(self) -> str:
        errors = f"error {self.error:.3g} of the noise in windows, {self.free_run:.3g} in free runs"
        return f"Comparison({self.arm.name!r} against {', '.join(r.name for r in self.replays)}: {errors})"
