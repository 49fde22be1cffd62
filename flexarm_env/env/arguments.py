"""Arguments that the environment of one arm and that of many arms have in common."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, TypedDict

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.env.setup import Setup
from flexarm_env.env.variation import Disturbance, Range, find_disturbance, find_variation
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.tasks import CONTROL_RATE, Task, find_task

#: Name of a shipped arm, path of an arm file, or an Arm.
ArmLike = str | Path | Arm


class EnvArguments(TypedDict, total=False):
    """Keyword arguments of every environment, beside its task and its arm; each may be left out.

    Attributes:
        prior: the model of the arm for controllers; the machine's nominal values by default.
        randomise: values drawn anew for each episode: {"payload.mass": (0.0, 0.3)}, lowest and highest in SI units.
        vary: the same as shares of the arm's own values: {"hub.inertia": 0.1} is ±10 %.
        disturb: taps and drop-outs, see Disturbance: {"tap_rate": 0.5, "tap_torque": 0.3, "dropout_rate": 1.0}.
        control_rate: steps per second [Hz]; 200 by default.
        physical: whether observations are in SI units; normalised by default.
    """

    prior: ArmLike | None
    randomise: Mapping[str, Range] | None
    vary: Mapping[str, float] | None
    disturb: Disturbance | Mapping[str, float] | None
    control_rate: float
    physical: bool


#: Names of the arguments of every environment.
NAMES = ("task", "arm", *EnvArguments.__annotations__, "render_mode")


def make_setup(task: str | Task, arm: ArmLike, given: EnvArguments, further: Iterable[str] = ()) -> Setup:
    """Build the setup of an environment from its arguments.

    Args:
        task: its name, or a Task.
        arm: the machine.
        given: the other arguments.
        further: names of arguments that this environment has beside NAMES, for the hint at a misspelt one.

    Raises:
        InputError: for an argument that does not exist or does not make sense.
    """
    for name in given:
        if name not in EnvArguments.__annotations__:
            raise InputError(f"unknown argument '{name}'{did_you_mean(name, (*NAMES, *further))}")
    rate, physical = given.get("control_rate", CONTROL_RATE), given.get("physical", False)
    if isinstance(rate, bool) or not isinstance(rate, int | float | np.number):
        raise InputError(f"control_rate = {rate!r}; give a number [Hz]")
    if not isinstance(physical, bool | np.bool_):
        raise InputError(f"physical = {physical!r}; give True or False")
    drawn, variation = find_variation(find_arm(arm), given.get("randomise"), given.get("vary"))
    return Setup(find_task(task), drawn, variation, find_disturbance(given.get("disturb")), float(rate), bool(physical))


def find_prior(arm: ArmLike, given: EnvArguments) -> Arm:
    """Load the model of the arm for controllers: the machine's nominal values unless another one is given."""
    prior = given.get("prior")
    return find_arm(arm if prior is None else prior)


def find_arm(arm: Any) -> Arm:
    """Load an arm by its name or its file, or pass an arm on.

    Raises:
        InputError: for anything else.
    """
    if isinstance(arm, Arm):
        return arm
    if not isinstance(arm, str | Path):
        raise InputError(f"arm = {arm!r}; give a name, the path of an arm file, or an Arm")
    return Arm.load(arm)
