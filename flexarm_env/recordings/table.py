"""The table of raw numbers that a format makes of a file, and how large it may be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from flexarm_env.recordings.columns import Source, quantity_of, si_factor

#: Bytes.
LARGEST_FILE = 256 * 2**20
#: Lines of a text file, as many as the samples of a simulated run.
MOST_LINES = 10_000_000


@dataclass(frozen=True)
class Table:
    """Columns of a file before units.

    Attributes:
        values: (n,) numbers by FlexArm name, in the file's units.
        sources: by FlexArm name, the unit, sign and scale of those numbers.
        conditions: known conditions in SI, such as payload [kg].
        lines: for each sample its line in the file, counted from 1; empty where a format has no lines.
        episodes: for each sample the number of the recording that it is of; empty where a file is one recording.
        changing: conditions that change during the run, n numbers each, in SI.
        unread: notes on conditions that remarks state and that cannot be read, by name.
        notes: a line each on what may be meant otherwise than it was read.
    """

    values: dict[str, NDArray[np.float64]]
    sources: dict[str, Source]
    conditions: dict[str, float] = field(default_factory=dict)
    lines: Sequence[int] = ()
    episodes: Sequence[int] = ()
    changing: dict[str, Sequence[float]] = field(default_factory=dict)
    unread: dict[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def in_si(self, calibration: Mapping[str, float]) -> dict[str, NDArray[np.float64]]:
        """Convert the columns to SI.

        Args:
            calibration: SI per volt, by signal.

        Raises:
            InputError: for a unit that does not convert.
        """
        found: dict[str, NDArray[np.float64]] = {}
        for name, values in self.values.items():
            factor, quantity = si_factor(name, self.sources[name], calibration), quantity_of(name)
            with np.errstate(over="ignore", invalid="ignore"):  # an overflow is reported with its row
                # Time counts from its first sample, subtracted before scaling so that no digit is lost.
                part = (values - values[0] if quantity == "time" else values) * factor
                found[quantity] = found[quantity] + part if quantity in found else part
        return found

    def first_time(self, calibration: Mapping[str, float]) -> float:
        """Compute the time of the first sample on the clock of the file [s], which `in_si` counts from."""
        parts = {name: values for name, values in self.values.items() if quantity_of(name) == "time"}
        return float(sum(float(values[0]) * si_factor(name, self.sources[name], calibration) for name, values in parts.items()))
