"""LQG with gains scheduled by the payload, estimated from the stuck arm's frequency (thesis chapter 5)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.controllers.base import Floats
from flexarm_env.controllers.lqg import LQG, LQGDesign
from flexarm_env.controllers.payload import PayloadEstimator

#: What differs between the estimators of the designs.
ESTIMATOR = ("transition", "response", "hub", "heaviest", "uphill", "fall", "sag", "drift", "output", "direct", "offset", "gain")
#: Payloads [kg] of the designs, above the modelled arm's own; each estimate uses the nearest.
PAYLOADS = (0.0, 0.1, 0.2, 0.3, 0.45)


class ScheduledLQG(LQG):
    """LQG with a design for each of a few payloads; each arm uses the design nearest to its estimated payload.

    Until an arm's first estimate, the modelled arm's own design acts.

    Args:
        arm: modelled.
        interval: control period [s].
        design: numbers that differ from those of LQGDesign.
    """

    def __init__(self, arm: Arm, interval: float, design: LQGDesign | Mapping[str, Any] | None = None) -> None:
        super().__init__(arm, interval, design)
        self.weigher = PayloadEstimator(arm, interval)
        own = arm.value("beam.tip_mass")
        self._payloads = own + np.array(PAYLOADS)
        self._designs = self._with_payloads(None)
        # where a heavier arm has fewer slow vibrations, all designs have those
        orders = {design.estimator.size for design in self._designs}
        if len(orders) > 1:
            super().__init__(arm, interval, design, min(orders))
            self._designs = self._with_payloads(min(orders))
        lifts = [design.estimator.model.lift for design in self._designs]
        #: (old, new, slow + 1, slow + 1): transforms of an estimate from one design's coordinates to another's.
        self._between = np.array([[_with_friction(np.linalg.pinv(new) @ old) for new in lifts] for old in lifts])

    def _with_payloads(self, order: int | None) -> list[LQG]:
        arms = [self.arm.with_values({"beam.tip_mass": mass}) for mass in self._payloads]
        return [LQG(arm, self.interval, self.design, order) for arm in arms]

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
        """Select the matrices of each arm's design."""
        for name in ESTIMATOR:
            setattr(self.estimator, name, self._each([getattr(design.estimator, name) for design in self._designs]))
        for name in ("gain", "stiffness", "_hub", "_furthest"):
            setattr(self, name, self._each([getattr(design, name) for design in self._designs]))

    def _each(self, designs: list[Floats]) -> Floats:
        return np.array(designs)[self._which]


def _with_friction(matrix: Floats) -> Floats:
    """Extend a matrix by a row and a column that leave the friction unchanged."""
    size = len(matrix)
    wide = np.eye(size + 1)
    wide[:size, :size] = matrix
    return wide
