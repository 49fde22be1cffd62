"""The load that a recording says the arm carried: a mass at the tip, known, beside whatever the arm has there."""

from __future__ import annotations

from collections.abc import Iterable

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.identify.recording import Recording
from flexarm_env.plant.plant import Plant

#: The condition of a recording that states a mass at the tip.
CONDITION = "payload"


def payload_of(recording: Recording) -> float:
    """Return the payload that a recording states [kg], 0 if none."""
    return recording.conditions.get(CONDITION, 0.0)


def check_load(arm: Arm, recording: Recording) -> None:
    """Refuse a payload that the arm has no tip to carry.

    Raises:
        InputError: for a payload and an arm without a beam.
    """
    payload = payload_of(recording)
    if payload > 0.0 and not arm.has("beam"):
        raise InputError(
            f"{recording.name} states a payload of {payload:g} kg, but arm '{arm.name}' has no beam to carry it; "
            "add [beam] to the arm file, or put the load into hub.inertia and take the line '# payload' out"
        )


def loaded(arm: Arm, payload: float) -> Arm:
    """Return the arm with a payload [kg] at its tip, beside a tip mass and a payload of its own."""
    if payload == 0.0:
        return arm
    effect = next(effect for effect in arm.known.values() if effect.condition == CONDITION)
    own = arm.effects.get(effect.name, {}).get(effect.size(), 0.0)
    return arm.with_effect(effect.name, **{effect.size(): own + payload})


def loaded_plants(arm: Arm, payloads: Iterable[float], interval: float) -> dict[float, Plant]:
    """Return a plant of the arm, sampled every `interval` [s], for each payload [kg]."""
    return {payload: loaded(arm, payload).plant(interval) for payload in dict.fromkeys(payloads)}
