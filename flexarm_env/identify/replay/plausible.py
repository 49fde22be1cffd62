"""Refuse recordings under whose commands and times the model of an arm cannot be judged."""

from __future__ import annotations

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.experiments.plausible import check_motion
from flexarm_env.experiments.stated import check_stated, stated_by, with_stated
from flexarm_env.identify.replay.build_run import readings_of
from flexarm_env.identify.replay.readings import share_of
from flexarm_env.identify.settings import Preparation
from flexarm_env.parameters import reading_noise
from flexarm_env.plant.plant import NO_INTERVALS
from flexarm_env.recordings.recording import Recording


def check_recording(arm: Arm, recording: Recording, numbers: Preparation) -> None:
    """Refuse a recording that does not fit an arm, or under which its model cannot be judged.

    Args:
        arm: the model, with sensors that the recording has.
        recording: of the machine.
        numbers: of the method.

    Raises:
        InputError: for another kind of command, too few readings, and times or commands beyond any arm.
    """
    if recording.input_kind != arm.input:
        raise InputError(
            f"{recording.name} holds {recording.input_kind}, but arm '{arm.name}' is driven by {arm.input}; "
            f"correct drive.input in its file, or name the command {arm.input} in [columns]"
        )
    check_stated(arm, recording)
    count = int(np.count_nonzero(share_of(readings_of(arm, recording))))
    if count < numbers.fewest_samples:
        word = "sample" if count == 1 else "samples"
        with_readings = f" with a reading of {' or '.join(arm.signals)}" if count < len(recording) else ""
        raise InputError(f"{recording.name} has {count} {word}{with_readings}; at least {numbers.fewest_samples} are needed")
    check_noise(arm, recording)
    check_steps(recording, numbers)
    check_free_motion(arm, recording, numbers)


def check_noise(arm: Arm, recording: Recording) -> None:
    """Refuse noise of an arm file that is below the rounding of a recording's readings: errors over it are no numbers.

    Raises:
        InputError: for such noise.
    """
    for signal in arm.signals:
        noise, largest = reading_noise(arm.sensors[signal]), float(np.nanmax(np.abs(recording.signals[signal])))
        if 0.0 < noise < np.finfo(np.float64).eps * largest:
            raise InputError(
                f"sensors.{signal}.noise = {noise:g} is below the rounding of readings in {recording.name}, "
                f'which reach {largest:g}; write that of the sensor, or noise = "auto"'
            )


def check_steps(recording: Recording, numbers: Preparation) -> None:
    """Refuse samples so far apart that a window of errors would hold no two of them.

    Raises:
        InputError: if the median step is as long as a window.
    """
    step = recording.sample_time
    if step >= numbers.window:
        raise InputError(
            f"{recording.name}: samples are {step:.4g} s apart, too far to follow an arm's motion; "
            f"less than {numbers.window:g} s is allowed: is the unit of time right?"
        )


def check_free_motion(arm: Arm, recording: Recording, numbers: Preparation) -> None:
    """Refuse commands under which the model, from rest, moves beyond any arm.

    Raises:
        InputError: as `check_motion`.
    """
    steps, interval = np.diff(recording.time), recording.sample_time
    even = np.abs(steps - interval).max() <= numbers.uneven * interval
    plant = with_stated(arm, stated_by(arm, recording)).plant(interval)
    plant.place()
    intervals = NO_INTERVALS if even else np.append(steps, interval)
    readings = plant.replay(np.ascontiguousarray(recording.command), intervals)
    check_motion(arm, recording.name, recording.time, recording.command, readings)
