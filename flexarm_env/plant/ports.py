"""The ports through which effects act inside the compiled kernel: the contract between the plant and its effects."""

from __future__ import annotations

#: Quantities that a law of each port may take, beside the effect's parameters.
PORT_ARGUMENTS: dict[str, tuple[str, ...]] = {
    "friction": ("direction", "speed", "angle", "time", "load", "at_rest"),
    "factor": ("angle", "time"),
    "presliding": ("before", "travel", "level"),
    "torque": ("angle", "speed", "time"),
    "weight": ("angle",),
    "drag": ("velocity",),
    "drive": ("command", "previous", "interval"),
    "ramp": ("command", "previous", "start", "end"),
    "spring": ("windup", "motor_angle", "stiffness"),
    "sensor": ("reading", "angle", "motor_angle", "time"),
}

#: Value of a port where no law is active, if it is not 0.
DEFAULTS = {"factor": "1.0", "presliding": "level", "drive": "command", "ramp": "command", "sensor": "reading"}
