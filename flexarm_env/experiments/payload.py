"""The payload that a recording states: a known mass at the tip, beside the arm's own."""

from __future__ import annotations

from collections.abc import Iterable

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.plant.plant import Plant
from flexarm_env.recordings.recording import Recording

#: The condition of a recording that states a mass at the tip.
CONDITION = "payload"


def stated_payload(recording: Recording) -> float:
    """Read the payload that a recording states [kg], 0 if none."""
    return recording.conditions.get(CONDITION, 0.0)


def check_payload(arm: Arm, recording: Recording) -> None:
    """Refuse a payload that the arm has no tip to carry.

    Raises:
        InputError: for a payload and an arm without a beam.
    """
    payload = stated_payload(recording)
    if payload > 0.0 and not arm.has("beam"):
        raise InputError(
            f"{recording.name} states a payload of {payload:g} kg, but arm '{arm.name}' has no beam to carry it; "
            "add [beam] to the arm file, or put the load into hub.inertia and take the line '# payload' out"
        )


def with_payload(arm: Arm, payload: float) -> Arm:
    """Add a payload [kg] at the tip, beside a tip mass and a payload of the arm's own."""
    if payload == 0.0:
        return arm
    effect = next(effect for effect in arm.known.values() if effect.condition == CONDITION)
    own = arm.effects.get(effect.name, {}).get(effect.size_parameter(), 0.0)
    return arm.with_effect(effect.name, **{effect.size_parameter(): own + payload})


def plants_by_payload(arm: Arm, payloads: Iterable[float], interval: float) -> dict[float, Plant]:
    """Build a plant of the arm, sampled every `interval` [s], for each payload [kg]."""
    return {payload: with_payload(arm, payload).plant(interval) for payload in dict.fromkeys(payloads)}
