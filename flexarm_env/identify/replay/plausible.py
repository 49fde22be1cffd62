"""Refuse recordings under whose commands and times the model of an arm cannot be judged."""

from __future__ import annotations

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.experiments.plausible import check_motion
from flexarm_env.experiments.stated import stated_by, with_stated
from flexarm_env.identify.settings import Preparation
from flexarm_env.plant.plant import NO_INTERVALS
from flexarm_env.recordings.recording import Recording


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
