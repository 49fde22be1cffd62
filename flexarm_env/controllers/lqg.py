"""LQG: state feedback from a Kalman filter, and compensation of the estimated friction up to the Coulomb torque."""

from __future__ import annotations

import numpy as np
from scipy.linalg import solve_discrete_are

from flexarm_env.arm import Arm
from flexarm_env.controllers.base import Controller, Floats
from flexarm_env.controllers.estimator import Estimator, row_dot
from flexarm_env.controllers.slow import SlowPart
from flexarm_env.errors import InputError
from flexarm_env.thesis_drive import LIMIT

#: Sizes of equal cost in the regulator: hub angle [rad], strain as tip deflection [m], hub speed [rad/s], tip's speed against
#: the hub [m/s], and the command over the drive's limit. Chosen by trial so that the loop also tolerates an unmodelled dead
#: time of one sample of 5 ms; a stiffer design settled in 1.1 s, not 1.5, and did not tolerate it.
ANGLE, DEFLECTION, SPEED, TIP_SPEED, COMMAND = 0.12, 0.16, 1.0, 1.2, 0.25
#: Largest command for the angle's error, as a share of the drive's limit; the rest is left for the beam and friction.
SHARE = 0.9
#: Hub angle [rad] within which friction may hold the hub, and how fast the rest of the error is integrated [1/s].
REST, INTEGRATION = np.deg2rad(0.5), 1.0


class LQG(Controller):
    """Command = −K (x̂ − target) + friction compensation, with a Kalman filter for x̂ and the friction.

    The estimated friction is compensated up to the Coulomb torque of the modelled arm. That torque alone cannot move a stuck
    hub, so it does not overcompensate (thesis section 4.5 and chapter 5). Static friction above it is left to the
    integral of the angle's error, which pauses within half a degree so that the hub does not hunt.

    The design leaves out a dead time of the drive, even if the modelled arm has one.

    The error of the angle is limited, so that a long slew cruises and leaves the beam's feedback room below the limit.

    Args:
        arm: modelled.
        interval: control period [s].
    """

    def __init__(self, arm: Arm, interval: float) -> None:
        super().__init__(arm, interval)
        self.estimator = Estimator(arm, interval)
        limit = self.limit if self.limit > 0.0 else LIMIT
        self.gain = regulator_gain(self.estimator.model, COMMAND * limit)
        self._hub = self.estimator.model.row("hub")
        #: Command per angle of a hub at rest, by which the target acts.
        self.stiffness = float(self.gain @ np.linalg.pinv(self.estimator.model.lift)[:, 0])
        self._furthest = SHARE * limit / self.stiffness
        self._most_friction = self.coulomb_torque()

    def _start(self, count: int) -> None:
        super()._start(count)
        self.estimator.start(count)
        self._integral = np.zeros(count)

    def _command(self, seen: Floats) -> Floats:
        state = self.estimator.correct(seen[:, :-1])
        error = seen[:, -1] - row_dot(self._hub, state[:, :-1])
        near = np.minimum(np.maximum(error, -self._furthest), self._furthest)
        friction = np.minimum(np.maximum(state[:, -1], -self._most_friction), self._most_friction)
        # K x̂ holds the whole angle: the target, moved to where its error is at most the furthest, takes it off again
        wanted = self.stiffness * (near + seen[:, -1] - error) - row_dot(self.gain, state[:, :-1])
        self._integrate(error)
        return wanted + self._integral - friction / self.hub_torque_per_command

    def _sent(self, command: Floats) -> None:
        self.estimator.predict(command)

    def _integrate(self, error: Floats) -> None:
        """Integrate the angle's error [command] where it is small but not yet small enough, else let it fade."""
        works = (np.abs(error) > REST) & (np.abs(error) < 10.0 * REST)
        step = INTEGRATION * self.interval
        self._integral = np.where(works, self._integral + step * self.stiffness * error, self._integral * (1.0 - step))


def regulator_gain(model: SlowPart, command: float) -> Floats:
    """Compute the gain K (slow,) of the linear-quadratic regulator (Anderson and Moore, Optimal Control (1990), chapter 2).

    Args:
        model: of the arm.
        command: size [A or V] of the same cost as the other sizes.

    Raises:
        InputError: for an arm that its drive cannot move.
    """
    rows = [model.row("hub") / ANGLE, model.row("hub_rate") / SPEED]
    tip = [name for name in model.names if name.startswith("deflection") and not name.endswith("_rate")]
    if tip:
        rows += [model.row(tip[-1]) / DEFLECTION, model.row(f"{tip[-1]}_rate") / TIP_SPEED]
    push, weight = model.response[:, :1], np.array([[command**-2]])
    try:
        value = solve_discrete_are(model.transition, push, np.array(rows).T @ np.array(rows), weight)
    except (np.linalg.LinAlgError, ValueError) as error:
        raise InputError("the drive cannot regulate the arm; check its torque_constant and inertias") from error
    return np.linalg.solve(weight + push.T @ value @ push, push.T @ value @ model.transition)[0]
