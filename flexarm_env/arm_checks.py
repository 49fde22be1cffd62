"""Checks of an arm file's values together: each may be within its bounds, and yet there is no such arm."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from flexarm_env.arm_sections import DEFAULTS
from flexarm_env.errors import InputError
from flexarm_env.parameters import NEEDS

if TYPE_CHECKING:
    from flexarm_env.arm import Arm

#: Least resistance [ohm] of an armature under voltage: it divides the command.
LEAST_RESISTANCE = 1e-6
#: Share of an arm's inertia that no motion shows.
NEGLIGIBLE = 1e-3


def check_constants(command: str, constants: Mapping[str, Mapping[str, float]]) -> None:
    """Check that constants within their bounds make an arm together.

    Args:
        command: kind of the drive's command.
        constants: by section and key.

    Raises:
        InputError: for a drive that lacks a constant or has one that its kind does not have, parts that exclude each other, and
            a body without inertia.
    """
    _check_drive(command, constants["drive"])
    _check_bodies(constants)


def _check_drive(command: str, drive: Mapping[str, float]) -> None:
    """Refuse a drive that lacks a constant, or states one that its kind does not have."""
    if command in ("voltage", "position") and drive["resistance"] < LEAST_RESISTANCE:
        raise InputError(
            f'drive.resistance is missing or below {LEAST_RESISTANCE:g} ohm: {command} drive needs it, as "1.35 ohm"'
        )
    if drive["enabled"] not in (0.0, 1.0):
        raise InputError(
            f"drive.enabled = {drive['enabled']:g}; write 1 for a drive that is on, 0 for a motor with an open circuit"
        )
    for key in ("proportional", "error_gain", "supply_voltage"):
        if command == "position" and drive[key] <= 0.0:
            raise InputError(f"drive.{key} is missing or 0: the servo of a position drive needs it")
    if command in ("current", "torque") and drive["supply_voltage"] > 0.0:
        raise InputError(
            f'drive.supply_voltage: a {command} drive has none; take it out, or write input = "voltage" or input = "position"'
        )
    for key in ("proportional", "derivative", "error_gain", "largest_duty", "current_limit"):
        if command != "position" and drive[key] != DEFAULTS["drive"][key]:
            raise InputError(
                f'drive.{key} is of a servo, and drive.input is "{command}": take it out, or write input = "position"'
            )


def _check_bodies(constants: Mapping[str, Mapping[str, float]]) -> None:
    """Refuse parts that exclude each other, and a body without inertia."""
    drive, hub = constants["drive"], constants["hub"]["inertia"]
    if "beam" in constants and "link" in constants:
        raise InputError("[beam] and [link] are both there: an arm is flexible or rigid; keep one of them")
    link = "beam" in constants or constants.get("link", {}).get("inertia", 0.0) > 0.0
    front = hub > 0.0 or drive["motor_inertia"] > 0.0
    if "joint" in constants:
        if not link:
            raise InputError("[joint] has nothing behind it: add [link] with an inertia, or [beam]")
        if not front:
            raise InputError("[joint] has nothing in front of it: give hub.inertia or drive.motor_inertia")
        if drive["gear_stiffness"] > 0.0:
            raise InputError("drive.gear_stiffness and [joint] are both there: an arm has one spring; keep one of them")
    elif not link and not front:
        raise InputError("hub.inertia is 0 and there is neither beam nor link: nothing could move")


def check_link(constants: Mapping[str, Mapping[str, float]]) -> None:
    """Refuse a link with less inertia about the axis than its mass has as a point, but for a difference that no motion shows.

    Raises:
        InputError: for such a link.
    """
    if "link" not in constants:
        return
    link, drive = constants["link"], constants["drive"]
    least = link["mass"] * link["centre"] ** 2
    before = constants["hub"]["inertia"] + drive["motor_inertia"] * drive["gear_ratio"] ** 2
    whole = link["inertia"] + (0.0 if "joint" in constants else before)
    if least - link["inertia"] > NEGLIGIBLE * whole:
        raise InputError(
            f"link.inertia = {link['inertia']:g} kg*m**2 is below mass times centre squared, {least:g}: it is about the axis; "
            f"write {least + link['inertia']:g} if yours is about the centre of mass"
        )


def check_needs(arm: Arm) -> None:
    """Refuse a sensor of a part that the arm does not have.

    Raises:
        InputError: for such a sensor.
    """
    for signal, values in arm.sensors.items():
        missing = [need for need in arm.sensor(signal).needs if not arm.has(need)]
        if "beam" in missing:
            raise InputError(f"sensors.{signal} measures the beam, and the arm has none: add [beam] or leave it out")
        if missing:
            words = " and ".join(NEEDS.get(need, need) for need in missing)
            raise InputError(f"sensors.{signal} needs {words}, which the arm does not have: leave it out")
        if "beam" in arm.constants and values["position"] > arm.constants["beam"]["length"]:
            raise InputError(f"sensors.{signal}.position lies beyond the beam's end at {arm.constants['beam']['length']:g} m")


def check_controller(arm: Arm) -> None:
    """Refuse a control law that feeds back what the arm does not measure.

    Raises:
        InputError: for such a law.
    """
    for signal in arm.controller.signals if arm.controller else ():
        if signal not in arm.sensors:
            raise InputError(f"controller.{signal} feeds back a signal that the arm does not measure: add [sensors.{signal}]")
