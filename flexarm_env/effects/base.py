"""The base of an effect: parameters, an equation, and one or more ports through which it acts."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Mapping
from typing import ClassVar

from flexarm_env.parameters import Parameter
from flexarm_env.plant.ports import PORT_ARGUMENTS


class Effect:
    """A physical effect that an arm may have. Subclasses state the attributes below and give at least one port.

    Ports are static methods; an effect without the port leaves it out.

    - ``structure(structure, <parameters>)`` edits the arm's linear quantities (`flexarm_env.plant.structure.Structure`).
    - ``friction(<named quantities>, <parameters>)`` returns the effect's part of the budget of dry friction [Nm], from any
      of direction (±1), speed (along the direction, ≥ 0) [rad/s], angle [rad], time [s], load (torque that the gears carry,
      arm side; of rigid gears, the drive's) [Nm], at_rest (bool).
    - ``factor(…)`` returns the factor on all dry friction, from any of angle, time.
    - ``presliding(…)`` returns the friction [Nm] of a hub that yields before it slides, from any of before (the friction so
      far), travel since then [rad], level (the dry friction of sliding, ≥ 0). All dry friction then acts on the hub.
    - ``torque(…)`` returns a torque on the hub [Nm], from any of angle, speed, time.
    - ``weight(…)`` returns the torque about the hub [Nm] of a force on beam and payload in proportion to their mass, from angle.
    - ``drag(…)`` returns a force per length on the beam [N/m], from velocity [m/s].
    - ``drive(…)`` returns the command that gets through [A or V], from command, previous, interval [s].
    - ``ramp(…)`` returns the mean [A or V] over a part of a sample of a drive that is on its way to that command, from command,
      previous, start and end of the part [s], counted from where it left previous.
    - ``spring(…)`` returns a torque in gears that wind up, or in a joint [Nm, arm side], beside that of their linear spring, from
      windup [rad, arm side], motor_angle [rad], stiffness [Nm/rad]. It turns the hub and turns back the motor.
    - ``sensor(…)`` returns the reading of each sensor of `reads`, in SI units, from reading (without the effect), angle of the
      hub [rad], motor_angle [rad], time [s].

    All but the first run in the compiled kernel: plain arithmetic and `math` only.

    Attributes:
        name: as in arm files and on the command line.
        equation: for a person.
        parameters: by name, in the order in which the ports take them.
        looks_like: its signs in data.
        confused_with: effects that look alike in most data.
        source: paper or textbook.
        varies: whether its friction changes while the hub turns one way.
        motor_share: the constant of the drive that says which part of its friction acts on the motor; "" for none.
        reads: the signals that its sensor port changes, those of them that the arm has; "strain" for every strain gage.
        per_sensor: whether each parameter belongs to the signal of its name, and is none where the arm does not measure that.
        pairs_with_all: whether each other effect is tried beside it as well, because it makes up for them and they for it.
        scan_phase: the parameter that shifts its sine, which the screening turns by half where the sign is wrong; "" for none.
        most_elements: finite elements of a beam beyond which it is no candidate.
        condition: the condition of a recording, as in "# payload = 0.3 kg", that is added to its size; "" for none.
        modifies: the effect that it changes and without which it is no candidate, "" for none; friction that changes "viscous" is
            that of a lubricant, and not dry.
        needs: required of the arm: names of parts as in `Arm.has`, of signals, "strain" for any strain gage, or its input.
        fitted: whether its parameters can be fitted (a count cannot).
    """

    name: ClassVar[str]
    equation: ClassVar[str]
    parameters: ClassVar[Mapping[str, Parameter]]
    looks_like: ClassVar[str]
    confused_with: ClassVar[tuple[str, ...]] = ()
    source: ClassVar[str] = ""
    varies: ClassVar[bool] = False
    motor_share: ClassVar[str] = ""
    reads: ClassVar[tuple[str, ...]] = ()
    per_sensor: ClassVar[bool] = False
    pairs_with_all: ClassVar[bool] = False
    scan_phase: ClassVar[str] = ""
    most_elements: ClassVar[float] = math.inf
    condition: ClassVar[str] = ""
    modifies: ClassVar[str] = ""
    needs: ClassVar[tuple[str, ...]] = ()
    fitted: ClassVar[bool] = True

    @classmethod
    def port(cls, name: str) -> Callable[..., float] | None:
        """Look up the function of a port, or None."""
        found: Callable[..., float] | None = getattr(cls, name, None)
        return found

    @classmethod
    def quantities(cls) -> int:
        """Number of quantities, such as angle, speed and time, on which its laws depend; linear terms depend on none."""
        ports = [function for name in PORT_ARGUMENTS if (function := cls.port(name))]
        return sum(len(set(inspect.signature(function).parameters) - set(cls.parameters)) for function in ports)

    @classmethod
    def absent(cls, values: Mapping[str, float]) -> bool:
        """Whether these values make the effect vanish: every size parameter at its null."""
        sizes = [(values[key], p.null) for key, p in cls.parameters.items() if p.null is not None]
        return bool(sizes) and all(value == null for value, null in sizes)

    @classmethod
    def null_values(cls) -> dict[str, float]:
        """Values that make the effect vanish; typical ones of parameters that have no null."""
        return {key: p.typical if p.null is None else p.null for key, p in cls.parameters.items()}

    @classmethod
    def starts(cls) -> list[dict[str, float]]:
        """Sets of values from which a search for the effect in data should start."""
        typical = {key: p.typical for key, p in cls.parameters.items()}
        return [typical]

    @classmethod
    def cycles_per_turn(cls, values: Mapping[str, float]) -> float:
        """Periods of its sine in a turn of the arm; infinite where it is no sine of the arm's angle."""
        return values.get("cycles", math.inf) if cls.scan_phase else math.inf

    @classmethod
    def size_parameter(cls) -> str:
        """Name of the parameter that says how strong the effect is."""
        return next((key for key, p in cls.parameters.items() if p.null is not None), next(iter(cls.parameters)))


def torque_size(meaning: str, typical: float = 0.05, low: float = 0.0) -> Parameter:
    """A torque at the hub, with zero as its null."""
    return Parameter("N*m", low, 1e4, typical, null=0.0, meaning=meaning)
