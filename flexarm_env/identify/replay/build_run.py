"""Build the arrays of a recording for an arm: time, command, readings, initial state and loop."""

from __future__ import annotations

from collections.abc import Container
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.experiments.stated import stated_by
from flexarm_env.identify.replay.initial_state import find_start
from flexarm_env.identify.replay.loop import Loop, find_loop
from flexarm_env.identify.replay.readings import measured_time
from flexarm_env.identify.replay.run import Run
from flexarm_env.identify.replay.start_fit import Stretch
from flexarm_env.identify.settings import InitialStates, Settings
from flexarm_env.plant.plant import NO_INTERVALS
from flexarm_env.recordings.recording import Recording

Floats = NDArray[np.float64]


def with_sensors(arm: Arm, signals: Container[str]) -> Arm:
    """Reduce an arm to the sensors of some signals."""
    return replace(arm, sensors={signal: table for signal, table in arm.sensors.items() if signal in signals})


def readings_of(arm: Arm, recording: Recording) -> Floats:
    """Stack the readings (samples, signals) of an arm's sensors, SI units."""
    return np.stack([recording.signals[signal] for signal in arm.signals], axis=1)


def build_run(arm: Arm, recording: Recording, noise: Floats, interval: float, settings: Settings) -> Run:
    """Build the run of a recording.

    Args:
        arm: the model, with sensors that the recording has.
        recording: of the machine.
        noise: (signals,) standard deviation of the readings.
        interval: sampling time [s].
        settings: numbers of the method.
    """
    numbers = settings.preparation
    signals, measured = list(arm.signals), readings_of(arm, recording)
    time = recording.time - recording.time[0]
    steps, shown = np.diff(time), measured_time(time, measured)
    # Wider than in a simulation, where only rounding counts as even: tables for one interval make replays fast.
    uneven = np.abs(steps - interval).max() > numbers.uneven * interval
    start = find_start(time, recording.command, measured, signals, noise, settings.initial_states)
    loop, note = find_loop(arm, recording, signals, start.speed, numbers)
    return Run(
        name=recording.name,
        time=time,
        command=np.ascontiguousarray(recording.command),
        measured=np.ascontiguousarray(measured),
        intervals=np.append(steps, interval) if uneven else NO_INTERVALS,
        train=shown < (1.0 - numbers.held_out_share) * shown[-1],
        start=start,
        stated=stated_by(arm, recording),
        loop=loop,
        loop_note=note,
    )


def first_stretch(run: Run, noise: Floats, settings: InitialStates, loop: Loop | None = None) -> Stretch:
    """Cut out the first samples of a run, to which its initial state is fitted.

    Args:
        run: the recording.
        noise: (signals,) standard deviation of the readings.
        settings: thresholds.
        loop: in which the samples are replayed; under the recorded command without.
    """
    count = run.start.samples
    samples = run.command[:count], run.intervals[:count], run.measured[:count]
    return Stretch(run.start, *samples, noise, settings, None if loop is None else loop.first(count))
