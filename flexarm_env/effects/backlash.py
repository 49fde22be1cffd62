"""Play between the teeth of the gears: motor and hub are decoupled within the gap."""

from __future__ import annotations

from typing import ClassVar

from flexarm_env.effects.base import Effect
from flexarm_env.parameters import Parameter
from flexarm_env.plant.structure import Structure


class Backlash(Effect):
    """Play between the teeth of the gears: motor and hub are decoupled within the gap."""

    name = "backlash"
    equation = "no torque through the gears while |θ_m − Nθ| < gap/2"
    parameters: ClassVar = {"gap": Parameter("rad", 0.0, 1.0, 0.03, null=0.0, meaning="full width, at the motor")}
    looks_like = "at each reversal the motor runs free for a moment, then jolts; speed and strain ring where the gears meet"
    confused_with = ("gear_compliance", "input_delay")
    source = "thesis section 2.1; Nordin and Gutman, Automatica 38 (2002) 1633"
    needs = ("motor_speed", "motor_inertia", "hub_inertia")

    @staticmethod
    def structure(structure: Structure, gap: float) -> None:
        """Open the gears by the gap."""
        structure.gear_gap += gap

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """Narrow and wide gaps: the error has local minima in between."""
        return [{"gap": gap} for gap in (0.02, 0.05, 0.2)]
