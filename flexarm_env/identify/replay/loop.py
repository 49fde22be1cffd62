"""The control loop of a run: its law with the recording's gains, checked against the recorded command."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.control.law import FOLLOWS, ControlLaw, RunningLaw
from flexarm_env.control.table import odd_units
from flexarm_env.identify.settings import Preparation
from flexarm_env.recordings.recording import Recording

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Loop:
    """The control law of a run, and its reference.

    Attributes:
        law: with numbers as gains.
        columns: of its signals among the measured ones.
        reference: (samples,) [rad].
        law_error: ‖u − law‖ / ‖u‖ of the recorded command u, where the law is fed with the recorded signals.
        lag: by which u follows the law [s].
        late_error: the same error of the law, late by that lag.
    """

    law: ControlLaw
    columns: tuple[int, ...]
    reference: Floats
    law_error: float = 0.0
    lag: float = 0.0
    late_error: float = 0.0

    def first(self, count: int) -> Loop:
        """Cut the reference down to its first samples."""
        return replace(self, reference=self.reference[:count])

    def start_law(self, readings: Floats, speed: float, interval: float, command: float) -> RunningLaw:
        """Start the law at the first readings (signals,).

        Args:
            readings: SI units.
            speed: of the arm's angle before them [rad/s].
            interval: sampling time [s].
            command: before the first one [A or V].
        """
        slopes = [speed if signal == FOLLOWS else 0.0 for signal in self.law.signals]
        return self.law.start(interval, [float(readings[column]) for column in self.columns], slopes, command)


def find_loop(
    arm: Arm, recording: Recording, signals: Sequence[str], speed: float, numbers: Preparation
) -> tuple[Loop | None, str]:
    """Find the loop of a recording with a reference, where a law is stated for it.

    Args:
        arm: its law serves where the recording's column map states none.
        recording: with the conditions that gains name.
        signals: that are compared; the law may use no other.
        speed: of the arm's angle at the start [rad/s].
        numbers: of the method.

    Returns:
        The loop, or None; and a note on the law, or on the reason why there is no loop, else "".
    """
    stated = recording.controller or arm.controller
    if stated is None or recording.reference is None:
        return None, ""
    law = stated.with_conditions(recording.conditions)
    if law.conditions:
        names = " and ".join(law.conditions)
        return (
            None,
            f"not replayed in closed loop: the control law needs {names}, a line such as '# {law.conditions[0]} = 1' each",
        )
    absent = [signal for signal in law.signals if signal not in signals]
    if absent:
        return None, f"not replayed in closed loop: the control law needs {' and '.join(absent)}, which not all recordings have"
    law = replace(law, limit=law.limit or arm.constants["drive"]["limit"])
    loop = Loop(law, tuple(signals.index(signal) for signal in law.signals), recording.reference)
    interval = recording.sample_time
    measured = np.stack([recording.signals[signal] for signal in signals], axis=1)
    commands = law_commands(loop, measured, speed, interval, float(recording.command[0]))
    error, lag, late = compare_commands(recording.command, commands, round(numbers.longest_lag / interval))
    loop = replace(loop, law_error=error, lag=lag * interval, late_error=late)
    note = _law_note(loop, recording)
    if late > numbers.largest_law_error:
        odd = odd_units(stated, recording.conditions, recording.input_kind)
        reason = f": is a unit wrong? {odd}" if odd else ""
        return None, f"{note}; it is not that of the recording, which is not replayed in closed loop{reason}"
    return loop, note


def law_commands(loop: Loop, measured: Floats, speed: float, interval: float, before: float) -> Floats:
    """Compute the commands (samples,) of a law that is fed with the recorded signals and reference.

    Args:
        loop: law and reference.
        measured: (samples, signals), SI units; a reading that is absent is the last one before.
        speed: of the arm's angle at the start [rad/s].
        interval: sampling time [s].
        before: command before the first one [A or V].
    """
    there = ~np.isnan(measured)
    last = np.maximum.accumulate(np.where(there, np.arange(len(measured))[:, None], there.argmax(axis=0)))
    held = np.take_along_axis(measured, last, axis=0)
    running = loop.start_law(held[0], speed, interval, before)
    rows = held[:, loop.columns].tolist()
    return np.array([running.command(row, value) for row, value in zip(rows, loop.reference.tolist(), strict=True)])


def compare_commands(recorded: Floats, computed: Floats, longest: int) -> tuple[float, float, float]:
    """Compare a law's commands (samples,) with the recorded ones.

    Args:
        recorded: commands.
        computed: by the law.
        longest: lag that is tried [samples].

    Returns:
        The error over the norm of the recorded commands; the lag of the recorded commands behind the law at which it is least, in
        samples and parts of them; and the error there.
    """
    norm = float(np.linalg.norm(recorded)) or 1.0
    longest = min(longest, len(recorded) // 4)
    inner = recorded[longest : len(recorded) - longest]
    windows = np.lib.stride_tricks.sliding_window_view(computed, len(inner))
    squares = np.array([float(np.sum((inner - window) ** 2)) for window in windows[::-1]])
    best = int(np.argmin(squares))
    shift, least = 0.0, float(squares[best])
    if 0 < best < len(squares) - 1:
        before, after = float(squares[best - 1]), float(squares[best + 1])
        bend = before - 2.0 * least + after
        if bend > 0.0:
            shift = 0.5 * (before - after) / bend
    late = float(np.sqrt(least)) / (float(np.linalg.norm(inner)) or 1.0)
    return float(np.linalg.norm(recorded - computed)) / norm, best - longest + shift, late


def _law_note(loop: Loop, recording: Recording) -> str:
    """Describe how well a law gives the recorded command, with the lag of that unless it is below half a sample."""
    kind, error = recording.input_kind, 100 * loop.law_error
    text = f"the control law, fed with the recorded signals, misses the recorded {kind} by {error:.3g} %"
    if abs(loop.lag) < 0.5 * recording.sample_time:
        return text
    side = "later" if loop.lag > 0.0 else "earlier"
    return f"{text}, by {100 * loop.late_error:.3g} % where it comes {1000 * abs(loop.lag):.2g} ms {side}"
