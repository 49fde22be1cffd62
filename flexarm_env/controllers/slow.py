"""The slow part of the arm's motion, on which controllers are designed, separated from the fast part."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm, schur, solve_sylvester

from flexarm_env.arm import Arm
from flexarm_env.controllers.base import Floats
from flexarm_env.linear import linearise


@dataclass(frozen=True, eq=False)
class SlowPart:
    """The slow motion of the moving arm: z[k+1] = transition z + response u, y = output z + direct u, x = lift z.

    Attributes:
        names: of the physical states x (states,).
        signals: names of the outputs.
        transition: (slow, slow).
        response: (slow, 3) to command [A or V], torque on the hub and weight [Nm].
        output: (outputs, slow).
        direct: (outputs, 3), static contribution of the fast motion.
        offset: (outputs,) readings at rest.
        lift: (states, slow).
    """

    names: tuple[str, ...]
    signals: tuple[str, ...]
    transition: Floats
    response: Floats
    output: Floats
    direct: Floats
    offset: Floats
    lift: Floats

    def row(self, name: str) -> Floats:
        """Look up the row (slow,) of a physical state."""
        return self.lift[self.names.index(name)]


def slow_part(arm: Arm, interval: float, highest_frequency: float, order: int | None = None) -> SlowPart:
    """Reduce the moving arm with rigid gears to its motion below highest_frequency [Hz] and a quarter of the sampling rate.

    The slow invariant subspace is exact, and the fast part keeps its static gain. An order leaves out the fastest of it as well,
    whole pairs at a time.
    """
    for effect in ("backlash", "gear_compliance"):
        arm = arm.without_effect(effect)
    model = linearise(arm.with_values({"drive.gear_stiffness": 0.0}), "moving", interval)
    bound = 2.0 * np.pi * min(highest_frequency, 0.25 / interval)
    sizes = np.sort(np.abs(np.linalg.eigvals(model.dynamics)))
    if order is not None and order < np.searchsorted(sizes, bound):
        bound = float(sizes[order - 1 : order + 1].mean())
    upper, basis, count = schur(model.dynamics, sort=lambda real, imag: np.hypot(real, imag) <= bound)
    slow, fast = upper[:count, :count], upper[count:, count:]
    mixed = solve_sylvester(slow, -fast, -upper[:count, count:])
    whole = np.hstack([basis[:, :count], basis[:, :count] @ mixed + basis[:, count:]])
    forcing, inputs = np.linalg.solve(whole, model.forcing), len(model.inputs)
    step = expm(np.block([[slow, forcing[:count]], [np.zeros((inputs, count + inputs))]]) * interval)
    return SlowPart(
        names=model.states,
        signals=model.outputs,
        transition=step[:count, :count],
        response=step[:count, count:],
        output=model.output @ whole[:, :count],
        direct=-model.output @ whole[:, count:] @ np.linalg.solve(fast, forcing[count:]),
        offset=model.offset,
        lift=whole[:, :count],
    )
