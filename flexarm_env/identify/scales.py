"""How large the quantities of some recordings are, over those of the thesis's arm, of which typical sizes are given."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.run import Run
from flexarm_env.plant.structure import assemble
from flexarm_env.sensors import known_sensors

#: Torque [Nm], range of angle [rad], range over the root of the time [rad/√s] and largest command [A] in recordings of the
#: thesis's arm, which is 1 m long; its inertia at the hub [kg m²].
THESIS_TORQUE, THESIS_ANGLE, THESIS_SPEED, THESIS_COMMAND, THESIS_INERTIA = 0.35, 2.5, 0.8, 5.0, 0.147


def torque_scale(arm: Arm, runs: Sequence[Run]) -> float:
    """Return the rms of the torque that the command gives at the hub [Nm]; without any, of what slows down an arm that coasts."""
    drive = arm.constants["drive"]
    per_command = drive["gear_ratio"] * drive["torque_constant"]
    if arm.input == "voltage":
        per_command /= drive["resistance"]
    command = float(np.sqrt(np.mean([np.mean(run.command**2) for run in runs])))
    return max(per_command * command, 0.0 if command > 0.0 else _slowing_torque(arm, runs), 1e-9 * per_command)


def _slowing_torque(arm: Arm, runs: Sequence[Run]) -> float:
    """Return the largest mean torque [Nm] that the change of the motor's speed over a run takes; 0 where nothing shows it."""
    if "motor_speed" not in arm.signals:
        return 0.0
    tach, ratio = arm.signals.index("motor_speed"), arm.constants["drive"]["gear_ratio"]
    return float(_inertia(arm) / ratio * max(np.ptp(run.measured[:, tach]) / run.time[-1] for run in runs))


def _inertia(arm: Arm) -> float:
    """Return an arm's inertia at the hub, unbent, with the motor's [kg m²]."""
    structure = arm.structure()
    bodies = 2 if structure.separate_motor else 1
    return float(np.trace(assemble(structure).mass[:bodies, :bodies]))


def scales_of(arm: Arm, runs: Sequence[Run], signals: Sequence[str]) -> dict[str, float]:
    """Return how many times as large quantities are, by unit, and commands for "command"."""
    torque = torque_scale(arm, runs) / THESIS_TORQUE
    angle = speed = 1.0
    if "arm_angle" in signals:
        column = signals.index("arm_angle")
        angle = max(float(np.ptp(run.measured[:, column])) for run in runs) / THESIS_ANGLE
        rates = [np.ptp(run.measured[:, column]) / np.sqrt(run.time[-1]) for run in runs]
        speed = max(float(max(rates)), 1e-12) / THESIS_SPEED
    angle = max(angle, 1e-9)
    length, inertia = arm.structure().length or 1.0, _inertia(arm) / THESIS_INERTIA
    return _signal_scales(runs, signals) | {
        "N*m": torque,
        "N*m*s": torque / speed,
        "N*m/rad": torque / angle,
        "rad/N/m": 1.0 / torque,
        "N*s**2/m**3": torque / speed**2 / length**4,
        "kg": inertia / length**2,
        "kg*m**2": inertia,
        "1/rad": 1.0 / angle,
        "rad/s": speed,
        "command": max(max(float(np.abs(run.command).max()) for run in runs) / THESIS_COMMAND, 1e-9),
    }


def _signal_scales(runs: Sequence[Run], signals: Sequence[str]) -> dict[str, float]:
    """Return how many times as large signals are, by their unit and for drift by their unit per second."""
    sizes: dict[str, float] = {}
    for i, signal in enumerate(signals):
        sensor = known_sensors()[signal]
        if sensor.usual_range is not None:
            size = max(float(np.ptp(run.measured[:, i])) for run in runs) / sensor.usual_range
            sizes[sensor.unit] = max(sizes.get(sensor.unit, 0.0), size)
    return {name: size or 1.0 for unit, size in sizes.items() for name in (unit, f"{unit}/s")}
