"""The clock of a recording: it rises from row to row, or starts again where another run begins."""

from __future__ import annotations

import math
from typing import Self

import numpy as np
from numpy.typing import NDArray

from flexarm_env.errors import InputError

Floats = NDArray[np.float64]

#: Rows for which time runs on below an earlier time: fewer are the jitter of a logger.
FEWEST_ROWS = 10
#: Moduli [s] of counters: 16 and 32 bits of milliseconds, microseconds and nanoseconds.
_COUNTERS = tuple(2**bits * unit for bits in (16, 32) for unit in (1e-3, 1e-6, 1e-9))


class RestartError(InputError):
    """The clock of a file starts again: it holds two runs, or a counter that overflowed.

    Attributes:
        place: of the first row after the restart, for a person: "row 12".
        sample: index of that row among the samples.
        before: last time [s] before it, from the first sample.
        after: time [s] of that row.
        counter: modulus [s] of a counter that overflows by that step; 0 where the step is of none.
        source: the path of the file; "" where none was read.
    """

    def __init__(self, place: str, sample: int, before: float, after: float, counter: float, source: str = "") -> None:
        self.place, self.sample, self.before, self.after = place, sample, before, after
        self.counter, self.source = counter, source
        run = f"or one run whose counter overflows at {counter:.9g} s; " if counter else ""
        file = f"{source}: " if source else ""
        super().__init__(
            f"{file}{place}, column 'time': the clock starts again, {after:.9g} s after {before:.9g} s "
            f"(from the first sample); the file holds two runs, {run}cut it there into one file for each"
        )

    def of(self, source: str) -> Self:
        """Name the file."""
        return type(self)(self.place, self.sample, self.before, self.after, self.counter, source)

    def __reduce__(self) -> tuple[type[Self], tuple[str, int, float, float, float, str]]:
        return type(self), (self.place, self.sample, self.before, self.after, self.counter, self.source)


def step_back_error(time: Floats, sample: int, place: str) -> InputError:
    """Make the error of a time that does not rise.

    Args:
        time: (n,) [s].
        sample: index of the first time that is not above the one before it.
        place: of that sample, for a person.
    """
    before, after = float(time[sample - 1]), float(time[sample])
    following = time[sample : sample + FEWEST_ROWS]
    if len(following) == FEWEST_ROWS and (np.diff(following) > 0).all() and following[-1] <= before:
        return RestartError(place, sample, before, after, _counter(time, sample))
    verb = "repeats" if after == before else "goes back"
    return InputError(
        f"{place}, column 'time': {verb}, {after:.9g} s after {before:.9g} s (from the first sample); "
        "time must rise from row to row: check how the logger stamps that row"
    )


def _counter(time: Floats, sample: int) -> float:
    """Find the modulus [s] of a counter that explains a step back; 0 where none does."""
    usual = float(np.median(np.abs(np.diff(time))))
    step = float(time[sample - 1] - time[sample]) + usual
    return next((m for m in _COUNTERS if math.isclose(step, m, rel_tol=0.0, abs_tol=0.5 * usual)), 0.0)
