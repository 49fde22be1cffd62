"""A linear control law on measured signals: its gains, and its state while it runs."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

#: Factors of a gain, in SI: numbers, and names of conditions that a recording states.
Gain = tuple[float | str, ...]
#: The signal whose set point is the reference; that of every other is 0.
FOLLOWS = "arm_angle"


@dataclass(frozen=True)
class Feedback:
    """Feedback of one signal y with set point r: proportional (r − y) + integral ∫(r − y) dt − derivative dy/dt.

    Attributes:
        signal: its name; r is the reference for the arm angle, else 0.
        proportional: gain in command per signal; () for none, as the other two.
        integral: in command per signal and second.
        derivative: in command per signal per second.
        filter: time constant of a low-pass on y [s].
        derivative_filter: time constant of a low-pass on dy/dt [s].
        derivative_span: time over which the slope dy/dt is taken [s]; 0 for one period of the controller.
    """

    signal: str
    proportional: Gain = ()
    integral: Gain = ()
    derivative: Gain = ()
    filter: float = 0.0
    derivative_filter: float = 0.0
    derivative_span: float = 0.0

    @property
    def gains(self) -> dict[str, Gain]:
        """The gains by their names."""
        return {"proportional": self.proportional, "integral": self.integral, "derivative": self.derivative}


@dataclass(frozen=True)
class ControlLaw:
    """The law by which a command follows from measured signals and a reference: the sum of all feedback, limited.

    P, PD and PID are feedback of the arm angle; state feedback has several signals; a velocity loop within a position loop is a
    proportional gain with two factors.

    Attributes:
        feedback: of each signal.
        limit: of the command [A or V]; 0 for that of the drive.
        rate: of the controller [Hz], which holds its command in between; 0 for that of the recording.
        delay: from a reading to its command [s].

    Example:
        >>> law = ControlLaw((Feedback("arm_angle", ("K1",), derivative=(0.2,)),), limit=10.0)
        >>> law.conditions
        ('K1',)
        >>> running = law.with_conditions({"K1": 6.0}).start(0.001, readings=[0.0])
        >>> [round(running.command([angle], reference=0.5), 2) for angle in (0.0, 0.01)]
        [3.0, 0.94]
    """

    feedback: tuple[Feedback, ...]
    limit: float = 0.0
    rate: float = 0.0
    delay: float = 0.0

    @property
    def signals(self) -> tuple[str, ...]:
        """Names of the signals that are fed back."""
        return tuple(one.signal for one in self.feedback)

    @property
    def conditions(self) -> tuple[str, ...]:
        """Names of the conditions that a recording must state, in their order."""
        factors = [factor for one in self.feedback for gain in one.gains.values() for factor in gain]
        return tuple(dict.fromkeys(factor for factor in factors if isinstance(factor, str)))

    def with_conditions(self, conditions: Mapping[str, float]) -> ControlLaw:
        """Replace the names in gains by the values [SI] of a recording's conditions; names that it lacks stay."""

        def stated(gain: Gain) -> Gain:
            return tuple(conditions.get(factor, factor) if isinstance(factor, str) else factor for factor in gain)

        named = (
            replace(
                one,
                proportional=stated(one.proportional),
                integral=stated(one.integral),
                derivative=stated(one.derivative),
            )
            for one in self.feedback
        )
        return replace(self, feedback=tuple(named))

    def start(self, interval: float, readings: Sequence[float], slopes: Sequence[float] = (), command: float = 0.0) -> RunningLaw:
        """Start the law at rest at its first readings, or in steady motion through them.

        Args:
            interval: between the samples at which it will be read [s].
            readings: of its signals, SI units.
            slopes: of its signals before, per second; none by default.
            command: before the first one, during the delay [A or V].

        Raises:
            ValueError: for a gain with a name that no condition has replaced.
        """
        if self.conditions:
            raise ValueError(f"gains without a value: {', '.join(self.conditions)}")
        return RunningLaw(self, interval, readings, slopes or [0.0] * len(readings), command)


class _RunningFeedback:
    """State of the feedback of one signal."""

    def __init__(self, stated: Feedback, period: float, reading: float, slope: float) -> None:
        self.proportional, self.integral, self.derivative = (
            math.prod(map(float, gain)) if gain else 0.0 for gain in stated.gains.values()
        )
        self.follows = stated.signal == FOLLOWS
        self.period = period
        self.kept = stated.filter / (period + stated.filter)
        self.slope_kept = stated.derivative_filter / (period + stated.derivative_filter)
        span = max(round(stated.derivative_span / period), 1)
        self.span = span * period
        self.before = deque([reading - slope * period * j for j in range(span, 0, -1)])
        self.filtered, self.slope, self.sum = reading, slope, 0.0

    def part(self, reading: float, reference: float) -> float:
        """Compute this signal's part of the command, and go on by one period."""
        self.filtered = reading + self.kept * (self.filtered - reading)
        self.before.append(self.filtered)
        slope = (self.filtered - self.before.popleft()) / self.span
        self.slope = slope + self.slope_kept * (self.slope - slope)
        error = (reference if self.follows else 0.0) - self.filtered
        part = self.proportional * error + self.integral * self.sum - self.derivative * self.slope
        self.sum += error * self.period
        return part


class RunningLaw:
    """A control law with its state: slopes, filters, integrals, and commands on their way.

    Args:
        law: with numbers as gains.
        interval: between samples [s]; a controller that is faster runs once a sample.
        readings: of its signals at the start.
        slopes: of them before.
        command: before the first one [A or V].
    """

    def __init__(
        self, law: ControlLaw, interval: float, readings: Sequence[float], slopes: Sequence[float], command: float
    ) -> None:
        self.period = max(1.0 / law.rate, interval) if law.rate > 0.0 else interval
        self.periods_per_sample = interval / self.period
        self.limit = law.limit
        triples = zip(law.feedback, readings, slopes, strict=True)
        self.feedback = [_RunningFeedback(one, self.period, reading, slope) for one, reading, slope in triples]
        self.late = deque([command] * round(law.delay / interval))
        self.samples, self.periods, self.held = 0, -1, command

    def command(self, readings: Sequence[float], reference: float) -> float:
        """Compute the command [A or V] of the next sample.

        Args:
            readings: of the law's signals, SI units.
            reference: of the arm angle [rad].
        """
        # The tiny share keeps a period of whole samples whole: 3 · (1/3) must be 1.
        period = math.floor(self.samples * self.periods_per_sample + 1e-9)
        self.samples += 1
        if period > self.periods:
            self.periods = period
            total = 0.0
            for one, reading in zip(self.feedback, readings, strict=True):
                total += one.part(reading, reference)
            self.held = min(max(total, -self.limit), self.limit) if self.limit > 0.0 else total
        self.late.append(self.held)
        return self.late.popleft()
