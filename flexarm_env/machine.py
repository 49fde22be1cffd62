"""The linear part, the laws and the weight of an arm, from its constants, sensors and effects."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from flexarm_env.effects import Catalogue, Effect
from flexarm_env.effects.catalogue import LAW_PORTS
from flexarm_env.plant.active_laws import VARYING_PORTS, ActiveLaw
from flexarm_env.plant.structure import Structure
from flexarm_env.sensors import known_sensors

#: Standard gravity [m/s²].
GRAVITY = 9.80665

Values = Mapping[str, float]
Constants = Mapping[str, Values]
#: Effects that are present, with their values.
Present = Sequence[tuple[str, Values]]


def structure_of(
    constants: Constants, command: str, sensors: Mapping[str, Values], present: Present, known: Catalogue
) -> Structure:
    """Build the linear part of an arm, with sensors and all linear effects applied.

    Args:
        constants: base constants by section and key.
        command: kind of the drive's command.
        sensors: settings of each measured signal.
        present: effects with their values.
        known: catalogue of effects.
    """
    structure = structure_of_constants(constants, command)
    structure.sensors |= {
        signal: known_sensors()[signal].channel(s["gain"], s["offset"], s["filter"], s["position"])
        for signal, s in sensors.items()
    }
    for name, values in present:
        port = known[name].port("structure")
        if port is not None:
            port(structure, **values)
    return structure


def laws_of(constants: Constants, signals: Sequence[str], present: Present, known: Catalogue) -> list[ActiveLaw]:
    """List the nonlinear laws of an arm's weight and of its effects, with their parameters.

    Args:
        constants: base constants by section and key.
        signals: those that are measured.
        present: effects with their values.
        known: catalogue of effects.
    """
    active = _gravity(constants, known)
    yields = any(known[name].port("presliding") for name, _ in present)
    for name, values in present:
        effect = known[name]
        for port in LAW_PORTS:
            if effect.port(port) is not None:
                varies = effect.varies if port == "friction" else port in VARYING_PORTS
                parameters = tuple(values[key] for key in effect.parameters)
                share = 0.0 if yields else _motor_share(constants, effect)
                kind, reads, dry = known.kinds[name, port], _read_by(signals, effect), effect.modifies != "viscous"
                active.append(ActiveLaw(kind, port, parameters, varies, share, reads, dry))
    return active


def _motor_share(constants: Constants, effect: type[Effect]) -> float:
    """Part of an effect's friction on the motor; the hub in front of an elastic joint turns with it."""
    if effect.motor_share:
        return constants["drive"][effect.motor_share]
    return 1.0 if "joint" in constants else 0.0


def _gravity(constants: Constants, known: Catalogue) -> list[ActiveLaw]:
    """List the law of the weight of link or beam: that of a tilted base, with the torque that the constants give."""
    torque, uphill = weight(constants)
    return [ActiveLaw(known.kinds["base_tilt", "weight"], "weight", (torque, uphill), varies=True)] if torque else []


def _read_by(signals: Sequence[str], effect: type[Effect]) -> tuple[str, ...]:
    """Names of the measured signals on which an effect's sensor law acts."""
    gages = "strain" in effect.reads
    return tuple(s for s in signals if s in effect.reads or (gages and known_sensors()[s].strain))


def structure_of_constants(constants: Constants, command: str) -> Structure:
    """Build the linear part of an arm without effects and sensors.

    Args:
        constants: base constants by section and key.
        command: kind of the drive's command.

    Example:
        >>> from flexarm_env import Arm
        >>> arm = Arm.load("thesis")
        >>> structure_of_constants(arm.constants, arm.input).hub_inertia
        0.00129
    """
    drive, hub = constants["drive"], constants["hub"]["inertia"]
    beam, link, joint = (constants.get(section, {}) for section in ("beam", "link", "joint"))
    structure = Structure(
        gear_ratio=drive["gear_ratio"],
        torque_constant=drive["torque_constant"],
        # the hub turns with the motor in front of a joint, and with the link without one
        motor_inertia=drive["motor_inertia"] + (hub / drive["gear_ratio"] ** 2 if joint else 0.0),
        hub_inertia=0.0 if joint else hub,
        resistance=drive["resistance"] if command in ("voltage", "position") else 0.0,
        motor_viscous_share=drive["motor_viscous_share"],
        gear_compliance=1.0 / drive["gear_stiffness"] if drive["gear_stiffness"] > 0.0 else 0.0,
        efficiency=drive["efficiency"] * drive["enabled"],  # an open circuit carries no current, whatever the voltage
        command_gain=drive["amplifier_gain"] or 1.0,
        supply_voltage=drive["supply_voltage"],
        front_inertia=hub if joint else 0.0,
    )
    if beam:
        _add_beam(structure, beam)
    if command == "position" and drive["enabled"]:
        _add_servo(structure, drive)
    if link:
        structure.hub_inertia += link["inertia"]
        structure.length, structure.link_moment = link["length"], link["mass"] * link["centre"]
    if joint:
        structure.has_joint = True
        structure.gear_compliance, structure.gear_damping_time = 1.0 / joint["stiffness"], joint["damping"] / joint["stiffness"]
    return structure


def _add_beam(structure: Structure, beam: Mapping[str, float]) -> None:
    """Fix a beam to the hub."""
    structure.elements, structure.length = int(beam["elements"]), beam["length"]
    structure.mass_per_length, structure.bending_stiffness = beam["mass_per_length"], beam["bending_stiffness"]
    structure.tip_mass, structure.tip_inertia = beam["tip_mass"], beam["tip_inertia"]


def _add_servo(structure: Structure, drive: Mapping[str, float]) -> None:
    """Close the loop of a servo's firmware around the motor."""
    per_duty = drive["error_gain"] * drive["supply_voltage"]
    structure.position_gain, structure.rate_gain = drive["proportional"] * per_duty, drive["derivative"] * per_duty
    structure.largest_voltage = drive["largest_duty"] * drive["supply_voltage"]
    structure.largest_current = drive["current_limit"]


def weight(constants: Constants) -> tuple[float, float]:
    """Compute the largest torque of gravity about the axis [Nm] and the angle [rad] at which the arm balances upright.

    Example:
        >>> link = {"mass": 0.5, "centre": 0.2, "tilt": math.pi / 2, "hangs_at": 0.0}
        >>> torque, uphill = weight({"link": link})
        >>> round(torque, 4), round(uphill, 4)
        (0.9807, 3.1416)
    """
    beam, link = constants.get("beam"), constants.get("link")
    if beam is not None:
        moment = beam["mass_per_length"] * beam["length"] ** 2 / 2.0 + beam["tip_mass"] * beam["length"]
        return _turned(moment, beam)
    return _turned(link["mass"] * link["centre"], link) if link is not None else (0.0, 0.0)


def _turned(moment: float, section: Mapping[str, float]) -> tuple[float, float]:
    return GRAVITY * moment * math.sin(section["tilt"]), section["hangs_at"] + math.pi
