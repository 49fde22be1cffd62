"""PID that follows a smooth reference, with feedforward of inertia and compensation of friction."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.controllers.base import Controller, Floats
from flexarm_env.controllers.design import Design
from flexarm_env.controllers.reference import QuinticReference


@dataclass(frozen=True)
class PIDDesign(Design):
    """Numbers of the PID, the same for arms of any size.

    Attributes:
        speed: largest of the reference [rad/s].
        acceleration: largest of the reference [rad/s²].
        bandwidth: natural frequency ω of the rigid arm in closed loop [rad/s].
        damping: its damping ratio ζ.
        integral: pole of the integral over ω.
        friction: compensated share of the Coulomb torque.
        slide: speed towards the reference per angle of error, for the direction that friction opposes [1/s].
        width: of that speed, over which the compensation changes its sign [rad/s].
    """

    speed: float = 4.0
    acceleration: float = 12.0
    bandwidth: float = 4.0
    damping: float = 0.7
    integral: float = 0.2
    friction: float = 1.0
    slide: float = 5.0
    width: float = 0.3

    @classmethod
    def may_vanish(cls) -> tuple[str, ...]:
        """List the numbers that may be 0."""
        return ("integral", "friction", "slide")


class CompensatedPID(Controller):
    """Command = feedforward + kp e + ki ∫e + kd ė + friction compensation, about a quintic reference r; e = r − angle.

    The gains place the poles of the rigid arm, J s² + b s, at (s² + 2ζω s + ω²)(s + κω). The feedforward is J r̈ + b ṙ. The
    Coulomb torque is compensated in the direction of ṙ + slide · e, the speed at which a sliding law would move (Slotine and Li,
    Applied Nonlinear Control (1991), section 7.1), so that it acts on a stuck hub that is off its reference as well. The
    integral pauses while the command is at its limit.

    Args:
        arm: modelled.
        interval: control period [s].
        design: numbers that differ from those of PIDDesign.
    """

    def __init__(self, arm: Arm, interval: float, design: PIDDesign | Mapping[str, Any] | None = None) -> None:
        super().__init__(arm, interval)
        self.design = d = PIDDesign.of(design)
        structure = arm.structure()
        beam = structure.mass_per_length * structure.length**3 / 3.0
        tip = (structure.tip_mass + structure.payload) * structure.length**2 + structure.tip_inertia
        gears = structure.gear_ratio
        #: Inertia of the rigid arm [kg m²] and viscous friction [Nms], over the hub's torque per command.
        self.inertia = (structure.hub_inertia + gears**2 * structure.motor_inertia + beam + tip) / self.hub_torque_per_command
        # the voltage that the turning motor induces drives against its command
        induced = gears * structure.torque_constant if arm.input == "voltage" else 0.0
        self.viscous = structure.viscous / self.hub_torque_per_command + induced
        self.proportional = self.inertia * d.bandwidth**2 * (1.0 + 2.0 * d.damping * d.integral)
        self.integral = self.inertia * d.integral * d.bandwidth**3
        self.derivative = self.inertia * d.bandwidth * (2.0 * d.damping + d.integral) - self.viscous
        self._coulomb = d.friction * self.coulomb_torque() / self.hub_torque_per_command
        self.reference = QuinticReference(d.speed, d.acceleration, interval)
        self._gears = gears
        self._angle, self._speed = self.column("arm_angle"), self.column("motor_speed")

    def _start(self, count: int) -> None:
        super()._start(count)
        self.reference.start(count)
        self._sum = np.zeros(count)

    def _command(self, seen: Floats) -> Floats:
        angle, speed, acceleration = self.reference.update(seen[:, self._angle], seen[:, -1])
        error = angle - seen[:, self._angle]
        slow = speed - seen[:, self._speed] / self._gears
        sliding = np.clip((speed + self.design.slide * error) / self.design.width, -1.0, 1.0)
        ahead = self.inertia * acceleration + self.viscous * speed + self._coulomb * sliding
        wanted = ahead + self.proportional * error + self.derivative * slow + self._sum
        free = np.abs(wanted) < self.limit if self.limit > 0.0 else True
        self._sum = self._sum + free * self.integral * self.interval * error
        return wanted
