"""How large an effect could be and still hide in the recordings: what a verdict of "nothing missing" is worth."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.data import Data
from flexarm_env.identify.problem import score
from flexarm_env.identify.refit import Refit
from flexarm_env.identify.screen import Base, candidates, screening_base, starts_of, unexplained

#: Steps towards the size, each by at most this factor.
STEPS, LARGEST_STEP = 3, 100.0
#: Starts of an effect that are tried: of a periodic one, from its slowest to its fastest.
MOST_STARTS = 4


@dataclass(frozen=True)
class Hiding:
    """The size up to which an effect could be there without raising the error by what would have it accepted.

    Attributes:
        parameter: the one that says how strong the effect is.
        value: its largest hidden value, or its smallest where a small value is strong.
        unit: of the value.
        multiple: the same over a usual size.
    """

    parameter: str
    value: float
    unit: str
    multiple: float = 1.0

    def as_json(self) -> dict[str, Any]:
        """Plain data."""
        return {"parameter": self.parameter, "value": self.value, "unit": self.unit}


def could_hide(found: Refit, data: Data, least: float) -> dict[str, Hiding]:
    """Return the size of each effect that the arm lacks at which it would just be accepted.

    It counts by how much the effect raises the error in windows, less what the constants could take over of it: the share of
    its change of the innovations that lies along their slopes.

    Args:
        found: the arm that is left in the end.
        data: the recordings.
        least: excess error, as a variance over the noise's, from which an effect is accepted.
    """
    base = screening_base(found, data)
    out = {}
    for name in candidates(found.arm):
        effect = found.arm.known[name]
        if effect.fitted:
            starts = starts_of(base, name)
            hidden = max(
                (_hidden(base, name, start, least) for start in starts[:: -(-len(starts) // MOST_STARTS)]), key=_multiple
            )
            parameter = effect.parameters[hidden.parameter]
            if parameter.low < hidden.value < parameter.high:
                out[name] = hidden
    return out


def _multiple(hidden: Hiding) -> float:
    """Return the key by which the size that hides best comes last."""
    return hidden.multiple


def _hidden(base: Base, name: str, start: dict[str, float], least: float) -> Hiding:
    """Return the size of an effect that changes the residual by as much as is accepted, from a start, by secants."""
    effect = base.problem.arm.known[name]
    sizes = {key: p for key, p in effect.parameters.items() if p.null is not None and start[key] != 0.0}
    before = score(base.problem.arm, base.problem.data).windows ** 2
    values, multiple = dict(start), 1.0
    for _ in range(STEPS):
        arm = base.problem.arm.with_effect(name, **values)
        rise = (score(arm, base.problem.data).windows ** 2 - before) * _left_by_constants(base, arm)
        step = math.sqrt(least / max(rise, 1e-12))
        multiple *= min(max(step, 1.0 / LARGEST_STEP), LARGEST_STEP)
        for key, p in sizes.items():
            value = start[key] / multiple if p.null == math.inf else start[key] * multiple
            values[key] = min(max(value, p.low), p.high)
    key, parameter = next(iter(sizes.items()))
    return Hiding(key, abs(values[key]), parameter.unit, multiple)


def _left_by_constants(base: Base, arm: Arm) -> float:
    """Return which share of what another arm changes the constants of the first cannot take over."""
    change = base.problem.residual_of(arm) - base.residual
    left = unexplained(base, change)
    return float(np.dot(left, left) / max(np.dot(change, change), 1e-12))
