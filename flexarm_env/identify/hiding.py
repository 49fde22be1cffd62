"""How large an effect could be and still hide in the recordings: what a verdict of "nothing missing" is worth."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from joblib import Parallel, delayed

from flexarm_env.arm import Arm
from flexarm_env.identify.data import Data
from flexarm_env.identify.problem import brief_score
from flexarm_env.identify.refit import Refit
from flexarm_env.identify.screen import Base, candidates, screening_base, sized, starts_of, unexplained

#: The size is brought down by at most the first factor at once, and up by the second: an effect that only acts from some size
#: on, as a limit does, shows nothing below. So many steps are taken before the last, and so many where only windows tell.
LARGEST_STEP_DOWN, LARGEST_STEP_UP, STEPS, WINDOW_STEPS = 100.0, 3.0, 4, 2
#: Process noise of the innovations, over the rms of the drive's torque. An effect raises the error in windows more than theirs,
#: in which feedback hides it, by about the factor.
LEVEL, IN_WINDOWS = 0.01, 25.0
#: A smaller size that leaves more than this share of a change hardly lowers it.
STAYS = 0.7
#: A change that is as good as none, and one of the size (a logarithm) that ends the steps.
LEAST_CHANGE, CLOSE = 1e-12, 0.2
#: Starts of an effect that are tried: of a periodic one, from its slowest to its fastest.
MOST_STARTS = 3


@dataclass(frozen=True)
class Hiding:
    """The size up to which an effect could be there without raising the error by what would have it accepted.

    Attributes:
        parameter: the one that says how strong the effect is.
        value: its largest hidden value, or its smallest where a small value is strong.
        unit: of the value.
    """

    parameter: str
    value: float
    unit: str

    def as_json(self) -> dict[str, Any]:
        """Plain data."""
        return {"parameter": self.parameter, "value": self.value, "unit": self.unit}


def could_hide(found: Refit, data: Data, least: float, jobs: int = 1) -> dict[str, Hiding]:
    """Return the size of each effect that the arm lacks at which it would just be accepted.

    It counts by how much the effect raises the error in windows, less what the constants could take over of it: the share of
    its change of the innovations that lies along their slopes.

    Args:
        found: the arm that is left in the end.
        data: the recordings.
        least: excess error, as a variance over the noise's, from which an effect is accepted.
        jobs: processes.
    """
    base = screening_base(found, data, (LEVEL,))
    before = brief_score(found.arm, data) ** 2
    known = found.arm.known
    names = [
        n for n in candidates(found.arm) if known[n].fitted and any(p.null is not None for p in known[n].parameters.values())
    ]
    sized = Parallel(n_jobs=jobs)(delayed(_hidden)(base, name, before, data, least) for name in names)
    return {name: hiding for name, hiding in zip(names, sized, strict=True) if hiding}


def _hidden(base: Base, name: str, before: float, data: Data, least: float) -> Hiding | None:
    """Return the size at which one effect would just be accepted; None where no size within its bounds would be."""
    starts = starts_of(base, name)
    tried = [_Tried(base, name, start) for start in starts[:: -(-len(starts) // MOST_STARTS)]]
    for one in tried:
        one.settle(least / IN_WINDOWS)
    hidden = max(tried, key=lambda one: one.multiple)
    rise = 0.0
    for _ in range(1 if hidden.settled else WINDOW_STEPS):
        change, left = hidden.change() if hidden.settled else (1.0, 1.0)
        rise = brief_score(hidden.arm, data) ** 2 - before
        hidden.step(least, rise * left / max(change, LEAST_CHANGE))
    parameter = base.problem.arm.known[name].parameters[hidden.key]
    if rise <= 0.0 or not parameter.low < hidden.value < parameter.high:
        return None
    return Hiding(hidden.key, hidden.value, parameter.unit)


class _Tried:
    """An effect of a size that is brought to where it would be accepted, from a start of its own."""

    def __init__(self, base: Base, name: str, start: dict[str, float]) -> None:
        self.base, self.name, self.start = base, name, start
        known = base.problem.arm.known[name].parameters
        self.key = next(key for key, p in known.items() if p.null is not None and start[key] != 0.0)
        self.multiple, self.settled = 1.0, True

    @property
    def values(self) -> dict[str, float]:
        """Parameters at the present size; one whose absence is infinity is the stronger the smaller it is."""
        return sized(self.base.problem.arm, self.name, self.start, self.multiple)

    @property
    def value(self) -> float:
        """The present size."""
        return abs(self.values[self.key])

    @property
    def arm(self) -> Arm:
        """The arm with the effect."""
        return self.base.problem.arm.with_effect(self.name, **self.values)

    def change(self) -> tuple[float, float]:
        """Return by how much the effect changes the innovations, as a variance, and what of it constants cannot take over."""
        change = self.base.problem.residual_of(self.arm) - self.base.residual
        left = unexplained(self.base, change)
        return float(np.mean(change**2)), float(np.mean(left**2))

    def settle(self, wanted: float) -> None:
        """Scale the size until what constants cannot take over of the change of the innovations is as wanted.

        An effect that brings a state of its own changes them however small it is, with the gains of the feedback.
        """
        last = math.inf
        for _ in range(STEPS):
            before, left = self.multiple, self.change()[1]
            if before < 1.0 and left > STAYS * last:
                self.multiple, self.settled = 1.0, False
                break
            last = left
            self.step(wanted, left)
            if abs(math.log(self.multiple / before)) < CLOSE:
                break

    def step(self, wanted: float, rise: float) -> None:
        """Scale the size to where a variance that grows with its square is as wanted."""
        factor = math.sqrt(wanted / max(rise, LEAST_CHANGE))
        self.multiple *= min(max(factor, 1.0 / LARGEST_STEP_DOWN), LARGEST_STEP_UP)
