"""Drift of the strain gages' zero while they and their amplifier warm up."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class StrainDrift(Effect):
    """Drift of the strain gages' zero while they and their amplifier warm up."""

    name = "strain_drift"
    equation = "y = strain + r t"
    parameters: ClassVar = {
        "rate": Parameter("V/s", -100.0, 100.0, 0.01, null=0.0, meaning="r, of both gages, from the recording's start")
    }
    looks_like = "the error of both strain signals is a straight line in time; angle and speed fit"
    confused_with = ("sensor_offset",)
    needs = ("strain_mid",)
    reads = ("strain_mid", "strain_base")

    @staticmethod
    def sensor(reading, time, rate):
        """Strain + r t."""
        return reading + rate * time
