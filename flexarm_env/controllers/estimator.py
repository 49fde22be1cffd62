"""A steady-state Kalman filter of the moving arm with friction as an unknown torque: speed and strain without phase lag."""

from __future__ import annotations

import numpy as np
from scipy.linalg import solve_discrete_are

from flexarm_env.arm import Arm
from flexarm_env.controllers.base import Floats
from flexarm_env.controllers.loads import Weight
from flexarm_env.controllers.slow import slow_part
from flexarm_env.errors import InputError

#: Motion faster than this [Hz] is taken to follow at once. Control at 200 Hz should not act on it: the thesis-fem arm's third
#: vibration (44 Hz) moves with the payload, and an LQG that relies on it swings without end at 0.3 kg.
HIGHEST_FREQUENCY = 32.0
#: Standard deviation of the friction's change [Nm] and of other torque on the hub [Nm] in each sample of 5 ms.
FRICTION_CHANGE, TORQUE_NOISE, USUAL_INTERVAL = 0.02, 0.04, 0.005
#: Least standard deviation of a reading, for sensors without noise, in their own unit; and standard deviation of a gage's
#: reading due to motion that the filter leaves out [V].
LEAST_NOISE, STRAIN_LEFT_OUT = 1e-3, 0.06
#: Independent process noise of each slow coordinate, over the noise that the torque gives it.
SHARE_OF_ALL = 1.0


class Estimator:
    """Estimates the slow motion of many arms, and the friction on their hubs, from all readings and the commands.

    Dry friction, with stiction, is modelled as a random-walk torque on the hub. The filter needs no decision about sticking,
    and its estimate of a stuck hub is right as well: there the friction balances all other torque.

    Args:
        arm: modelled.
        interval: control period [s].
        highest_frequency: of the vibrations that are followed [Hz].
        friction_change: standard deviation of the friction's change in 5 ms [Nm].
        order: number of slow coordinates at most; all below the frequency by default.

    Raises:
        InputError: for an arm with a state that is not observable from its readings, or with noise that only recordings give.
    """

    def __init__(
        self, arm: Arm, interval: float, highest_frequency: float = HIGHEST_FREQUENCY,
        friction_change: float = FRICTION_CHANGE, order: int | None = None,
    ) -> None:  # fmt: skip
        self.model = slow_part(arm, interval, highest_frequency, order)
        self.size = size = len(self.model.transition)
        self.transition = np.eye(size + 1)
        self.transition[:size, :size] = self.model.transition
        self.transition[:size, size] = self.model.response[:, 1]
        self.response = np.append(self.model.response[:, 0], 0.0)
        self.direct = self.model.direct[:, 0]
        weight = Weight.of(arm)
        #: Row of the hub's angle; largest torque of the weight without payload [Nm], the angle of balance [rad], and the weight's
        #: effect, per Nm, on the state in a sample and on the readings.
        self.hub, self.heaviest, self.uphill = self.model.row("hub"), weight.torque, weight.uphill
        self.fall, self.sag = np.append(self.model.response[:, 2], 0.0), self.model.direct[:, 2]
        #: Effect of the arm's constant torque on the state in a sample, and on the readings.
        self.drift = np.append(self.model.response[:, 1], 0.0) * (torque := arm.structure().hub_torque)
        self.offset = self.model.offset + self.model.direct[:, 1] * torque
        self.output = np.hstack([self.model.output, self.model.direct[:, 1:2]])
        noise = [max(arm.reading_noise(signal), LEAST_NOISE) for signal in arm.sensors]
        extra = [STRAIN_LEFT_OUT * arm.sensor(signal).strain for signal in arm.sensors]
        self.gain = _gain(
            self.transition, self.output, self._process(interval, friction_change), np.hypot(noise, extra), arm.name
        )
        self._angle = self.model.signals.index("arm_angle")

    def _process(self, interval: float, friction_change: float) -> Floats:
        """Compute the process covariance of a sample (slow + 1, slow + 1)."""
        push = self.model.response[:, 1]
        process = np.zeros((self.size + 1,) * 2)
        process[:-1, :-1] = TORQUE_NOISE**2 * (np.outer(push, push) + SHARE_OF_ALL * np.diag(push**2))
        process[-1, -1] = friction_change**2 * interval / USUAL_INTERVAL
        return process

    def start(self, count: int) -> None:
        """Reset the estimate; the first readings set the hub's angle."""
        self.state = np.zeros((count, self.size + 1))
        self._sent = np.zeros(count)
        self._fresh = True

    def correct(self, readings: Floats) -> Floats:
        """Correct the estimate (count, slow + 1), friction last, by readings (count, signals), and return it."""
        if self._fresh:
            self._fresh = False
            angle = readings[:, self._angle] - self.model.offset[self._angle]
            self.state[:, :-1] = angle[:, None] * np.linalg.pinv(self.model.lift)[:, self.model.names.index("hub")]
        expected = product(self.output, self.state) + self._sent[:, None] * self.direct + self.offset
        if np.any(self.heaviest):
            expected += self._weight(self.state)[:, None] * self.sag
        self.state = self.state + product(self.gain, readings - expected)
        return self.state

    def predict(self, command: Floats) -> None:
        """Predict the estimate one sample ahead under commands (count,) behind the drive."""
        self.state = self.ahead(self.state, command)
        self._sent = command

    def ahead(self, state: Floats, command: Floats) -> Floats:
        """Compute the state (count, slow + 1) a sample after another one, under commands (count,) behind the drive."""
        ahead = product(self.transition, state) + command[:, None] * self.response + self.drift
        if np.any(self.heaviest):
            ahead += self._weight(state)[:, None] * self.fall
        return ahead

    def _weight(self, state: Floats) -> Floats:
        """Compute the torque of the weight without payload (count,) [Nm] at the estimated angles."""
        return self.heaviest * np.sin(row_dot(self.hub, state[:, :-1]) - self.uphill)

    def amend(self, extra: Floats) -> None:
        """Add the effect of a command extra (count,) [A or V] to that of the last prediction."""
        self.state = self.state + extra[:, None] * self.response
        self._sent = self._sent + extra

    def reading(self, signal: str) -> Floats:
        """Estimate a sensor's reading without noise and offset (count,)."""
        place = self.model.signals.index(signal)
        found = row_dot(self.output[place], self.state) + self._sent * self.direct[place]
        return found + self._weight(self.state) * self.sag[place] if np.any(self.heaviest) else found


def product(matrix: Floats, vectors: Floats) -> Floats:
    """Multiply matrix (rows, columns), or one for each (count, rows, columns), by vectors (count, columns).

    Without BLAS: its rounding depends on the number of vectors.
    """
    return np.einsum("...ij,...j->...i", matrix, vectors)


def row_dot(row: Floats, vectors: Floats) -> Floats:
    """Multiply row (columns,), or one for each (count, columns), by vectors (count, columns): (count,)."""
    return np.einsum("...j,...j->...", row, vectors)


def _gain(transition: Floats, output: Floats, process: Floats, noise: Floats, name: str) -> Floats:
    try:
        covariance = solve_discrete_are(transition.T, output.T, process, np.diag(noise**2))
    except (np.linalg.LinAlgError, ValueError) as error:
        raise InputError(f"arm '{name}': its readings do not show its state; add arm_angle, motor_speed, strain_base") from error
    seen = output @ covariance @ output.T + np.diag(noise**2)
    return np.ascontiguousarray(np.linalg.solve(seen, output @ covariance).T)
