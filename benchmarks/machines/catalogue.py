"""The effects of the benchmark that the catalogue of effects holds."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

from benchmarks.machines import translate
from benchmarks.machines.effects import Hidden, detailed, plain
from benchmarks.machines.model import Model
from benchmarks.machines.scales import (
    PHASE,
    beam,
    coulomb,
    friction_cycles,
    limit,
    mass,
    motor_side,
    of_torque,
    one_body,
    root,
    rotary,
    strain,
    tip,
    viscous,
)
from benchmarks.machines.translate import Settings

#: Resistance that the catalogue assumes of a motor under current drive [ohm].
RESISTANCE = 1.35


def friction(name: str) -> Callable[[Model, float, Mapping[str, float]], Settings]:
    """Build the function that gives a machine friction that its model lacks: on the hub, or on motor and hub."""

    def all_friction(values: Mapping[str, float]) -> Settings:
        one = translate.friction(values) | {"gear": values["drive.gear_ratio"]}
        return translate.two_bodies(one, values) if values["drive.gear_stiffness"] else one

    def settings(m: Model, size: float, details: Mapping[str, float]) -> Settings:
        before, after = (all_friction({**m.values, **more}) for more in ({}, {name: size}))
        return {key: value for key, value in after.items() if value != before[key]}

    return settings


def separate(m: Model) -> Settings:
    """Separate the motor of a machine that has it on the hub, on stiff gears."""
    found = translate.settings(m.values, m.arm.input == "voltage")
    if not found["joined"]:
        return {}
    keys = ("joined", "bm", "bs", "tmf", "tms", "taf", "tas")
    apart = translate.two_bodies(found, m.values)
    return {key: apart[key] for key in keys} | translate.stiff_gears(m.values)


def delay(setting: str, parameter: str, largest: float) -> Hidden:
    """Describe a delay by a whole number of the rig's steps."""

    def whole(m: Model, size: float, details: Mapping[str, float]) -> float:
        step = translate.step(m.values, translate.settings(m.values, m.arm.input == "voltage"))
        return round(size / step) * step

    return Hidden(
        lambda m: largest,
        lambda *given: {setting: whole(*given)},
        truth=lambda *given: {parameter: whole(*given)},
        part="delay",
    )


def offset(signal: str, setting: str, largest: Callable[[Model], float]) -> Hidden:
    """Describe a constant error of a signal that is measured."""
    return plain(setting, signal, largest, signed=True, possible=lambda m: f"sensors.{signal}.noise" in m.values, part="offset")


PLANT: dict[str, Hidden] = {
    "viscous": Hidden(
        lambda m: 0.5 * m.torque / m.speed,
        friction("effects.viscous.coefficient"),
        truth=lambda m, size, details: {"coefficient": size},
    ),
    "coulomb": Hidden(
        of_torque(0.3), friction("effects.coulomb.torque"), truth=lambda m, size, details: {"torque": size}, part="friction"
    ),
    "stiction": Hidden(
        lambda m: 2.0 * coulomb(m),
        friction("effects.stiction.extra"),
        truth=lambda m, size, details: {"extra": size},
        part="static friction",
    ),
    "stribeck": detailed(
        "stribeck",
        "extra",
        lambda m: 2.0 * coulomb(m),
        lambda m: {"vs": (0.05 * m.speed, 0.25 * m.speed)},
        names={"vs": "falloff_speed"},
        part="static friction",
    ),
    "asymmetric_coulomb": plain("asym", "torque", lambda m: 0.5 * coulomb(m), signed=True),
    "asymmetric_viscous": plain("asymv", "coefficient", lambda m: 0.5 * viscous(m), signed=True),
    "position_friction": detailed("posf", "amplitude", lambda m: 0.5 * coulomb(m), friction_cycles, names={"posn": "cycles"}),
    "friction_warmup": detailed(
        "warm", "share", lambda m: 0.8, lambda m: {"warm_tau": (1.5, 8.0)}, names={"warm_tau": "time_constant"}
    ),
    "load_friction": plain("loadf", "coefficient", lambda m: 0.6),
    "presliding": Hidden(
        lambda m: 0.1 * m.angle / coulomb(m),
        lambda m, size, details: {"dahl": 1.0 / size},
        truth=lambda m, size, details: {"compliance": size},
        part="static friction",
    ),
    "constant_torque": plain("bias", "torque", of_torque(0.2), signed=True),
    "end_stop": Hidden(
        lambda m: 20.0 * m.torque / m.angle,
        lambda m, size, details: {"stop": size, **details},
        lambda m: {"stop_at": (0.5 * m.angle, 0.8 * m.angle)},
        lambda m, size, details: {
            "stiffness": size,
            "upper": details["stop_at"],
            "lower": -details["stop_at"],
            "damping_time": 0.0,
        },
    ),
    "cable_stiffness": detailed(
        "cable",
        "stiffness",
        lambda m: 0.5 * m.torque / m.angle,
        lambda m: {"cable0": (-0.5 * m.angle, 0.5 * m.angle)},
        names={"cable0": "rest_angle"},
    ),
    "base_tilt": Hidden(
        lambda m: min(0.2 * m.torque, 0.5 * translate.most_weight(m.values) if m.clamped else math.inf),
        lambda m, size, details: translate.tilted(m.values, size, details["downhill"]),
        lambda m: {"downhill": PHASE},
        lambda m, size, details: {"torque": size},
        possible=rotary,
    ),
    "cogging": Hidden(
        of_torque(0.15),
        lambda m, size, details: {
            "cog": size / m.values["drive.gear_ratio"],
            "cogn": details["cycles"] / m.values["drive.gear_ratio"],
            "cogphi": details["phase"],
        },
        lambda m: {"cycles": (4.0, 24.0), "phase": PHASE},
        lambda m, size, details: {"amplitude": size, "cycles": details["cycles"]},
        possible=lambda m: m.rotary and one_body(m),
    ),
    "backlash": Hidden(
        lambda m: min(0.3 * m.angle * m.values["drive.gear_ratio"], 0.9),
        lambda m, size, details: {**separate(m), "gap": size, **details},
        lambda m: {"gap_at": (0.2, 0.8)},
        lambda m, size, details: {"gap": size},
        part="gears",
    ),
    "gear_compliance": Hidden(
        lambda m: 1.0 / ((2.0 * math.pi * 5.0) ** 2 * motor_side(m)),
        lambda m, size, details: {**separate(m), "gearc": 1.0 / size, "mesh_c": details["time"] / size},
        lambda m: {"time": (5e-4, 3e-3)},
        lambda m, size, details: {"stiffness": 1.0 / size, "damping_time": details["time"]},
        possible=one_body,
        part="gears",
    ),
    "beam_damping": plain("beam_damp", "time", lambda m: 0.4 / m.clamped),
    "root_compliance": plain("root", "compliance", root, part="tip"),
    "payload": plain("payload", "mass", lambda m: 0.5 * mass(m), part="tip"),
    "tip_inertia": plain("tip_inertia", "inertia", lambda m: 0.05 * mass(m) * beam(m, "length") ** 2, part="tip"),
    "current_lag": plain("lag", "time", lambda m: 0.1, part="delay"),
    "input_delay": delay("delay", "delay", 0.08),
    "dead_zone": plain("dead", "width", lambda m: 0.2 * limit(m), part="drive"),
    "saturation": plain("sat", "limit", lambda m: 10.0 / limit(m), inverse=True, part="drive"),
    "rate_limit": plain("rate", "rate", lambda m: 0.5 / limit(m), inverse=True, part="drive"),
    "brush_drop": Hidden(
        lambda m: 0.2 * limit(m) * RESISTANCE,
        lambda m, size, details: {"brush": size, "ra": RESISTANCE},
        truth=lambda m, size, details: {"drop": size},
        part="drive",
    ),
}  # fmt: skip

_READINGS: dict[str, Hidden] = {
    "tach_filter": plain("tachlag", "time", lambda m: 0.1, part="tachometer"),
    "tach_ripple": detailed("trip", "amplitude", lambda m: 0.5, lambda m: {"trip_phi": PHASE}, part="tachometer"),
    "strain_drift": plain("sdrift", "rate", lambda m: 0.05 * strain(m), signed=True),
    "strain_lag": plain("slag", "time", lambda m: 0.1),
    "pot_nonlinearity": Hidden(
        lambda m: 0.2 * m.angle,
        lambda m, size, details: {"potnl": size, **details},
        lambda m: {"potn": (max(1.0 / m.angle, 1.0), max(4.0 / m.angle, 4.0))},
        lambda m, size, details: {"amplitude": abs(size), "cycles": details["potn"]},
        signed=True,
        possible=rotary,
    ),
    "sensor_offset.motor_speed": offset("motor_speed", "off_speed", lambda m: 0.3 * m.speed * m.values["drive.gear_ratio"]),
    "sensor_offset.strain_mid": offset("strain_mid", "off_mid", lambda m: 0.2 * strain(m)),
    "sensor_offset.strain_base": offset("strain_base", "off_base", lambda m: 0.2 * strain(m)),
    "sensor_offset.tip_deflection": offset("tip_deflection", "off_tip", lambda m: 0.3 * tip(m)),
    "time_offset": delay("late", "offset", 0.06),
}
#: Effects in the readings alone. Late readings are as good as a late command to a model, and change its motion.
SENSORS = {name: replace(hidden, sensor=name != "time_offset") for name, hidden in _READINGS.items()}

#: Of effects with such a name the part after the dot says where: `sensor_offset.strain_base`.
CATALOGUE = PLANT | SENSORS
