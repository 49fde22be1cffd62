"""Base of the controllers: reset, then one command for each observation, for one arm or many at once."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.controllers.loads import KnownLoads
from flexarm_env.errors import InputError

Floats = NDArray[np.float64]


class Controller(ABC):
    """A control law on the rig's readings. An arm gets the same bits alone and among many.

    The loads of the modelled arm (see KnownLoads) are compensated in addition to the law's command.

    A reading that is not finite is replaced by that arm's last finite one (0 before there is one), so that a command is
    always finite and one bad sample does not stay in the controller's memory.

    Args:
        arm: model on which the controller is designed; the driven arm may differ.
        interval: control period [s].

    Raises:
        InputError: for an arm that lacks a measurement that the controller needs.
    """

    #: Signals without which the controller cannot work.
    needs: tuple[str, ...] = ("arm_angle", "motor_speed")
    #: Motor speeds [rad/s], one in each region in which the law is another linear one.
    regions: tuple[float, ...] = (0.0,)

    def __init__(self, arm: Arm, interval: float) -> None:
        if not (math.isfinite(interval) and interval > 0.0):
            raise InputError(f"interval {interval:g} s; give a positive number such as 0.005")
        signals = list(arm.signals)
        missing = [signal for signal in self.needs if signal not in signals]
        if missing:
            has = ", ".join(signals) or "nothing"
            raise InputError(
                f"{type(self).__name__} needs {' and '.join(missing)}, arm '{arm.name}' measures {has}; "
                f"add [sensors.{missing[0]}] to the arm or choose another controller"
            )
        self.arm, self.interval, self.signals = arm, interval, signals
        self.limit = arm.constants["drive"]["limit"]
        #: Torque on the hub per command [Nm/A or Nm/V] of a motor that stands still.
        self.hub_torque_per_command = arm.structure().torque_by_command
        self.loads = KnownLoads(arm)
        self._count: int | None = None
        self._width = -1
        self._seen = np.zeros((0, 0))

    def reset(self, count: int | None = None) -> None:
        """Start an episode: clear the controller's memory.

        Args:
            count: number of arms, with observations (count, signals + 1); None for one arm, with observations
                (signals + 1,).

        Raises:
            InputError: for a count below 1.
        """
        if count is not None and count < 1:
            raise InputError(f"reset({count}); give the number of arms, at least 1, or None for a single one")
        self._count, self._width = count, 1 if count is None else count
        self._start(self._width)

    def act(self, observation: NDArray[np.floating]) -> Floats:
        """Compute the command (…,) [A or V], within the drive's limit.

        Args:
            observation: (…, signals + 1) readings in the order of the arm's signals (rad, rad/s, V, V, m), then the
                target angle [rad]; … is nothing or the count given to reset.

        Raises:
            InputError: for an observation of another shape, or before reset.

        Examples:
            >>> from flexarm_env.controllers import make_controller
            >>> controller = make_controller("pd", Arm.load("thesis"), interval=0.005)
            >>> controller.reset(count=2)
            >>> observations = np.zeros((2, 5))
            >>> observations[:, -1] = [0.5, 4.0]  # targets [rad]
            >>> controller.act(observations)
            array([1.2654, 5.    ])
        """
        seen = np.asarray(observation, dtype=np.float64)
        shape = (len(self.signals) + 1,) if self._count is None else (self._count, len(self.signals) + 1)
        if seen.shape != shape or self._width < 0:
            raise InputError(f"observation of shape {seen.shape}; needed is {shape}: {', '.join(self.signals)}, target")
        seen = seen.reshape(self._width, -1)
        finite = np.isfinite(seen)
        self._seen = seen.copy() if finite.all() else np.where(finite, seen, self._seen)
        command = self.clipped(self.loads.compensated(self._command(self._seen), self._seen[:, -1]))
        self._sent(self.loads.behind_dead_zone(command))
        return command if self._count is not None else command.reshape(())

    def action(self, observation: NDArray[np.floating]) -> NDArray[np.float32]:
        """Compute the command over the drive's limit (…, 1), the action of an environment.

        Raises:
            InputError: for a drive without a limit.
        """
        if self.limit <= 0.0:
            raise InputError(f"arm '{self.arm.name}' has no drive.limit to scale actions with; set it, or use act()")
        return (self.act(observation) / self.limit)[..., None].astype(np.float32)

    def clipped(self, command: Floats) -> Floats:
        """Limit commands to the drive's range."""
        return np.minimum(np.maximum(command, -self.limit), self.limit) if self.limit > 0.0 else command

    def column(self, signal: str) -> int:
        """Look up the column of a signal in an observation."""
        return self.signals.index(signal)

    def coulomb_torque(self) -> float:
        """Look up the Coulomb friction of the modelled arm [Nm, arm side]."""
        return float(dict(self.arm.present()).get("coulomb", {}).get("torque", 0.0))

    def _start(self, count: int) -> None:
        """Clear the memory of the last episode; controllers with more memory extend this."""
        self._seen = np.zeros((count, len(self.signals) + 1))

    @abstractmethod
    def _command(self, seen: Floats) -> Floats:
        """Compute commands (count,) from finite observations (count, signals + 1)."""

    def _sent(self, command: Floats) -> None:  # noqa: B027
        """Record the commands (count,) that act on the arms until the next observation, for laws that predict."""
