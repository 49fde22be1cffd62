"""Names, units and order of the measured signals."""

from __future__ import annotations

#: SI unit of each signal that a recording may hold, in the order in which the plant gives them.
SIGNALS: dict[str, str] = {
    "arm_angle": "rad",
    "motor_speed": "rad/s",
    "strain_mid": "V",
    "strain_base": "V",
    "tip_deflection": "m",
}

#: SI unit of each kind of command.
INPUTS: dict[str, str] = {"current": "A", "voltage": "V"}
