"""What every controller is: reset, then one command for each observation, for one arm or many at once."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.controllers.loads import KnownLoads
from flexarm_env.errors import InputError

Floats = NDArray[np.float64]

#: Limit [A] and gear ratio of the drive for which the thesis's gains are meant; other drives scale them.
THESIS_LIMIT, THESIS_GEAR_RATIO = 5.0, 1.5


class Controller(ABC):
    """A control law over what the rig measures. The same bits come out for one arm and for that arm among many.

    Beside the law's command goes what holds the hub against loads that the believed arm has (see KnownLoads).

    A reading that is not finite is replaced by that arm's last finite one (0 before there is one), so that a command is
    always finite and one bad sample does not stay in the controller's memory.

    Args:
        arm: what the controller believes the arm to be; the arm that it drives may differ.
        interval: control period [s].

    Raises:
        InputError: for an arm that does not measure what the controller needs.
    """

    #: Signals without which the controller cannot work.
    needs: tuple[str, ...] = ("arm_angle", "motor_speed")

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
        """Start an episode.

        Args:
            count: how many arms are driven at once, whose observations are (count, signals + 1); None for one arm,
                whose observations are (signals + 1,).
        """
        if count is not None and count < 1:
            raise InputError(f"reset({count}); give the number of arms, at least 1, or None for a single one")
        self._count, self._width = count, 1 if count is None else count
        self._start(self._width)

    def act(self, observation: NDArray[np.floating]) -> Floats:
        """Return the command (…,) [A or V], within the drive's limit.

        Args:
            observation: (…, signals + 1) readings in the order of the arm's signals (rad, rad/s, V, V, m), then the
                target angle [rad]; … is nothing or the count given to reset.

        Raises:
            InputError: for an observation of another shape, or before reset.
        """
        seen = np.asarray(observation, dtype=np.float64)
        shape = (len(self.signals) + 1,) if self._count is None else (self._count, len(self.signals) + 1)
        if seen.shape != shape or self._width < 0:
            raise InputError(f"observation of shape {seen.shape}; needed is {shape}: {', '.join(self.signals)}, target")
        seen = seen.reshape(self._width, -1)
        finite = np.isfinite(seen)
        self._seen = seen.copy() if finite.all() else np.where(finite, seen, self._seen)
        command = self.clipped(self.loads.met(self._command(self._seen), self._seen[:, -1]))
        self._sent(self.loads.through(command))
        return command if self._count is not None else command.reshape(())

    def action(self, observation: NDArray[np.floating]) -> NDArray[np.float32]:
        """Return the command over the drive's limit, (…, 1), as the environments take it.

        Raises:
            InputError: for a drive without a limit.
        """
        if self.limit <= 0.0:
            raise InputError(f"arm '{self.arm.name}' has no drive.limit to scale actions with; set it, or use act()")
        return (self.act(observation) / self.limit)[..., None].astype(np.float32)

    def clipped(self, command: Floats) -> Floats:
        """Return commands as the drive lets them through."""
        return np.minimum(np.maximum(command, -self.limit), self.limit) if self.limit > 0.0 else command

    def column(self, signal: str) -> int:
        """Place of a signal in an observation."""
        return self.signals.index(signal)

    def coulomb_torque(self) -> float:
        """Coulomb friction that the controller believes in [Nm, arm side]."""
        return float(dict(self.arm.present()).get("coulomb", {}).get("torque", 0.0))

    def _start(self, count: int) -> None:
        """Forget the last episode, of which there is more to forget in most controllers."""
        self._seen = np.zeros((count, len(self.signals) + 1))

    @abstractmethod
    def _command(self, seen: Floats) -> Floats:
        """Return commands (count,) from finite observations (count, signals + 1)."""

    def _sent(self, command: Floats) -> None:  # noqa: B027
        """Note the commands (count,) that act on the arms until the next observation, for laws that predict."""


def thesis_scale(arm: Arm) -> tuple[float, float]:
    """What the thesis's gains on angle and motor speed are multiplied by for an arm: by its limit and gears."""
    drive = arm.constants["drive"]
    scale = drive["limit"] / THESIS_LIMIT if drive["limit"] > 0.0 else drive["resistance"] if arm.input == "voltage" else 1.0
    return scale, scale * THESIS_GEAR_RATIO / drive["gear_ratio"]
