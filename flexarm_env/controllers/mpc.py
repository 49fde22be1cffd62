"""Model-predictive control: the LQG's filter, friction and payload, with a quadratic program for the drive's limit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.controllers.base import Floats
from flexarm_env.controllers.estimator import product
from flexarm_env.controllers.lqg import LQG, LQGDesign, cost_to_go, costs
from flexarm_env.controllers.scheduled import ScheduledLQG
from flexarm_env.errors import InputError
from flexarm_env.thesis_drive import LIMIT

#: Commands that a program may choose; each is held longer than the one before.
MOVES = 12
#: Share of the limit that a plan has at least, where compensation takes all of it.
LEAST = 0.1
#: Flag of the solver for a program that it has solved.
SOLVED = 1


@dataclass(frozen=True)
class MPCDesign(LQGDesign):
    """Numbers of the MPC: those of the LQG, and its horizon. The program takes the place of `share`, which has no effect.

    Attributes:
        horizon: time over which commands are planned [s]; beyond it, the regulator acts without a limit.
    """

    horizon: float = 0.6


class Program:
    """The quadratic program of one model: commands over a horizon, in shares of the limit, from a state's distance to rest.

    With v the commands, e the distance and e[N] its value at the end, the cost Σ (eᵀ Q e + r v²) + e[N]ᵀ P e[N] is
    ½ vᵀ H v + vᵀ F e, with the regulator's P (Rawlings, Mayne and Diehl, Model Predictive Control (2017), section 2.5).

    Args:
        designed: the regulator of the model.
        design: horizon, and sizes of equal cost.
        limit: of the drive [A or V].

    Attributes:
        hessian: H (moves, moves).
        force: F (moves, slow).
        unlimited: (moves, slow), the solution −H⁻¹ F without the limit.
        rest: (slow,) state at rest per angle [1/rad].
    """

    def __init__(self, designed: LQG, design: MPCDesign, limit: float) -> None:
        model = designed.estimator.model
        steps = max(design.samples("horizon", designed.interval), 1)
        ends = np.unique(np.round(np.geomspace(1.0, steps, MOVES)).astype(int))
        move = np.searchsorted(ends, np.arange(steps), side="right")
        push, size = limit * model.response[:, 0], len(model.transition)
        cost, weight = costs(model, design, limit)
        self.hessian: Floats = np.zeros((len(ends),) * 2)
        self.force: Floats = np.zeros((len(ends), size))
        free, forced = np.eye(size), np.zeros((size, len(ends)))
        for k in range(steps):
            free, forced = model.transition @ free, model.transition @ forced
            forced[:, move[k]] += push
            price = cost if k < steps - 1 else cost_to_go(model, design, limit)
            self.hessian += 2.0 * forced.T @ price @ forced
            self.hessian[move[k], move[k]] += 2.0 * weight[0, 0] * limit**2
            self.force += 2.0 * forced.T @ price @ free
        self.hessian = 0.5 * (self.hessian + self.hessian.T)
        self.unlimited = np.asarray(-np.linalg.solve(self.hessian, self.force), dtype=np.float64)
        self.rest = np.asarray(np.linalg.pinv(model.lift)[:, model.names.index("hub")], dtype=np.float64)


class MPC(ScheduledLQG):
    """Command = first one of the plan that brings the estimated motion to rest at the target within the drive's limit.

    At each sample a linear model predicts the slow motion over the horizon, and a quadratic program finds the commands of least
    cost. The limit is what the compensation of friction and loads leaves of the drive's. Where the plan without a limit keeps to
    it, that plan is the solution; else DAQP, an active-set method, finds it (Arnström, Bemporad and Axehill, IEEE Trans.
    Automatic Control 67 (2022) 4362). Filter, friction, integral and payload are those of ScheduledLQG.

    Args:
        arm: modelled.
        interval: control period [s].
        design: numbers that differ from those of MPCDesign.

    Raises:
        InputError: where DAQP is not installed, or as for ScheduledLQG.
    """

    def __init__(self, arm: Arm, interval: float, design: MPCDesign | Mapping[str, Any] | None = None) -> None:
        try:
            import daqp  # an extra, and only of this controller
        except ImportError:
            raise InputError('mpc needs DAQP; pip install "flexarm-env[control]"') from None
        self._solve = daqp.solve
        self._design = MPCDesign.of(design)
        super().__init__(arm, interval, self._design)
        self._scale = self.limit if self.limit > 0.0 else LIMIT
        self._programs = [Program(each, self._design, self._scale) for each in self._designs]

    def _adopt(self) -> None:
        super()._adopt()
        self._rest = self._each([program.rest for program in self._programs])
        self._unlimited = self._each([program.unlimited for program in self._programs])

    def _regulate(self, state: Floats, target: Floats, aim: Floats, added: Floats) -> Floats:
        distance = state - target[:, None] * self._rest
        plan = product(self._unlimited, distance)
        if self.limit <= 0.0:
            return self._scale * plan[:, 0]
        taken = (added + self.loads.steady(target)) / self.limit
        low, high = np.minimum(-1.0 - taken, -LEAST), np.maximum(1.0 - taken, LEAST)
        for i in np.flatnonzero(((plan < low[:, None]) | (plan > high[:, None])).any(axis=1)):
            plan[i] = self._limited(self._programs[self._which[i]], distance[i], low[i], high[i])
        return self._scale * plan[:, 0]

    def _limited(self, program: Program, distance: Floats, low: float, high: float) -> Floats:
        """Solve the program of one arm: commands (moves,) over the limit."""
        size = len(program.hessian)
        force = np.ascontiguousarray(np.einsum("ij,j->i", program.force, distance))
        found = self._solve(
            program.hessian, force, np.zeros((0, size)), np.full(size, high), np.full(size, low), np.zeros(size, dtype=np.intc)
        )
        if found[2] == SOLVED:
            return np.asarray(found[0])
        return np.clip(np.einsum("ij,j->i", program.unlimited, distance), low, high)
