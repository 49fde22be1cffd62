"""A fault of a recording: of a sensor, a unit or a file, with its size and the line of the column map that mends it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

#: Kinds of fault, as `diagnose --json` names them, and the quantity that `Fault.value` gives.
KINDS = {
    "factor": "the signal over the model's",
    "sign": "-1",
    "swapped": "none: `other` is the signal that it was exchanged with",
    "clock": "time [s] by which the signal is late",
    "wrap": "the step of the wrap, in the signal's unit",
    "rail": "the reading at which the signal is cut off, in its unit",
    "constant": "the reading that never changes, in the signal's unit",
    "held": "how many readings in a row are one",
    "spike": "the largest height of a spike, in the signal's unit",
    "dropout": "the reading that stands in place of lost ones, in the signal's unit",
    "limit": "the largest command over the limit of the arm file",
    "glued": "time [s] at which another run begins",
    "restart": "time [s] from which the clock starts again",
}

#: Samples that JSON names.
MOST_SAMPLES = 100


@dataclass(frozen=True)
class Fault:
    """A fault of a recording.

    Attributes:
        recording: its name.
        source: the file that it was read from; "" if from none.
        signal: at fault: a signal, "current", "voltage" or "time"; "" where all are.
        kind: one of `KINDS`.
        value: its size, as `KINDS` says; None where it has none.
        unit: SI unit of the value; "" for a ratio or a count.
        message: one line for a person, with the size.
        hint: the line of the column map or of the arm file that mends it; "" where none does.
        rows: samples that show it, counted from 0; empty where all do.
        share: of the samples that show it.
        other: the other signal of an exchange.
    """

    recording: str
    source: str
    signal: str
    kind: str
    value: float | None
    unit: str
    message: str
    hint: str = ""
    rows: tuple[int, ...] = ()
    share: float = 1.0
    other: str = ""

    @property
    def line(self) -> str:
        """One line with the recording, the fault and the line that mends it."""
        mend = f" ({self.hint})" if self.hint else ""
        return f"{self.recording}: {self.message}{mend}"

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data."""
        found: dict[str, Any] = {
            "file": self.source or self.recording,
            "signal": self.signal,
            "fault": self.kind,
            "value": self.value,
            "unit": self.unit,
            "message": self.message,
            "hint": self.hint,
            "share": self.share,
        }
        if self.rows:
            found["samples"] = list(self.rows[:MOST_SAMPLES])
        return found | ({"other": self.other} if self.other else {})
