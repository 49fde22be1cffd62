"""Every effect, and pairs of them, at the ends of their bounds: the motion is finite, or the arm is refused in one line."""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterator, Mapping

import numpy as np
import pytest

from flexarm_env import Arm, InputError, simulate
from flexarm_env.arm_file import shipped_arms
from flexarm_env.effects import catalogue
from flexarm_env.recordings.checks import LARGEST_READING

#: Pairs tried of the thousands that there are.
PAIRS = 200
#: Sizes so small that an effect is not there.
TINY = (5e-324, 1e-300, 1e-200, 1e-100, 1e-50, 1e-30, 1e-20, 1e-12)
#: Effects that move all dry friction, or the motor's inertia, to another body as soon as they are there.
CHANGES_KIND = ("backlash", "presliding")


def ends(name: str) -> Iterator[dict[str, float]]:
    """Yield each parameter at each of its ends, the others at their typical value; then all at one end."""
    parameters = catalogue()[name].parameters
    for key, parameter in parameters.items():
        for end in (parameter.low, parameter.high):
            yield {key: end}
    for end in ("low", "high"):
        yield {key: getattr(parameter, end) for key, parameter in parameters.items()}


def motion(arm: Arm, duration: float = 0.8) -> np.ndarray:
    recording = simulate(arm, "pulse", duration=duration, rate=200.0, noise=False)
    return np.stack(list(recording.signals.values()))


def is_finite_or_refused(arm: Arm, effects: Mapping[str, Mapping[str, float]]) -> bool:
    for name, values in effects.items():
        arm = arm.with_effect(name, **values)
    try:
        return bool((np.abs(motion(arm)) <= LARGEST_READING).all())
    except InputError as error:
        line = str(error)
        too_light = "a body of the arm has no inertia" in line
        stiff = f"model of arm '{arm.name}'" in line and any(f"effects.{name}." in line for name in effects)
        return line.isprintable() and (stiff or too_light)


@pytest.mark.parametrize("name", sorted(shipped_arms()))
def test_an_effect_at_the_ends_of_its_bounds_is_finite_or_refused(name):
    arm = Arm.load(name)
    for effect in filter(arm.can_have, catalogue()):
        for values in ends(effect):
            assert is_finite_or_refused(arm, {effect: values}), (effect, values)


def test_pairs_of_effects_at_the_ends_of_their_bounds_are_finite_or_refused():
    draw = random.Random(7)
    arms = [Arm.load(name) for name in sorted(shipped_arms())]
    pairs = [(arm, one, other) for arm in arms for one, other in itertools.combinations(filter(arm.can_have, arm.known), 2)]
    for arm, one, other in draw.sample(pairs, PAIRS):
        values = {name: draw.choice(list(ends(name))) for name in (one, other)}
        assert is_finite_or_refused(arm, values), (arm.name, values)


@pytest.mark.parametrize("name", sorted(shipped_arms()))
def test_an_effect_too_small_to_matter_is_absent(name):
    arm = Arm.load(name)
    for effect in filter(arm.can_have, set(catalogue()) - {*CHANGES_KIND}):
        for key, parameter in catalogue()[effect].parameters.items():
            if parameter.null != 0.0 or parameter.is_count:  # a part of one is refused
                continue
            absent = motion(arm.with_effect(effect, **{key: 0.0}))
            size = np.abs(absent).max(axis=1, keepdims=True) + 1e-9
            for value in TINY:
                change = np.abs(motion(arm.with_effect(effect, **{key: value})) - absent) / size
                assert change.max() < 1e-5, (effect, key, value)


def test_a_lag_too_short_to_matter_is_none():
    arm = Arm.load("thesis")
    without = motion(arm.with_values({f"sensors.{signal}.filter": 0.0 for signal in arm.signals}))
    for value in TINY:
        short = motion(arm.with_values({f"sensors.{signal}.filter": value for signal in arm.signals}))
        assert np.abs(short - without).max() < 1e-9, value


def test_commands_beyond_any_drive_are_refused_with_their_cause():
    arm = Arm.load("thesis")
    run = simulate(arm, "square", duration=1.0, rate=200.0)
    absurd = type(run).from_arrays("absurd", run.time, "current", np.full(len(run), 1e7), run.signals)
    with pytest.raises(InputError, match=r"absurd: .* under commands of up to 1e\+07 A \(limit 5 A\); is a unit wrong"):
        simulate(arm, absurd)


@pytest.mark.parametrize("inertia", [0.0, 5e-324, 1e-200])
def test_an_arm_without_inertia_is_refused(inertia):
    arm = Arm.load("cu-rigid").with_values({"hub.inertia": inertia})
    with pytest.raises(InputError, match=r"has no inertia, .*raise hub\.inertia"):
        simulate(arm, "pulse", duration=0.1, rate=200.0)
