"""The effects of the benchmark: those that the catalogue of effects holds, and those that it does not."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from benchmarks.machines import translate
from benchmarks.machines.effects import Hidden, detailed, plain
from benchmarks.machines.model import Model
from benchmarks.machines.translate import Settings

PHASE = (-math.pi, math.pi)
#: Resistance that the catalogue assumes of a motor under current drive [ohm].
RESISTANCE = 1.35


def _torque(share: float):
    """Build the function that computes a share of the largest torque."""
    return lambda m: share * m.torque


def _coulomb(m: Model) -> float:
    return m.values.get("effects.coulomb.torque", 0.0)


def _viscous(m: Model) -> float:
    return m.values.get("effects.viscous.coefficient", 0.0)


def _limit(m: Model) -> float:
    return m.values["drive.limit"]


def _beam(m: Model, key: str) -> float:
    return m.values[f"beam.{key}"]


def _mass(m: Model) -> float:
    return _beam(m, "mass_per_length") * _beam(m, "length")


def _root(m: Model) -> float:
    return 0.4 * _beam(m, "length") / _beam(m, "bending_stiffness")


def _rotary(m: Model) -> bool:
    return m.rotary


def _one_body(m: Model) -> bool:
    return m.values["drive.gear_stiffness"] == 0.0


def _friction(name: str):
    """Build the function that gives a machine friction that its model lacks: on the hub, or on motor and hub."""

    def settings(m: Model, size: float, details: Mapping[str, float]) -> Settings:
        values = {**m.values, name: size}
        one = translate.friction(values) | {"gear": m.values["drive.gear_ratio"]}
        found = one if _one_body(m) else translate.two_bodies(one, values)
        return {key: value for key, value in found.items() if key != "joined"}

    return settings


def _separate(m: Model) -> Settings:
    """Separate the motor of a machine that has it on the hub, on stiff gears."""
    found = translate.settings(m.values, m.arm.input == "voltage")
    if not found["joined"]:
        return {}
    keys = ("joined", "bm", "bs", "tmf", "tms", "taf", "tas")
    separate = translate.two_bodies(found, m.values)
    return {key: separate[key] for key in keys} | translate.stiff_gears(m.values)


def _motor_side(m: Model) -> float:
    return m.values["drive.gear_ratio"] ** 2 * m.values["drive.motor_inertia"]


def _cycles(m: Model) -> dict[str, tuple[float, float]]:
    low = max(1.6 / m.angle, 1.0)
    return {"posn": (low, max(4.0 * low, 4.0)), "posphi": PHASE}


def _delay(setting: str, parameter: str, largest: float) -> Hidden:
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


def _offset(signal: str, setting: str, largest):
    return plain(setting, signal, largest, signed=True, possible=lambda m: f"sensors.{signal}.noise" in m.values, part="offset")


def _strain(m: Model) -> float:
    return 3.0  # V, usual output: see parts.gages


def _tip(m: Model) -> float:
    return 100.0 * m.values["sensors.tip_deflection.noise"]


PLANT: dict[str, Hidden] = {
    "viscous": Hidden(
        lambda m: 0.5 * m.torque / m.speed,
        _friction("effects.viscous.coefficient"),
        truth=lambda m, size, details: {"coefficient": size},
    ),
    "coulomb": Hidden(
        _torque(0.3), _friction("effects.coulomb.torque"), truth=lambda m, size, details: {"torque": size}, part="friction"
    ),
    "stiction": Hidden(
        lambda m: 2.0 * _coulomb(m),
        _friction("effects.stiction.extra"),
        truth=lambda m, size, details: {"extra": size},
        part="static friction",
    ),
    "stribeck": detailed(
        "stribeck",
        "extra",
        lambda m: 2.0 * _coulomb(m),
        lambda m: {"vs": (0.05 * m.speed, 0.25 * m.speed)},
        names={"vs": "falloff_speed"},
        part="static friction",
    ),
    "asymmetric_coulomb": plain("asym", "torque", lambda m: 0.5 * _coulomb(m), signed=True),
    "asymmetric_viscous": plain("asymv", "coefficient", lambda m: 0.5 * _viscous(m), signed=True),
    "position_friction": detailed("posf", "amplitude", lambda m: 0.5 * _coulomb(m), _cycles, names={"posn": "cycles"}),
    "friction_warmup": detailed(
        "warm", "share", lambda m: 0.8, lambda m: {"warm_tau": (1.5, 8.0)}, names={"warm_tau": "time_constant"}
    ),
    "load_friction": plain("loadf", "coefficient", lambda m: 0.6),
    "presliding": Hidden(
        lambda m: 0.1 * m.angle / _coulomb(m),
        lambda m, size, details: {"dahl": 1.0 / size},
        truth=lambda m, size, details: {"compliance": size},
        part="static friction",
    ),
    "constant_torque": plain("bias", "torque", _torque(0.2), signed=True),
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
        possible=_rotary,
    ),
    "cogging": Hidden(
        _torque(0.15),
        lambda m, size, details: {
            "cog": size / m.values["drive.gear_ratio"],
            "cogn": details["cycles"] / m.values["drive.gear_ratio"],
            "cogphi": details["phase"],
        },
        lambda m: {"cycles": (4.0, 24.0), "phase": PHASE},
        lambda m, size, details: {"amplitude": size, "cycles": details["cycles"]},
        possible=lambda m: m.rotary and _one_body(m),
    ),
    "backlash": Hidden(
        lambda m: min(0.3 * m.angle * m.values["drive.gear_ratio"], 0.9),
        lambda m, size, details: {**_separate(m), "gap": size, **details},
        lambda m: {"gap_at": (0.2, 0.8)},
        lambda m, size, details: {"gap": size},
        part="gears",
    ),
    "gear_compliance": Hidden(
        lambda m: 1.0 / ((2.0 * math.pi * 5.0) ** 2 * _motor_side(m)),
        lambda m, size, details: {**_separate(m), "gearc": 1.0 / size, "mesh_c": details["time"] / size},
        lambda m: {"time": (5e-4, 3e-3)},
        lambda m, size, details: {"stiffness": 1.0 / size, "damping_time": details["time"]},
        possible=_one_body,
        part="gears",
    ),
    "beam_damping": plain("beam_damp", "time", lambda m: 0.4 / m.clamped),
    "root_compliance": plain("root", "compliance", _root, part="tip"),
    "payload": plain("payload", "mass", lambda m: 0.5 * _mass(m), part="tip"),
    "tip_inertia": plain("tip_inertia", "inertia", lambda m: 0.05 * _mass(m) * _beam(m, "length") ** 2, part="tip"),
    "current_lag": plain("lag", "time", lambda m: 0.1, part="delay"),
    "input_delay": _delay("delay", "delay", 0.08),
    "dead_zone": plain("dead", "width", lambda m: 0.2 * _limit(m), part="drive"),
    "saturation": plain("sat", "limit", lambda m: 10.0 / _limit(m), inverse=True, part="drive"),
    "rate_limit": plain("rate", "rate", lambda m: 0.5 / _limit(m), inverse=True, part="drive"),
    "brush_drop": Hidden(
        lambda m: 0.2 * _limit(m) * RESISTANCE,
        lambda m, size, details: {"brush": size, "ra": RESISTANCE},
        truth=lambda m, size, details: {"drop": size},
        part="drive",
    ),
}  # fmt: skip

_READINGS: dict[str, Hidden] = {
    "tach_filter": plain("tachlag", "time", lambda m: 0.1, part="tachometer"),
    "tach_ripple": detailed("trip", "amplitude", lambda m: 0.5, lambda m: {"trip_phi": PHASE}, part="tachometer"),
    "strain_drift": plain("sdrift", "rate", lambda m: 0.05 * _strain(m), signed=True),
    "strain_lag": plain("slag", "time", lambda m: 0.1),
    "pot_nonlinearity": Hidden(
        lambda m: 0.2 * m.angle,
        lambda m, size, details: {"potnl": size, **details},
        lambda m: {"potn": (max(1.0 / m.angle, 1.0), max(4.0 / m.angle, 4.0))},
        lambda m, size, details: {"amplitude": abs(size), "cycles": details["potn"]},
        signed=True,
        possible=_rotary,
    ),
    "sensor_offset.motor_speed": _offset("motor_speed", "off_speed", lambda m: 0.3 * m.speed * m.values["drive.gear_ratio"]),
    "sensor_offset.strain_mid": _offset("strain_mid", "off_mid", lambda m: 0.2 * _strain(m)),
    "sensor_offset.strain_base": _offset("strain_base", "off_base", lambda m: 0.2 * _strain(m)),
    "sensor_offset.tip_deflection": _offset("tip_deflection", "off_tip", lambda m: 0.3 * _tip(m)),
    "time_offset": _delay("late", "offset", 0.06),
}
#: Effects in the readings alone. Late readings are as good as a late command to a model, and change its motion.
SENSORS = {name: replace(hidden, sensor=name != "time_offset") for name, hidden in _READINGS.items()}

#: Of effects with such a name the part after the dot says where: `sensor_offset.strain_base`.
CATALOGUE = PLANT | SENSORS

OUTSIDE: dict[str, Hidden] = {
    "hum": detailed("hum", "", _torque(0.2), lambda m: {"humf": (3.0, 9.0), "humphi": PHASE}),
    "fixture": Hidden(
        lambda m: 0.05,
        lambda m, size, details: {"fix_j": m.inertia / size, "fix_f": details["frequency"]},
        lambda m: {"frequency": (5.0, 18.0)},
    ),
    "torque_ripple": detailed(
        "torque_ripple", "", lambda m: 0.8, lambda m: {"torque_ripple_n": _motor_cycles(m, 4.0, 24.0)}, possible=_rotary
    ),
    "detent": Hidden(
        _torque(0.15),
        lambda m, size, details: {"detent": size / m.values["drive.gear_ratio"], **details},
        lambda m: {"detent_n": _motor_cycles(m, 4.0, 12.0), "detent_period": (2.0, 5.0)},
        possible=_rotary,
    ),
    "crosstalk": plain(
        "crosstalk",
        "",
        lambda m: 0.3 * _strain(m) / (m.speed * m.values["drive.gear_ratio"]),
        signed=True,
        possible=lambda m: m.arm.has("strain"),
        sensor=True,
    ),
    "gage_creep": detailed(
        "creep", "", lambda m: 0.6, lambda m: {"creep_tau": (1.0, 3.0)}, possible=lambda m: m.arm.has("strain"), sensor=True
    ),
    "stiff_drift": plain("stiff_drift", "", lambda m: 0.04, signed=True, possible=lambda m: m.clamped > 0.0),
    "temp_step": detailed(
        "temp_step", "", lambda m: 0.8, lambda m: {"temp_time": (2.0, 4.0)}, signed=True, possible=lambda m: _coulomb(m) > 0.0
    ),
    "amp_hysteresis": plain("amp_hyst", "", lambda m: 0.4 * _limit(m)),
    "sticky_spot": detailed(
        "spot",
        "",
        _torque(0.3),
        lambda m: {"spot_at": (-0.5 * m.angle, 0.5 * m.angle), "spot_width": (0.04 * m.angle, 0.1 * m.angle)},
    ),
    "end_stop": detailed("stop", "", lambda m: 20.0 * m.torque / m.angle, lambda m: {"stop_at": (0.5 * m.angle, 0.8 * m.angle)}),
    "motor_saturation": plain(
        "sag", "", lambda m: 0.6 * (m.values["drive.gear_ratio"] * m.values["drive.torque_constant"] / m.torque) ** 2
    ),
}


def _motor_cycles(m: Model, low: float, high: float) -> tuple[float, float]:
    """Convert cycles per radian of the arm times 2π to those of the motor."""
    return low / m.values["drive.gear_ratio"], high / m.values["drive.gear_ratio"]
