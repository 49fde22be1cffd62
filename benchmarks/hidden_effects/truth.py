"""True values of fitted parameters: the rig's settings, by the names of arm files."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

GEAR = 1.5
#: Half of the beam's weight at its density in the model, times its length of 1 m [Nm]; damping of the rig's gears [Nms].
HALF_WEIGHT, GEAR_DAMPING = 9.81 * 0.42381 / 2.0, 2.0

#: effect -> parameter -> the rig's settings in its units
PARAMETERS: dict[str, dict[str, Callable[[dict[str, float]], float]]] = {
    "stribeck": {"extra": lambda s: s["stribeck"], "falloff_speed": lambda s: s["vs"]},
    "asymmetric_coulomb": {"torque": lambda s: s["asym"]},
    "asymmetric_viscous": {"coefficient": lambda s: s["asymv"]},
    "position_friction": {"amplitude": lambda s: s["posf"], "cycles": lambda s: s["posn"]},
    "friction_warmup": {"share": lambda s: s["warm"], "time_constant": lambda s: s["warm_tau"]},
    "load_friction": {"coefficient": lambda s: s["loadf"]},
    "presliding": {"compliance": lambda s: 1.0 / s["dahl"]},
    "constant_torque": {"torque": lambda s: s["bias"]},
    "cable_stiffness": {"stiffness": lambda s: s["cable"], "rest_angle": lambda s: s["cable0"]},
    "base_tilt": {"torque": lambda s: math.sin(s["tilt"]) * HALF_WEIGHT * s.get("density_x", 1.0)},
    "gear_compliance": {"stiffness": lambda s: s["gearc"], "damping_time": lambda s: GEAR_DAMPING / s["gearc"]},
    "cogging": {"amplitude": lambda s: GEAR * s["cog"], "cycles": lambda s: GEAR * s["cogn"]},
    "backlash": {"gap": lambda s: s["gap"]},
    "beam_damping": {"time": lambda s: s["beam_damp"]},
    "air_drag": {"coefficient": lambda s: s["drag"]},
    "root_compliance": {"compliance": lambda s: s["root"]},
    "payload": {"mass": lambda s: s["payload"]},
    "tip_inertia": {"inertia": lambda s: s["tip_inertia"]},
    "current_lag": {"time": lambda s: s["lag"]},
    "input_delay": {"delay": lambda s: s["delay"]},
    "dead_zone": {"width": lambda s: s["dead"]},
    "saturation": {"limit": lambda s: s["sat"]},
    "rate_limit": {"rate": lambda s: s["rate"]},
    "brush_drop": {"drop": lambda s: s["brush"]},
    "tach_filter": {"time": lambda s: s["tachlag"]},
    "tach_ripple": {"amplitude": lambda s: s["trip"]},
    "strain_drift": {"rate": lambda s: s["sdrift"]},
    "strain_lag": {"time": lambda s: s["slag"]},
    "pot_nonlinearity": {"amplitude": lambda s: abs(s["potnl"]), "cycles": lambda s: s["potn"]},
    "sensor_offset": {"strain_mid": lambda s: s["off_mid"]},
    "time_offset": {"offset": lambda s: s["late"]},
}

#: constant of the diagnosis -> the rig's constant and its value in the model
CONSTANTS = {
    "torque_constant": ("kphi", 0.33),
    "motor_inertia": ("jm", 0.00193),
    "bending_stiffness": ("ei", 7.911324),
    "mass_per_length": ("density", 0.42381),
    "strain_mid_gain": ("ksg", 2.27),
    "strain_base_gain": ("ksg", 2.27),
}


def parameters(effect: str, settings: dict[str, float]) -> dict[str, float]:
    """Convert the rig's settings to the true parameters of an effect, as far as the two correspond."""
    return {key: value(settings) for key, value in PARAMETERS.get(effect, {}).items()}


def covered(case: dict[str, Any], found: dict[str, Any]) -> Iterator[tuple[str, bool]]:
    """Yield every value of a right diagnosis with a known truth, and whether its interval contains that truth."""
    for candidate in found["ranking"]:
        if candidate["accepted"] and candidate["effect"] in case["effects"]:
            for key, value in parameters(candidate["effect"], case["settings"]).items():
                if key in candidate["parameters"]:
                    yield f"{candidate['effect']}.{key}", holds(candidate["parameters"][key], value)
    for name, (setting, nominal) in CONSTANTS.items():
        if name in found["constants"]:
            yield name, holds(found["constants"][name], nominal * case["settings"].get(f"{setting}_x", 1.0))


def holds(interval: dict[str, float], value: float) -> bool:
    """Whether an interval contains a value."""
    return math.isfinite(value) and interval["low"] <= value <= interval["high"]
