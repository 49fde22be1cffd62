"""A tuned number: its value, its meaning, and how it was found."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

UNKNOWN = "not known"


def tuned(value: Any, meaning: str, found: str = UNKNOWN, unit: str = "") -> Any:
    """Declare a number of the method.

    Args:
        value: a number, or a tuple of numbers.
        meaning: a sentence for a person.
        found: how the value was found: a paper, a sweep, the seeds of the benchmark; `UNKNOWN` where nobody wrote it down.
        unit: SI unit; "" for a ratio or a count.
    """
    return field(default=value, metadata={"meaning": meaning, "found": found, "unit": unit})


@dataclass(frozen=True)
class Number:
    """One tuned number, for tables.

    Attributes:
        stage: the field of `Settings` that holds it.
        name: within the stage.
        value: a number, or a tuple of numbers.
        unit: SI unit; "" for a ratio or a count.
        meaning: a sentence.
        found: how it was found.
    """

    stage: str
    name: str
    value: Any
    unit: str
    meaning: str
    found: str
