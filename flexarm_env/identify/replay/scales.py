"""Sizes of quantities in recordings over those of the thesis's arm, for which typical sizes of effects are given."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.replay.run import Run
from flexarm_env.identify.settings import LEAST_COMMAND, ReferenceSizes
from flexarm_env.plant.assembly import assemble
from flexarm_env.sensors import known_sensors


def torque_scale(arm: Arm, runs: Sequence[Run]) -> float:
    """Estimate the rms of the drive's torque at the hub [Nm]; without a command, the torque that slows down a coasting arm."""
    drive = arm.constants["drive"]
    if arm.input == "position":
        return _servo_torque(arm, runs)
    per_command = drive["gear_ratio"] * drive["torque_constant"]
    if arm.input == "voltage":
        per_command /= drive["resistance"]
    command = float(np.sqrt(np.mean([np.mean(run.command**2) for run in runs])))
    return max(per_command * command, 0.0 if command > 0.0 else _slowing_torque(arm, runs), LEAST_COMMAND * per_command)


def _servo_torque(arm: Arm, runs: Sequence[Run]) -> float:
    """Estimate the rms torque [Nm] of a servo from goal and measured angle, within its limit of voltage; 1 mrad at least."""
    structure, per_error = arm.structure(), arm.structure().torque_by_command
    largest = structure.largest_voltage / structure.position_gain
    angle = arm.signals.index("arm_angle") if "arm_angle" in arm.signals else -1
    squares = []
    for run in runs:
        error = run.command - (run.measured[:, angle] if angle >= 0 else 0.0)
        squares.append(np.nanmean(np.clip(error, -largest, largest) ** 2))
    return per_error * max(float(np.sqrt(np.mean(squares))), LEAST_COMMAND)


def _slowing_torque(arm: Arm, runs: Sequence[Run]) -> float:
    """Estimate the largest mean torque [Nm] from the change of the motor's speed over a run; 0 without that signal."""
    if "motor_speed" not in arm.signals:
        return 0.0
    tach, ratio = arm.signals.index("motor_speed"), arm.constants["drive"]["gear_ratio"]
    return float(_inertia(arm) / ratio * max(run.extent[tach] / run.time[-1] for run in runs))


def _inertia(arm: Arm) -> float:
    """Compute an arm's inertia at the hub, unbent, motor included [kg m²]."""
    structure = arm.structure()
    bodies = 2 if structure.separate_motor else 1
    return float(np.trace(assemble(structure).mass[:bodies, :bodies]))


def scales_of(arm: Arm, runs: Sequence[Run], signals: Sequence[str], reference: ReferenceSizes) -> dict[str, float]:
    """Compute the ratio of sizes to the reference, by unit, that of commands for "command" and of places for "travel"."""
    torque = torque_scale(arm, runs) / reference.torque
    angle = speed = 1.0
    if "arm_angle" in signals:
        column = signals.index("arm_angle")
        angle = max(float(run.extent[column]) for run in runs) / reference.angle
        rates = [run.extent[column] / np.sqrt(run.time[-1]) for run in runs]
        speed = max(float(max(rates)), reference.least_speed) / reference.speed
    angle = max(angle, reference.least_ratio)
    length, inertia = arm.structure().length or 1.0, _inertia(arm) / reference.inertia
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
        "travel": angle,
        "command": max(max(float(np.abs(run.command).max()) for run in runs) / reference.command, reference.least_ratio),
    }


def _signal_scales(runs: Sequence[Run], signals: Sequence[str]) -> dict[str, float]:
    """Compute the ratio of signals to their usual range, by their unit and for drift by their unit per second."""
    sizes: dict[str, float] = {}
    for i, signal in enumerate(signals):
        sensor = known_sensors()[signal]
        if sensor.usual_range is not None:
            size = max(float(run.extent[i]) for run in runs) / sensor.usual_range
            sizes[sensor.unit] = max(sizes.get(sensor.unit, 0.0), size)
    return {name: size or 1.0 for unit, size in sizes.items() for name in (unit, f"{unit}/s")}
