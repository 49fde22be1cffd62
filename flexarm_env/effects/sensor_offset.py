"""Constant offsets of the sensors' readings."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class SensorOffset(Effect):
    """Constant offsets of the sensors' readings."""

    name = "sensor_offset"
    equation = "y = y_true + offset"
    parameters: ClassVar = {
        "arm_angle": Parameter("rad", -10.0, 10.0, 0.01, null=0.0, meaning="offset of the arm's angle"),
        "motor_speed": Parameter("rad/s", -1e3, 1e3, 0.1, null=0.0, meaning="offset of the motor's speed"),
        "strain_mid": Parameter("V", -1e3, 1e3, 0.05, null=0.0, meaning="offset of the gage at mid-beam"),
        "strain_base": Parameter("V", -1e3, 1e3, 0.05, null=0.0, meaning="offset of the gage at the root"),
        "tip_deflection": Parameter("m", -10.0, 10.0, 0.005, null=0.0, meaning="offset of the tip's sensor"),
    }
    looks_like = "a signal's error is constant, independent of motion and command"
    confused_with = ("constant_torque",)

    @staticmethod
    def structure(
        structure: Structure,
        arm_angle: float,
        motor_speed: float,
        strain_mid: float,
        strain_base: float,
        tip_deflection: float,
    ) -> None:
        """Add to the sensors' offsets."""
        offsets = (arm_angle, motor_speed, strain_mid, strain_base, tip_deflection)
        names = ("arm_angle", "motor_speed", "strain_mid", "strain_base", "tip_deflection")
        for signal, offset in zip(names, offsets, strict=True):
            if signal in structure.sensors:
                structure.sensors[signal].offset += offset
