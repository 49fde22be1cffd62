"""Names, units and null values of every setting, and their translation into the kernel's numbers."""

from __future__ import annotations

import math

import numpy as np

from .beam import NO_BEAM, Beam, build
from .parameters import MODE, NODE, PAR, SENSE, record

#: base constants: name -> (value, unit, what it is); `<name>_x` in a setting scales one
CONSTANTS = {
    "gear": (1.5, "1", "gear ratio, motor turns per hub turn"),
    "kphi": (0.33, "Nm/A", "motor constant"),
    "jm": (0.00193, "kg m²", "inertia of the rotor and its gear, motor side"),
    "jh": (0.00129, "kg m²", "inertia of the arm hub and its gear"),
    "bm": (0.0008, "Nms", "viscous friction of the rotor, motor side"),
    "bs": (0.1, "Nms", "viscous friction of the hub"),
    "tmf": (0.066, "Nm", "Coulomb friction of the rotor, motor side"),
    "tms": (0.09487, "Nm", "static friction of the rotor, motor side"),
    "taf": (0.183, "Nm", "Coulomb friction of the hub"),
    "tas": (0.21574, "Nm", "static friction of the hub"),
    "ei": (7.911, "Nm²", "bending stiffness"),
    "density": (0.42381, "kg/m", "mass of the beam per length"),
    "length": (1.0, "m", "length of the beam"),
    "ksg": (2.27, "V/Nm", "gain of both gages"),
    "ksgb": (1.0, "1", "gain of the base gage over that of the mid gage"),
    "x_mid": (0.55, "m", "place of the mid gage"),
    "x_base": (0.02, "m", "place of the base gage"),
    "mesh": (4000.0, "Nm/rad", "stiffness of the gear mesh, arm side"),
    "mesh_c": (2.0, "Nms", "damping of the gear mesh, arm side"),
    "ra": (1.35, "ohm", "armature resistance; matters with brush, backemf or volts"),
    "joined": (0.0, "1", "1: the motor is rigidly on the hub, and all friction with it"),
    "split": (0.0, "1", "1: a step in which a body stands still is split there; 0: it errs by the friction of one step"),
    "volts": (0.0, "1", "1: commands are voltages [V] at the armature, and so are the amplifier's settings"),
    "servo": (0.0, "1", "1: the loop's angle is that of the motor"),
    "weight": (0.0, "Nm", "torque of gravity about the hub of a rigid arm where it points sideways"),
}

#: effects: name -> (null value, unit, what it is)
EFFECTS = {
    "visc": (0.0, "Nms", "more viscous friction at the hub"),
    "coul": (0.0, "Nm", "more Coulomb friction at the hub, at rest too"),
    "stic": (0.0, "Nm", "more static friction at the hub, at rest only"),
    "stribeck": (0.0, "Nm", "extra hub friction times exp(-(ω/vs)²), in full at rest"),
    "vs": (0.15, "rad/s", "Stribeck speed of the hub"),
    "asym": (0.0, "Nm", "sliding friction of the hub is larger by this for ω > 0, smaller for ω < 0; none at rest"),
    "asymv": (0.0, "Nms", "viscous hub friction is (bs + asymv)ω for ω > 0 and (bs - asymv)ω for ω < 0"),
    "posf": (0.0, "Nm", "amplitude of the position-dependent part of the hub friction"),
    "posn": (3.0, "1", "n in a sin(nθ + φ) of the hub angle: cycles per turn of the hub"),
    "posphi": (0.0, "rad", "its phase"),
    "warm": (0.0, "1", "share of all dry friction that warming up takes away"),
    "warm_tau": (4.0, "s", "its time constant"),
    "loadf": (0.0, "1", "hub friction per transmitted gear torque"),
    "dahl": (0.0, "Nm/rad", "presliding stiffness; all friction is then LuGre friction at the hub"),
    "bias": (0.0, "Nm", "constant torque on the hub"),
    "cable": (0.0, "Nm/rad", "cable stiffness"),
    "cable0": (0.0, "rad", "hub angle at which the cable is free"),
    "tilt": (0.0, "rad", "tilt of the base"),
    "tilt_dir": (0.0, "rad", "hub angle at which the tilted arm hangs lowest"),
    "cog": (0.0, "Nm", "cogging amplitude, motor side"),
    "cogn": (7.0, "1", "cogging cycles per motor turn"),
    "cogphi": (0.0, "rad", "its phase"),
    "gap": (0.0, "rad", "backlash, full width, motor side"),
    "gap_at": (0.5, "1", "where in the gap the gear starts, 0 to 1 (0: forward flank touches)"),
    "gearc": (0.0, "Nm/rad", "gear stiffness in place of the stiff mesh, arm side; 0 is the stiff mesh"),
    "beam_damp": (0.0, "s", "Kelvin-Voigt time of the beam"),
    "drag": (0.0, "N s²/m³", "quadratic air drag per length, lumped on the nodes"),
    "root": (0.0, "rad/Nm", "compliance of the beam's clamp"),
    "payload": (0.0, "kg", "tip mass"),
    "tip_inertia": (0.0, "kg m²", "tip inertia"),
    "elements": (6, "1", "finite elements of the beam; 0 is a rigid arm"),
    "modes": (12, "1", "clamped modes kept, at most two per element"),
    "lag": (0.0, "s", "first-order lag of the current"),
    "delay": (0.0, "s", "pure delay of the current"),
    "dead": (0.0, "A", "half width of the amplifier's dead zone"),
    "sat": (math.inf, "A", "current at which the amplifier saturates"),
    "rate": (0.0, "A/s", "largest rate of the current; 0 is none"),
    "brush": (0.0, "V", "brush drop of an amplifier that controls the voltage"),
    "backemf": (0.0, "1", "share of the back-EMF that the amplifier does not make up for"),
    "tachlag": (0.0, "s", "first-order lag of the tachometer"),
    "trip": (0.0, "1", "tachometer ripple, share of the speed, once per motor turn"),
    "trip_phi": (0.0, "rad", "its phase"),
    "sdrift": (0.0, "V/s", "drift of both strain signals"),
    "slag": (0.0, "s", "first-order lag of both strain signals"),
    "potnl": (0.0, "rad", "amplitude of the potentiometer's non-linearity a sin(nθ)"),
    "potn": (2.0, "1", "its n"),
    "off_angle": (0.0, "rad", "sensor offset"),
    "off_speed": (0.0, "rad/s", "sensor offset"),
    "off_mid": (0.0, "V", "sensor offset"),
    "off_base": (0.0, "V", "sensor offset"),
    "off_tip": (0.0, "m", "sensor offset"),
    "late": (0.0, "s", "all sensors are sampled this late"),
    "pd": (1.0, "1", "factor on the gains of the controller that drives the experiment"),
    "noise": (1.0, "1", "factor on all sensor noise"),
    "quant": (1.0, "1", "factor on all converter steps"),
    "hum": (0.0, "Nm", "periodic torque on the hub"),
    "humf": (6.0, "Hz", "its frequency"),
    "humphi": (0.0, "rad", "its phase"),
    "fix_j": (0.0, "kg m²", "inertia of a base on a spring; 0 is a fixed base"),
    "fix_f": (14.0, "Hz", "frequency of that base"),
    "fix_z": (0.02, "1", "its damping ratio"),
    "torque_ripple": (0.0, "1", "commutation ripple, share of the motor torque"),
    "torque_ripple_n": (11.0, "1", "its cycles per motor turn"),
    "detent": (0.0, "Nm", "magnetic detent on the motor that swells and fades"),
    "detent_n": (5.0, "1", "its cycles per motor turn"),
    "detent_period": (3.3, "s", "period of its swelling"),
    "stiff_drift": (0.0, "1/s", "relative drift of the beam's stiffness"),
    "temp_step": (0.0, "1", "relative step of all dry friction"),
    "temp_time": (5.0, "s", "when"),
    "amp_hyst": (0.0, "A", "width of the amplifier's hysteresis (a play)"),
    "spot": (0.0, "Nm", "extra hub friction at one angle"),
    "spot_at": (0.3, "rad", "that angle"),
    "spot_width": (0.08, "rad", "its width"),
    "crosstalk": (0.0, "V s/rad", "motor speed in both strain signals"),
    "creep": (0.0, "1", "creep of the gages, share of the strain"),
    "creep_tau": (2.0, "s", "its time constant"),
    "stop": (0.0, "Nm/rad", "stiffness of soft end stops on both sides"),
    "stop_at": (1.0, "rad", "hub angle at which they begin"),
    "sag": (0.0, "1/A²", "saturation of the motor: its constant falls by this times the squared current, to a third at most"),
}

STEP = 1e-5
GRAVITY = 9.81

#: steps of the 12-bit board [rad, rad/s, V]; the tip is not measured
CONVERTER = {"angle": 1.5e-3, "speed": 0.054, "strain": 2.4e-3, "tip": 0.0}


def resolve(settings: dict[str, float]) -> dict[str, float]:
    """Return every setting with its value; `<constant>_x` scales a constant. An unknown name raises KeyError."""
    values = {name: entry[0] for name, entry in (CONSTANTS | EFFECTS).items()}
    for name, value in settings.items():
        if name in values:
            values[name] = value
        elif not (name.endswith("_x") and name[:-2] in CONSTANTS):
            raise KeyError(f"the rig has no setting {name!r}")
    for name, value in settings.items():
        if name not in values:
            values[name[:-2]] *= value
    return values


def make_beam(v: dict[str, float]) -> Beam:
    """Return the reduced beam of resolved settings."""
    elements = int(v["elements"])
    if elements == 0:
        return NO_BEAM
    return build(
        v["ei"],
        v["density"],
        v["length"],
        elements=elements,
        modes=min(int(v["modes"]), 2 * elements),
        payload=v["payload"],
        tip_inertia=v["tip_inertia"],
        root_compliance=v["root"],
        gages=(v["x_mid"], v["x_base"]),
    )


def damping(v: dict[str, float]) -> float:
    """Return the linear damping of a hub with the motor on it [Nms]: friction, and the back-EMF of a motor without a lag."""
    own = (v["gear"] * v["kphi"]) ** 2 / v["ra"] if v["volts"] and not v["lag"] else 0.0
    return v["bs"] + v["visc"] + own


def make_par(v: dict[str, float], beam: Beam, rate: float, step: float) -> np.void:
    """Return the kernel's parameters for a sampling `rate` [Hz] and a step [s] (made to divide the sample)."""
    sub = math.ceil(1.0 / rate / step - 1e-9)
    h = 1.0 / rate / sub
    gap = v["gap"] / v["gear"]
    presliding = v["dahl"] > 0.0
    moved = v["gear"] * v["tmf"] if presliding else 0.0
    jr = v["jh"] + beam.inertia - float(beam.coupling @ beam.coupling) + v["joined"] * v["gear"] ** 2 * v["jm"]
    made = {
        "h": h,
        "jr": jr,
        "jk": jr + v["joined"] * 0.5 * h * damping(v),
        "tmf": 0.0 if presliding else v["tmf"],
        "tms": 0.0 if presliding else v["tms"],
        "bs": v["bs"] + v["visc"],
        "taf": v["taf"] + v["coul"] + moved,
        "tas": (v["taf"] + moved if presliding else v["tas"]) + v["coul"] + v["stic"],
        "mesh_k": v["gearc"] if v["gearc"] > 0 else v["mesh"],
        "gap_low": -gap * v["gap_at"],
        "gap_high": gap * (1.0 - v["gap_at"]),
        "tilt_torque": GRAVITY * math.sin(v["tilt"]) * beam.moment_arm + v["weight"],
        "fix_w2": (2 * math.pi * v["fix_f"]) ** 2,
        "fix_c": 4 * math.pi * v["fix_f"] * v["fix_z"],
    }
    return record(PAR, v | made | {"sub": sub, "delay_steps": round(v["delay"] / h)})


def make_sense(v: dict[str, float], par: np.void, steps: dict[str, float] = CONVERTER) -> np.void:
    """Return the sensors' parameters; `steps` are those of the converters by signal."""
    late = round(v["late"] / par["h"])
    made = {"ksg_base": v["ksg"] * v["ksgb"]}
    made |= {f"step_{signal}": lsb * v["quant"] for signal, lsb in steps.items()}
    return record(SENSE, v | made | {"late_samples": late // par["sub"], "late_steps": late % par["sub"]})


def make_modes(v: dict[str, float], beam: Beam, h: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return modes, nodes and shapes (nodes, modes) for steps of `h` [s]; the damping decays exactly over one."""
    modes, nodes = np.zeros(beam.omega2.size, MODE), np.zeros(beam.x.size, NODE)
    modes["omega2"], modes["coupling"] = beam.omega2, beam.coupling
    modes["damp"] = -np.expm1(-h * v["beam_damp"] * beam.omega2) / h
    modes["gravity"] = GRAVITY * math.sin(v["tilt"]) * beam.load
    modes["bend_mid"], modes["bend_base"] = beam.bend
    modes["tip"] = beam.shape[-1]
    nodes["x"], nodes["weight"] = beam.x, beam.weight
    return modes, nodes, np.ascontiguousarray(beam.shape)


def table() -> str:
    """Return the settings as a table: name, null or standard value, unit, meaning."""
    rows = [(n, f"{e[0]:g}", e[1], e[2]) for n, e in (CONSTANTS | EFFECTS).items()]
    return "\n".join(f"    {n:<16}{value:<10}{unit:<9}{text}" for n, value, unit, text in rows)
