"""The conditions that a recording states of its machine: a known mass at the tip, and values in the place of the arm's own."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import suppress

from flexarm_env.arm import Arm
from flexarm_env.arm_checks import check_constants
from flexarm_env.errors import InputError
from flexarm_env.parameters import check_bounds
from flexarm_env.plant.plant import Plant
from flexarm_env.recordings.recording import Recording
from flexarm_env.units import BaseValue, quantity

#: The condition of a recording that states a mass at the tip.
PAYLOAD = "payload"

#: Values by path, and the payload [kg] by its name; a key of plants.
Stated = tuple[tuple[str, float], ...]


def stated_by(arm: Arm, recording: Recording) -> Stated:
    """List what a recording states of its machine: its payload, and the constants that the arm takes from conditions.

    Args:
        arm: the model, with the paths of its constants by condition.
        recording: with its conditions.

    Example:
        >>> from flexarm_env import Arm, simulate
        >>> arm = Arm.load("thesis")
        >>> run = simulate(arm.with_effect("payload", mass=0.1), "pulse", duration=1.0, rate=100.0)
        >>> stated_by(arm, run)
        ()
    """
    conditions = recording.conditions
    found = [(path, conditions[name]) for name, path in arm.conditions.items() if name in conditions]
    payload = conditions.get(PAYLOAD, 0.0)
    return (*sorted(found), *([(PAYLOAD, payload)] if payload else []))


def check_stated(arm: Arm, recording: Recording) -> None:
    """Refuse a payload that the arm has no tip to carry, and a value out of bounds or with which there is no such arm.

    A condition that the arm takes up must be readable where it is stated.

    Raises:
        InputError: for such a condition, or one in a unit of another quantity.
    """
    _check_read(arm, recording)
    _check_units(arm, recording)
    stated = dict(stated_by(arm, recording))
    payload = stated.pop(PAYLOAD, 0.0)
    for path, value in stated.items():
        check_bounds(f"{recording.name}: the stated {path}", value, arm.parameter(path).under(arm.input))
    machine = arm.with_values(stated)
    if stated:
        try:
            check_constants(machine.input, machine.constants)
        except InputError as error:
            values = ", ".join(f"{path} = {value:g}" for path, value in stated.items())
            raise InputError(f"{recording.name} states {values}: {error}") from None
    if payload and not machine.has("tip"):
        raise InputError(
            f"{recording.name} states a payload of {payload:g} kg, but arm '{arm.name}' has no tip to carry it; "
            "add [beam], or a length to [link], or put the load into hub.inertia and take the line '# payload' out"
        )


def _check_read(arm: Arm, recording: Recording) -> None:
    """Refuse a condition that sets a constant or a gain and that is stated, but cannot be read."""
    law = recording.controller or arm.controller
    wanted = {*arm.conditions, *(law.conditions if law is not None else ())}
    for name, note in recording.unread.items():
        if name in wanted and name not in recording.conditions:
            raise InputError(f"{recording.source}: {note}; arm '{arm.name}' takes up '{name}', so correct the line")


def _check_units(arm: Arm, recording: Recording) -> None:
    """Refuse a condition in a unit that measures another quantity than the constant that it sets."""
    for name, path in arm.conditions.items():
        value = recording.conditions.get(name, 0.0)
        if isinstance(value, BaseValue) and value.unit:
            try:
                quantity(f"{value!r} {value.unit}", arm.parameter(path).under(arm.input).unit)
            except InputError as error:
                raise InputError(
                    f"{recording.name}: condition '{name}' is {value:g} {value.unit}, and sets {path}: {error}"
                ) from None


def with_stated(arm: Arm, stated: Stated) -> Arm:
    """Give an arm what a recording states: its values, and its payload beside a tip mass and a payload of the arm's own."""
    values = {path: value for path, value in stated if path != PAYLOAD}
    arm = arm.with_values(values) if values else arm
    payload = dict(stated).get(PAYLOAD, 0.0)
    if payload == 0.0:
        return arm
    effect = next(effect for effect in arm.known.values() if effect.condition == PAYLOAD)
    own = arm.effects.get(effect.name, {}).get(effect.size_parameter(), 0.0)
    return arm.with_effect(effect.name, **{effect.size_parameter(): own + payload})


def plants_by_stated(arm: Arm, stated: Iterable[Stated], interval: float, vibrations: int = 0) -> dict[Stated, Plant]:
    """Build a plant for each distinct set of conditions, as `Arm.plant` does."""
    return {one: with_stated(arm, one).plant(interval, vibrations) for one in dict.fromkeys(stated)}


def plants_of_arms(
    arms: Sequence[Arm], stated: Iterable[Stated], interval: float, vibrations: int = 0
) -> list[dict[Stated, Plant]]:
    """Build the plants of each arm as `plants_by_stated` does, those of arms that differ in their numbers only in one pass."""
    every = {one: _plants([with_stated(arm, one) for arm in arms], interval, vibrations) for one in dict.fromkeys(stated)}
    return [{one: plants[place] for one, plants in every.items()} for place in range(len(arms))]


def _plants(arms: Sequence[Arm], interval: float, vibrations: int) -> list[Plant]:
    if len(arms) > 1 and not vibrations:
        with suppress(ValueError):  # of more kinds than one
            structures, laws = [arm.structure() for arm in arms], [arm.laws() for arm in arms]
            return Plant.of_one_kind(structures, laws, arms[0].known.laws, interval)
    return [arm.plant(interval, vibrations) for arm in arms]
