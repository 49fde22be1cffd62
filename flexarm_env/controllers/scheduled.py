"""LQG whose gains follow the payload that the stuck arm's frequency shows (thesis chapter 5)."""

from __future__ import annotations

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.controllers.base import Floats
from flexarm_env.controllers.lqg import LQG
from flexarm_env.controllers.payload import PayloadEstimator

#: Payloads [kg] that gains are worked out for, over the believed arm's own; an estimate takes the nearest.
PAYLOADS = (0.0, 0.1, 0.2, 0.3, 0.45)


class ScheduledLQG(LQG):
    """LQG with a design for each of a few payloads; each arm uses that of its own estimated payload.

    Until an arm has come to rest once, nothing is known and the believed arm's design acts.

    Args:
        arm: believed.
        interval: control period [s].
    """

    def __init__(self, arm: Arm, interval: float) -> None:
        super().__init__(arm, interval)
        self.weigher = PayloadEstimator(arm, interval)
        own = arm.value("beam.tip_mass")
        self._payloads = own + np.array(PAYLOADS)
        self._designs = [LQG(arm.with_values({"beam.tip_mass": mass}), interval) for mass in self._payloads]
        lifts = [design.estimator.model.lift for design in self._designs]
        #: (old, new, slow + 1, slow + 1): what an estimate in one design's coordinates is in another's.
        self._between = np.array([[_with_friction(np.linalg.pinv(new) @ old) for new in lifts] for old in lifts])

    def _start(self, count: int) -> None:
        super()._start(count)
        self.weigher.start(count)
        self._which = np.zeros(count, dtype=int)
        self._adopt()

    def _command(self, seen: Floats) -> Floats:
        payload = self.weigher.update(seen)
        which = np.abs(payload[:, None] - self._payloads).argmin(axis=1)
        if not np.array_equal(which, self._which):
            self.estimator.state = np.einsum("nij,nj->ni", self._between[self._which, which], self.estimator.state)
            self._which = which
            self._adopt()
        return super()._command(seen)

    def _adopt(self) -> None:
        """Give each arm the matrices of its design."""
        for name in ("transition", "response", "drift", "output", "direct", "offset", "gain"):
            setattr(self.estimator, name, self._each([getattr(design.estimator, name) for design in self._designs]))
        for name in ("gain", "stiffness", "_hub", "_furthest"):
            setattr(self, name, self._each([getattr(design, name) for design in self._designs]))

    def _each(self, designs: list[Floats]) -> Floats:
        return np.array(designs)[self._which]


def _with_friction(matrix: Floats) -> Floats:
    """Return the matrix with a row and column more that leave the friction as it is."""
    size = len(matrix)
    wide = np.eye(size + 1)
    wide[:size, :size] = matrix
    return wide
