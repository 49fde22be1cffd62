"""The lag of the angle behind the speed, which are readings of one motion: no model is needed, and no constants count."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import accumulate

import numpy as np
from numpy.typing import NDArray

from flexarm_env.identify.inspect.agreement import NOTHING_IN_COMMON, Agreement, agreement
from flexarm_env.identify.inspect.series import HUB
from flexarm_env.identify.settings import MotionFaults
from flexarm_env.recordings.recording import Recording

Floats = NDArray[np.float64]


def hub_lag(recording: Recording, gear_ratio: float, numbers: MotionFaults) -> Agreement:
    """Find a small lag of the angle behind the speed that leaves a fraction of what they differ by without it.

    A filter of the tachometer makes the speed late, never the angle. A compliant gear leaves most of the difference, and play
    explains it as well as a lag does.

    Args:
        recording: with both signals.
        gear_ratio: turns of the motor for one of the hub.
        numbers: of the method.

    Returns:
        The agreement at that lag; `NOTHING_IN_COMMON` where there is none.
    """
    turned = _Turned.of(recording, gear_ratio, numbers, numbers.longest_hub_lag)
    if len(turned.time) < numbers.least_window_cells:
        return NOTHING_IN_COMMON
    at_once = best = turned.agreement(0.0)
    step = 0.5 * numbers.longest_hub_lag
    while step > numbers.hub_lag_resolution:
        sides = [best.lag + side * step for side in (-1, 1) if abs(best.lag + side * step) <= numbers.longest_hub_lag]
        better = max(map(turned.agreement, sides), key=lambda one: one.share)
        if better.share > best.share:
            best = better
        else:
            step *= 0.5
    is_late = best.lag > numbers.least_hub_lag and best.share > numbers.alike and best.is_within(numbers.least_factor)
    is_right = is_late and 1.0 - best.share < numbers.lag_leaves * (1.0 - at_once.share)
    return best if is_right and turned.beats_play(best.lag) else NOTHING_IN_COMMON


def beats_play(recording: Recording, gear_ratio: float, lag: float, numbers: MotionFaults) -> bool:
    """Whether a lag [s] of the angle behind the speed explains much more than play at the gears.

    With play the angle is late wherever the motor turns back. Arguments as `hub_lag`.
    """
    return _Turned.of(recording, gear_ratio, numbers, max(abs(lag), numbers.longest_hub_lag)).beats_play(lag)


@dataclass(frozen=True)
class _Turned:
    """An angle beside the integral of a speed.

    Attributes:
        time: (n,) of the readings of the angle [s].
        angle: (n,) [rad].
        times: (m,) of the integral [s].
        integral: (m,) over the gear ratio [rad].
        numbers: of the method.
    """

    time: Floats
    angle: Floats
    times: Floats
    integral: Floats
    numbers: MotionFaults

    @classmethod
    def of(cls, recording: Recording, gear_ratio: float, numbers: MotionFaults, reach: float) -> _Turned:
        """Integrate the speed of a recording; keep the readings of the angle beside which it is known up to a lag [s]."""
        angle, speed = (recording.signals[signal] for signal in HUB)
        integral = _integral(*_known(recording.time, speed), gear_ratio)
        return cls(*_known(recording.time, angle), *integral, numbers).within(reach)

    def within(self, reach: float) -> _Turned:
        """Keep the readings of the angle beside which the integral is known up to a lag [s] on both sides."""
        first, last = (self.times[0], self.times[-1]) if len(self.times) else (0.0, 0.0)
        inside = (self.time >= first + reach) & (self.time <= last - reach)
        return replace(self, time=self.time[inside], angle=self.angle[inside])

    def beats_play(self, lag: float) -> bool:
        """Whether a lag [s] leaves a fraction of what play of the best width leaves."""
        if len(self.time) < self.numbers.least_window_cells:
            return True
        at_once = self.agreement(0.0)
        difference = np.sqrt(max(1.0 - at_once.share, 0.0) * at_once.power)
        plays = [self.behind_play(width * difference).agreement(0.0) for width in self.numbers.play_widths]
        return all(self.agreement(lag).explains_more_than(play, self.numbers) for play in plays)

    def behind_play(self, width: float) -> _Turned:
        """Let the integral move on only where it has crossed a gap of some width [rad]."""
        half = 0.5 * width
        return replace(self, integral=np.array(list(accumulate(self.integral, lambda at, x: min(max(at, x - half), x + half)))))

    def agreement(self, lag: float) -> Agreement:
        """Compare them at a lag [s], over the same readings at any."""
        modelled = np.interp(self.time - lag, self.times, self.integral)
        return replace(agreement(self.angle, modelled, float(np.median(np.diff(self.time))), self.numbers), lag=lag)


def _known(time: Floats, values: Floats) -> tuple[Floats, Floats]:
    known = np.isfinite(values)
    return time[known], values[known]


def _integral(time: Floats, speed: Floats, gear_ratio: float) -> tuple[Floats, Floats]:
    steps = 0.5 * np.diff(time) * (speed[1:] + speed[:-1])
    return time, np.concatenate([np.zeros(min(len(time), 1)), np.cumsum(steps)]) / gear_ratio
