"""Machines of one joint for tests, as tables of arm files: a link under gravity, an elastic joint, a servo."""

from __future__ import annotations

from typing import Any

from flexarm_env import Arm

LINK = {"mass": 0.5, "centre": 0.2, "inertia": 0.025, "length": 0.4, "vertical": True}
ENCODERS: dict[str, Any] = {"arm_angle": {"noise": 1e-3}, "motor_speed": {"noise": 0.02}}


def pendulum(**changes: Any) -> Arm:
    """Build a pendulum that a torque drives; changes are keys of [link]."""
    table = {"drive": {"input": "torque", "limit": 3.0}, "link": LINK | changes, "sensors": ENCODERS}
    return Arm.from_table(table, "pendulum")


def elastic_joint(**changes: Any) -> Arm:
    """Build a link on a spring, on a level plane, driven by voltage; changes are keys of [joint]."""
    drive = {"input": "voltage", "torque_constant": 0.00768, "gear_ratio": 70.0, "motor_inertia": 4.6e-7}
    drive |= {"resistance": 2.6, "efficiency": 0.62, "limit": 10.0}
    table = {
        "drive": drive,
        "hub": {"inertia": 1e-4},
        "joint": {"stiffness": 1.3, "damping": 0.004} | changes,
        "link": {"mass": 0.065, "centre": 0.15, "inertia": 0.0038, "length": 0.3},
        "sensors": ENCODERS | {"link_angle": {"noise": 1e-3}},
    }
    return Arm.from_table(table, "elastic joint")


def servo(**changes: Any) -> Arm:
    """Build a small servo with a pendulum; changes are keys of [drive]."""
    drive = {"input": "position", "torque_constant": 0.387, "gear_ratio": 1.0, "motor_inertia": 0.00181, "resistance": 4.02}
    drive |= {"proportional": 400.0, "error_gain": 0.002877, "supply_voltage": 7.4, "limit": 2.0} | changes
    link = {"mass": 0.49, "centre": 0.1, "inertia": 0.0049, "length": 0.1, "vertical": True}
    return Arm.from_table({"drive": drive, "link": link, "sensors": {"arm_angle": {"noise": 4e-4}}}, "servo")
