"""A claim of the thesis, what comes out here, and whether it holds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

HOLDS, IN_PART, FAILS = "holds", "holds in part", "does not hold"


@dataclass(frozen=True)
class Part:
    """One thing that a claim says.

    Attributes:
        ours: what comes out here, with numbers.
        holds: whether that is what the thesis says.
        numbers: the numbers in it, by name and unit, as {"stuck [Hz]": 2.43}.
    """

    ours: str
    holds: bool
    numbers: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Claim:
    """A row of the table.

    Attributes:
        key: "T1" to "T19".
        where: section or figure of the thesis.
        words: what it says, in our words.
        parts: what comes out of each thing that it says.
        because: why it holds or not.
        figures: numbers of the figures that show it.
    """

    key: str
    where: str
    words: str
    parts: Sequence[Part]
    because: str
    figures: Sequence[str] = ()

    @property
    def verdict(self) -> str:
        """Whether all parts hold, some or none."""
        held = [part.holds for part in self.parts]
        return HOLDS if all(held) else IN_PART if any(held) else FAILS

    @property
    def numbers(self) -> dict[str, float]:
        """All numbers of all parts."""
        return {name: value for part in self.parts for name, value in part.numbers.items()}

    def as_json(self) -> dict[str, Any]:
        """Plain data."""
        parts = [{"ours": part.ours, "holds": bool(part.holds), "numbers": dict(part.numbers)} for part in self.parts]
        row = {"claim": self.key, "where": self.where, "thesis": self.words, "verdict": self.verdict}
        return row | {"because": self.because, "parts": parts, "figures": list(self.figures)}
