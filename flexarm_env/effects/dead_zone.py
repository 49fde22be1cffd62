"""An amplifier or a valve that does not respond to small commands."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter


class DeadZone(Effect):
    """An amplifier or a valve that does not respond to small commands."""

    name = "dead_zone"
    equation = "i = command ∓ w beyond ±w, else 0"
    parameters: ClassVar = {"width": Parameter("", 0.0, 1e4, 0.1, null=0.0, meaning="w, half the zone [A or V]", of_command=True)}
    looks_like = "small commands do nothing and large ones fall short by a constant"
    confused_with = ("coulomb", "stiction")

    @staticmethod
    def drive(command, width):
        """Command ∓ w, or 0."""
        if command > width:
            return command - width
        if command < -width:
            return command + width
        return 0.0
