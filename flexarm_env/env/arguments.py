"""Arguments that the environment of one arm and that of many arms have in common."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, TypedDict

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.env.given import one_number, two_numbers
from flexarm_env.env.setup import Setup
from flexarm_env.env.variation import Disturbance, Range, find_disturbance, find_variation
from flexarm_env.errors import InputError, UnknownArgument, did_you_mean
from flexarm_env.sensors.arm_angle import ArmAngle
from flexarm_env.tasks import CONTROL_RATE, Task, find_task

#: Name of a shipped arm, path of an arm file, an Arm, or the tables of an arm file.
ArmLike = str | Path | Arm | Mapping[str, Any]


class EnvArguments(TypedDict, total=False):
    """Keyword arguments of every environment, beside its task and its arm; each may be left out.

    Attributes:
        prior: the model of the arm for controllers; the machine's nominal values by default.
        randomise: values drawn anew for each episode: {"payload.mass": (0.0, 0.3)}, lowest and highest in SI units.
        vary: the same as shares of the arm's own values: {"hub.inertia": 0.1} is ±10 %.
        goals: lowest and highest target, drawn anew for each episode [rad]; the task's target by default.
        disturb: taps and drop-outs, see Disturbance: {"tap_rate": 0.5, "tap_torque": 0.3, "dropout_rate": 1.0}.
        control_rate: steps per second [Hz]; 200 by default.
        duration: of an episode [s]; the task's by default.
        physical: whether observations are in SI units; normalised by default.
    """

    prior: ArmLike | None
    randomise: Mapping[str, Range] | None
    vary: Mapping[str, float] | None
    goals: Range | None
    disturb: Disturbance | Mapping[str, float] | None
    control_rate: float
    duration: float
    physical: bool


#: Largest angle of a goal [rad]: where the target's observation ends.
LARGEST_GOAL = ArmAngle.range_end()
#: Names of the arguments of every environment.
NAMES = ("task", "arm", *EnvArguments.__annotations__, "render_mode")


def check_count(name: str, value: Any) -> None:
    """Refuse what is no whole number from 1 up.

    Raises:
        InputError: for such a value.
    """
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < 1:
        raise InputError(f"{name} = {value!r}; give a whole number from 1 up")


def make_setup(task: str | Task, arm: ArmLike, given: EnvArguments, further: Iterable[str] = ()) -> Setup:
    """Build the setup of an environment from its arguments.

    Args:
        task: its name, or a Task.
        arm: the machine.
        given: the other arguments.
        further: names of arguments that this environment has beside NAMES, for the hint at a misspelt one.

    Raises:
        UnknownArgument: for an argument that does not exist.
        InputError: for one that does not make sense.
    """
    for name in given:
        if name not in EnvArguments.__annotations__:
            hint = did_you_mean(name, (*NAMES, *further))
            raise UnknownArgument(f"the environment got an unexpected keyword argument '{name}'{hint}")
    rate = one_number("control_rate", given.get("control_rate", CONTROL_RATE), "give a number [Hz]")
    physical = given.get("physical", False)
    if not isinstance(physical, bool | np.bool_):
        raise InputError(f"physical = {physical!r}; give True or False")
    found = find_task(task)
    if given.get("duration") is not None:
        found = dataclasses.replace(found, duration=one_number("duration", given["duration"], "give a number [s]"))
    drawn, variation = find_variation(find_arm(arm), given.get("randomise"), given.get("vary"))
    return Setup(found, drawn, variation, find_disturbance(given.get("disturb")), rate, bool(physical), goals_of(given))


def goals_of(given: EnvArguments) -> tuple[float, float] | None:
    """Read the lowest and highest target of an environment; None for the task's target.

    Raises:
        InputError: for anything but two finite numbers in order.
    """
    goals = given.get("goals")
    if goals is None:
        return None
    low, high = two_numbers("goals", goals, "give two angles [rad], lowest and highest")
    if not -LARGEST_GOAL <= low <= high <= LARGEST_GOAL:
        raise InputError(
            f"goals = ({low:g}, {high:g}); give the lowest first, from {-LARGEST_GOAL:.4g} to {LARGEST_GOAL:.4g} rad"
        )
    return low, high


def find_prior(arm: ArmLike, given: EnvArguments) -> Arm:
    """Load the model of the arm for controllers: the machine's nominal values unless another one is given."""
    prior = given.get("prior")
    return find_arm(arm) if prior is None else find_arm(prior, "prior")


def find_arm(arm: Any, name: str = "arm") -> Arm:
    """Load an arm by its name or its file, build it from the tables of one, or pass an arm on.

    Args:
        arm: to be found.
        name: of the argument, for the message.

    Raises:
        InputError: for anything else.
    """
    if isinstance(arm, Arm):
        return arm
    if isinstance(arm, Mapping):
        return Arm.from_table(arm, "given")
    if not isinstance(arm, str | Path):
        raise InputError(f"{name} = {arm!r}; give a name, the path of an arm file, or an Arm")
    return Arm.load(arm)
