"""LQG: state feedback from a Kalman filter, and compensation of the estimated friction up to the Coulomb torque."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import solve_discrete_are

from flexarm_env.arm import Arm
from flexarm_env.controllers.base import Controller, Floats
from flexarm_env.controllers.design import Design
from flexarm_env.controllers.estimator import FRICTION_CHANGE, Estimator, row_dot
from flexarm_env.controllers.slow import SlowPart
from flexarm_env.errors import InputError
from flexarm_env.thesis_drive import LIMIT

#: Hub angle [rad] within which friction may hold the hub.
REST = np.deg2rad(0.5)


@dataclass(frozen=True)
class LQGDesign(Design):
    """Numbers of the LQG: sizes of equal cost in its regulator, and of its filter's noise.

    The default sizes were chosen by trial so that the loop also tolerates an unmodelled dead time of one sample of 5 ms; a
    stiffer design settled in 1.1 s, not 1.5, and did not tolerate it.

    Attributes:
        angle: of the hub [rad].
        deflection: strain as deflection of the tip [m].
        speed: of the hub [rad/s].
        tip_speed: of the tip against the hub [m/s].
        command: over the drive's limit.
        share: largest command for the angle's error, over the drive's limit; the rest is left for the beam and friction.
        integration: how fast a small error of the angle is integrated [1/s].
        friction_change: standard deviation of the friction's change in 5 ms [Nm].
        dead_time: assumed of the drive [s], rounded to samples.
    """

    angle: float = 0.12
    deflection: float = 0.16
    speed: float = 1.0
    tip_speed: float = 1.2
    command: float = 0.25
    share: float = 0.9
    integration: float = 1.0
    friction_change: float = FRICTION_CHANGE
    dead_time: float = 0.0

    @classmethod
    def may_vanish(cls) -> tuple[str, ...]:
        """List the numbers that may be 0."""
        return ("integration", "dead_time")


class LQG(Controller):
    """Command = −K (x̂ − target) + friction compensation, with a Kalman filter for x̂ and the friction.

    The estimated friction is compensated up to the Coulomb torque of the modelled arm. That torque alone cannot move a stuck
    hub, so it does not overcompensate (thesis section 4.5 and chapter 5). Static friction above it is left to the
    integral of the angle's error, which pauses within half a degree so that the hub does not hunt.

    A dead time of the drive is the design's, even if the modelled arm has one: the command is computed for the state at which it
    will act, predicted from the commands on their way.

    The error of the angle is limited, so that a long slew cruises and leaves the beam's feedback room below the limit.

    Args:
        arm: modelled.
        interval: control period [s].
        design: numbers that differ from those of LQGDesign.
        order: of the modelled motion at most, see Estimator.
    """

    def __init__(
        self, arm: Arm, interval: float, design: LQGDesign | Mapping[str, Any] | None = None, order: int | None = None
    ) -> None:
        super().__init__(arm, interval)
        self.design = LQGDesign.of(design)
        self.estimator = Estimator(arm, interval, friction_change=self.design.friction_change, order=order)
        limit = self.limit if self.limit > 0.0 else LIMIT
        self.gain = regulator_gain(self.estimator.model, self.design, limit)
        self._hub = self.estimator.model.row("hub")
        #: Command per angle of a hub at rest, by which the target acts.
        self.stiffness = float(self.gain @ np.linalg.pinv(self.estimator.model.lift)[:, 0])
        self._furthest = self.design.share * limit / self.stiffness
        self._most_friction = self.coulomb_torque()
        self._late = self.design.samples("dead_time", interval)

    def _start(self, count: int) -> None:
        super()._start(count)
        self.estimator.start(count)
        self._integral = np.zeros(count)
        self._on_their_way = [np.zeros(count) for _ in range(self._late)]

    def _command(self, seen: Floats) -> Floats:
        state = self.estimator.correct(seen[:, :-1])
        for command in self._on_their_way:
            state = self.estimator.ahead(state, command)
        error = seen[:, -1] - row_dot(self._hub, state[:, :-1])
        near = np.minimum(np.maximum(error, -self._furthest), self._furthest)
        friction = np.minimum(np.maximum(state[:, -1], -self._most_friction), self._most_friction)
        compensation = friction / self.hub_torque_per_command
        wanted = self._regulate(state[:, :-1], seen[:, -1], near + seen[:, -1] - error, self._integral - compensation)
        self._integrate(error)
        return wanted + self._integral - compensation

    def _regulate(self, state: Floats, target: Floats, aim: Floats, added: Floats) -> Floats:
        """Compute the regulator's commands (count,).

        Args:
            state: estimated slow motion (count, slow).
            target: (count,) [rad].
            aim: target moved to where its error is at most the furthest (count,) [rad].
            added: commands for friction and the integral, which are added afterwards (count,).
        """
        # K x̂ holds the whole angle, and the aim takes it off again
        return self.stiffness * aim - row_dot(self.gain, state)

    def _sent(self, command: Floats) -> None:
        self._on_their_way.append(command)
        self.estimator.predict(self._on_their_way.pop(0))

    def amend(self, extra: Floats) -> None:
        """Add extra commands (count,) [A or V] behind the dead zone to those of this sample, where others add to them."""
        if self._on_their_way:
            self._on_their_way[-1] = self._on_their_way[-1] + extra
        else:
            self.estimator.amend(extra)

    def _integrate(self, error: Floats) -> None:
        """Integrate the angle's error [command] where it is small but not yet small enough, else let it fade."""
        works = (np.abs(error) > REST) & (np.abs(error) < 10.0 * REST)
        step = self.design.integration * self.interval
        self._integral = np.where(works, self._integral + step * self.stiffness * error, self._integral * (1.0 - step))


def regulator_gain(model: SlowPart, design: LQGDesign, limit: float) -> Floats:
    """Compute the gain K (slow,) of the linear-quadratic regulator (Anderson and Moore, Optimal Control (1990), chapter 2).

    Args:
        model: of the arm.
        design: sizes of equal cost.
        limit: of the drive [A or V].

    Raises:
        InputError: for an arm that its drive cannot move.
    """
    push, (_, weight) = model.response[:, :1], costs(model, design, limit)
    value = cost_to_go(model, design, limit)
    return np.linalg.solve(weight + push.T @ value @ push, push.T @ value @ model.transition)[0]


def costs(model: SlowPart, design: LQGDesign, limit: float) -> tuple[Floats, Floats]:
    """Compute the costs of a sample's state (slow, slow) and command (1, 1)."""
    rows = [model.row("hub") / design.angle, model.row("hub_rate") / design.speed]
    tip = [name for name in model.names if name.startswith("deflection") and not name.endswith("_rate")]
    if tip:
        rows += [model.row(tip[-1]) / design.deflection, model.row(f"{tip[-1]}_rate") / design.tip_speed]
    return np.array(rows).T @ np.array(rows), np.array([[(design.command * limit) ** -2]])


def cost_to_go(model: SlowPart, design: LQGDesign, limit: float) -> Floats:
    """Compute the cost of a state from now on (slow, slow), under the regulator.

    Raises:
        InputError: for an arm that its drive cannot move.
    """
    try:
        return solve_discrete_are(model.transition, model.response[:, :1], *costs(model, design, limit))
    except (np.linalg.LinAlgError, ValueError) as error:
        raise InputError("the drive cannot regulate the arm; check its torque_constant and inertias") from error
