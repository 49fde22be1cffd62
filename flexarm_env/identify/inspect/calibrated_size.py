"""The size of a factor or of a clock's offset, estimated with the model's constants beside it.

Wrong constants change the gains and the phases of all signals a little, and would bias a size that is read off one of them. All
recordings that have the fault are taken together, since they are of one machine.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.identify.calibrate.parameters import SHARES, FitParameters, free_parameters
from flexarm_env.identify.inspect.agreement import delayed, in_windows
from flexarm_env.identify.inspect.evidence import Evidence
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.settings import MotionFaults

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Sizing:
    """Recordings beside the model with a fault put into it.

    The unknowns x are the constants, as a calibration has them, and last the size: the logarithm of a factor, or a lag [s].

    Attributes:
        evidence: on each recording.
        fault: of all of them, with its size by now.
        constants: that move beside it.
    """

    evidence: tuple[Evidence, ...]
    fault: Fault
    constants: FitParameters

    @property
    def numbers(self) -> MotionFaults:
        """Numbers of the method."""
        return self.evidence[0].numbers

    @property
    def is_lag(self) -> bool:
        """Whether the size is a lag, not a factor."""
        return self.fault.kind == "clock"

    @property
    def start(self) -> Floats:
        """The unknowns (x,) at the constants of the arm file, and at the size by now."""
        value = self.fault.value or 1.0
        return np.append(np.zeros(len(self.constants)), value if self.is_lag else math.log(value))

    def value(self, x: Floats) -> float:
        """Compute the size at unknowns."""
        return float(x[-1]) if self.is_lag else math.exp(x[-1])

    def modelled(self, x: Floats) -> list[Floats]:
        """Replay each recording by the arm with the constants at x; cells (cells, signals)."""
        arm = self.constants.apply(self.evidence[0].replayer.arm, x[:-1])
        return [one.replayer.of(arm).free_run().modelled for one in self.evidence]

    def left(self, modelled: Sequence[Floats], size: float) -> Floats:
        """Compute measured less modelled cells (signals, cells), in windows without mean and slope; 0 where not known.

        It is NaN for a lag that has moved beyond the cells that are known.
        """
        pairs = zip(self.evidence, modelled, strict=True)
        rows = [self._windows(one, one.run.measured - self._with_fault(one, cells, size)) for one, cells in pairs]
        return np.where(self._known, np.concatenate(rows, axis=1), 0.0)

    def slopes(self) -> Floats:
        """Compute slopes (signals, cells, x) of what is left, at the start."""
        numbers, start = self.numbers, self.start
        modelled, width = self.modelled(start), numbers.constant_difference
        left = self.left(modelled, start[-1])
        columns = []
        for k in range(len(self.constants)):
            moved = start.copy()
            moved[k] += width
            columns.append((self.left(self.modelled(moved), start[-1]) - left) / width)
        width = numbers.lag_difference if self.is_lag else width
        above, below = (self.left(modelled, start[-1] + side * width) for side in (1, -1))
        return np.stack([*columns, (above - below) / (2.0 * width)], axis=2)

    def noise(self, x: Floats) -> Floats:
        """Compute the noise (signals,) of a cell's mean; that of a signal with a factor grows with it."""
        noise = np.median([one.run.noise for one in self.evidence], axis=0)
        factors = [1.0 if self.is_lag or signal != self.fault.signal else max(self.value(x), 1.0) for signal in self._signals]
        return np.asarray(noise * factors)

    @property
    def _signals(self) -> tuple[str, ...]:
        return self.evidence[0].signals

    def _with_fault(self, one: Evidence, modelled: Floats, size: float) -> Floats:
        """Put the fault into modelled cells (cells, signals)."""
        found = modelled.copy()
        for column, signal in enumerate(self._signals):
            if self.is_lag and self.fault.signal in ("", signal):
                found[:, column] = delayed(modelled[:, column], size / one.run.cell)
            elif not self.is_lag and self.fault.signal == signal:
                found[:, column] *= math.exp(size)
        return found

    def _windows(self, one: Evidence, cells: Floats) -> Floats:
        """Cut cells (cells, signals) into windows, joined again to (signals, cells)."""
        return np.stack([in_windows(values, one.run.cell, self.numbers).ravel() for values in cells.T])

    @functools.cached_property
    def _known(self) -> NDArray[np.bool_]:
        """Whether cells (signals, cells) lie in windows that are known in full, at any size near that by now."""
        margin = self.numbers.same_lag if self.is_lag else 0.0
        found = []
        for one in self.evidence:
            ends = [
                self._with_fault(one, np.zeros_like(one.run.measured), float(self.start[-1]) + side * margin) for side in (-1, 1)
            ]
            found.append(np.isfinite(self._windows(one, one.run.measured + ends[0] + ends[1])))
        return np.concatenate(found, axis=1)


def calibrated_size(evidence: Sequence[Evidence], fault: Fault) -> float:
    """Estimate the size of a factor or of a lag by Gauss–Newton steps over it and the model's constants, within their priors.

    Slopes are taken once, at the arm file's constants.

    Args:
        evidence: on the recordings that have the fault.
        fault: with a first estimate of its size, which is kept where the steps leave its neighbourhood, and where it changes
            nothing that the model shows.
    """
    replayer, first_estimate = evidence[0].replayer, float(fault.value or 1.0)
    free = free_parameters(replayer.arm, replayer.arm, replayer.dataset)
    # Gains of sensors would take the place of a factor.
    constants = FitParameters(tuple(one for one in free if one.path not in SHARES and not one.path.startswith("sensors.")))
    sizing = Sizing(tuple(evidence), fault, constants)
    numbers, x, slopes = sizing.numbers, sizing.start, sizing.slopes()
    if not slopes[:, :, -1].any():
        return first_estimate
    left = sizing.left(sizing.modelled(x), x[-1])
    close = numbers.lag_resolution if sizing.is_lag else numbers.command_close
    for _ in range(numbers.sizing_steps):
        before = x
        x, left = _step(sizing, x, left, slopes)
        if abs(x[-1] - before[-1]) < close:
            break
    far = abs(x[-1] - sizing.start[-1]) > (numbers.same_lag if sizing.is_lag else math.log(numbers.least_factor))
    return first_estimate if far else sizing.value(x)


def _step(sizing: Sizing, x: Floats, left: Floats, slopes: Floats) -> tuple[Floats, Floats]:
    """Take one Gauss–Newton step, shortened until the cost falls; none where it does not.

    Args:
        sizing: of the fault.
        x: unknowns.
        left: (signals, cells) at x.
        slopes: (signals, cells, x) of what is left.
    """
    numbers, noise = sizing.numbers, sizing.noise(x) ** 2
    # What is left beyond the noise is correlated over many cells, which count as one.
    excess = np.maximum((left**2).sum(axis=1) / np.maximum(np.count_nonzero(left, axis=1), 1) - noise, 0.0)
    weight = 1.0 / (noise + excess * numbers.correlated / sizing.evidence[0].run.cell)
    priors = np.append(sizing.constants.priors**-2.0, 0.0)
    step = np.linalg.solve(
        np.einsum("sci,s,scj->ij", slopes, weight, slopes) + np.diag(priors),
        np.einsum("sci,s,sc->i", slopes, weight, left) + priors * x,
    )
    share, now = 1.0, weight @ (left**2).sum(axis=1) + priors @ x**2
    while share > numbers.shortest_step:
        moved = x - share * step
        after = sizing.left(sizing.modelled(moved), moved[-1])
        if weight @ (after**2).sum(axis=1) + priors @ moved**2 < now:
            return moved, after
        share *= 0.5
    return x, left
