"""Controllers by name: those of the thesis and those that it leaves for future work."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple, get_args, get_type_hints

from flexarm_env import units
from flexarm_env.arm import Arm
from flexarm_env.controllers.base import Controller
from flexarm_env.controllers.filtered import FilteredVibrationSuppression
from flexarm_env.controllers.lqg import LQG
from flexarm_env.controllers.mpc import MPC
from flexarm_env.controllers.pd import PD, RateLimitedPD
from flexarm_env.controllers.pid import CompensatedPID
from flexarm_env.controllers.scheduled import ScheduledLQG
from flexarm_env.controllers.shaping import ShapedPD
from flexarm_env.controllers.tuned import TunedController, on_drive, shipped_controllers
from flexarm_env.controllers.vibration import TORQUE_PER_STRAIN, VibrationSuppression
from flexarm_env.errors import InputError, did_you_mean


class Recipe(NamedTuple):
    """A controller's class, its options where they differ from the class's defaults, and one line for a person.

    Gains that are for the thesis's drive are scaled to the arm's; others are the arm's own.
    """

    build: type[Controller]
    options: Mapping[str, Any]
    meaning: str
    for_thesis_drive: bool = False


CONTROLLERS: dict[str, Recipe] = {
    "pd": Recipe(PD, {}, "the thesis's PD (section 2.3)"),
    "pd_rate_limited": Recipe(RateLimitedPD, {}, "PD whose command ramps (Fig. 2.8)"),
    "vibration_dual": Recipe(
        VibrationSuppression, {}, "PD, K_mo = −1 at high speed, +1 and friction compensation at low (Fig. 4.16)"
    ),
    "vibration_dual_plain": Recipe(
        VibrationSuppression, {"friction_compensation": False}, "the same without friction compensation"
    ),
    "vibration_high": Recipe(
        VibrationSuppression, {"low_gain": 0.0, "friction_compensation": False}, "PD, K_mo = −1 at high speed only (Fig. 4.18)"
    ),
    "vibration_low": Recipe(
        VibrationSuppression, {"high_gain": 0.0}, "PD, K_mo = +1 with compensation at low speed only (Fig. 4.17)"
    ),
    "vibration_practical": Recipe(
        VibrationSuppression,
        {"low_gain": 0.0, "friction_compensation": False, "torque_per_strain": TORQUE_PER_STRAIN},
        "PD, K_mo = −1 at high speed only, mid-beam strain × 1.18 for M_o (Fig. 4.21)",
    ),
    # −1 cancels the beam's torque whole, which leaves a finer arm than the thesis's swinging at the delay of a sample; the
    # window is ten times the thesis's, because compensating friction is left out and both gains damp around it
    "vibration_filtered": Recipe(
        FilteredVibrationSuppression,
        {"high_gain": -0.7, "low_gain": 0.5, "low_speed": 0.3, "friction_compensation": False},
        "PD, K_mo by speed on estimated strain and speed, without a filter's lag (chapter 5)",
    ),
    "shaped_zv": Recipe(ShapedPD, {"shaper": "zv"}, "PD, target shaped for zero vibration"),
    "shaped_zvd": Recipe(ShapedPD, {"shaper": "zvd"}, "PD, target shaped for zero vibration and derivative"),
    "lqg": Recipe(LQG, {}, "Kalman filter, linear-quadratic regulator, estimated friction opposed"),
    "lqg_scheduled": Recipe(ScheduledLQG, {}, "LQG with gains by the payload that the stuck arm's frequency shows"),
    "pid_compensated": Recipe(CompensatedPID, {}, "PID about a quintic reference, feedforward, friction compensated"),
    "mpc": Recipe(MPC, {}, "linear MPC with the filter, friction and payload of lqg_scheduled"),
}


#: Types of an option's values, and how a person is told of them, by the type that the option is declared with.
TYPES: dict[type, tuple[tuple[type, ...], str]] = {
    float: ((int, float), "a finite number"),
    int: ((int,), "a whole number from 1 up"),
    bool: ((bool,), "true or false"),
    str: ((str,), "a text"),
}


def tuned_recipe(tuned: TunedController) -> Recipe:
    """Make the recipe of a law with the options that a search has found.

    Raises:
        InputError: for a law or an option that does not exist.
    """
    if tuned.controller not in CONTROLLERS:
        raise InputError(f"no controller '{tuned.controller}'{did_you_mean(tuned.controller, CONTROLLERS)}")
    recipe = CONTROLLERS[tuned.controller]
    _check(tuned.controller, recipe, tuned.options)
    found = f"{tuned.controller}, tuned on {tuned.arm}"
    return Recipe(recipe.build, {**recipe.options, **tuned.options}, found, for_thesis_drive=True)


def make_controller(name: str, arm: Arm, interval: float, **options: Any) -> Controller:
    """Make a controller by its name.

    Args:
        name: one of CONTROLLERS, or a .toml file that `flexarm tune` wrote.
        arm: model of the arm on which the controller is designed.
        interval: control period [s].
        options: of the controller's class, over those of its recipe.

    Raises:
        InputError: for a name, file or option that does not exist, or an arm that lacks a signal.

    Examples:
        >>> import numpy as np
        >>> from flexarm_env import Arm
        >>> controller = make_controller("pd", Arm.load("thesis"), interval=0.005)
        >>> controller.reset()
        >>> float(controller.act(np.array([0.0, 0.0, 0.0, 0.0, 0.5])))  # arm angle, motor speed, strains; target [rad]
        1.2654
    """
    if Path(name).suffix == ".toml":
        recipe = tuned_recipe(TunedController.load(Path(name)))
    elif name in CONTROLLERS:
        recipe = CONTROLLERS[name]
    else:
        raise InputError(f"no controller '{name}'{did_you_mean(name, CONTROLLERS)}")
    _check(name, recipe, options)
    own = on_drive(arm, recipe.options) if recipe.for_thesis_drive else recipe.options
    return recipe.build(arm, interval, **{**own, **options})


def _check(name: str, recipe: Recipe, options: Mapping[str, Any]) -> None:
    """Refuse options that a recipe's class does not have, and values of another type than the option's."""
    allowed = _options(recipe.build)
    for option, value in options.items():
        if option not in allowed:
            raise InputError(f"controller '{name}' has no option '{option}'{did_you_mean(option, allowed)}")
        hint = allowed[option]
        for kind in TYPES.keys() & {hint, *get_args(hint)}:
            types, meaning = TYPES[kind]
            if value is None and type(None) in get_args(hint):
                continue
            if type(value) not in types or not (kind is str or units.is_finite(value)) or (kind is int and value < 1):
                raise InputError(f"controller '{name}': {option} = {value!r}; give {meaning}")


def _options(build: type[Controller]) -> dict[str, Any]:
    """List a class's options and their types, with those that it passes on to the class above."""
    parameters, hints = inspect.signature(build).parameters.values(), get_type_hints(build.__init__)
    own = {p.name: hints[p.name] for p in list(parameters)[2:] if p.kind is not inspect.Parameter.VAR_KEYWORD}
    hands_on = any(p.kind is inspect.Parameter.VAR_KEYWORD for p in parameters)
    return own | (_options(build.__mro__[1]) if hands_on else {})


# the laws themselves stand above: a tuned one refers to its law
CONTROLLERS |= {name: tuned_recipe(tuned) for name, tuned in shipped_controllers().items()}

__all__ = ["CONTROLLERS", "Controller", "Recipe", "make_controller", "tuned_recipe"]
