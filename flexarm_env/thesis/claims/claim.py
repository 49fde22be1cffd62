"""A claim of the thesis, the result here, and the verdict on it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

HOLDS, IN_PART, FAILS = "holds", "holds in part", "does not hold"


@dataclass(frozen=True)
class Part:
    """One statement of a claim.

    Attributes:
        ours: the result here, with numbers.
        holds: whether it agrees with the thesis.
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
        words: the claim, paraphrased.
        parts: the result for each of its statements.
        because: reason of the verdict.
        figures: numbers of the figures with the evidence.
    """

    key: str
    where: str
    words: str
    parts: Sequence[Part]
    because: str
    figures: Sequence[str] = ()

    @property
    def verdict(self) -> str:
        """Judge whether all parts hold, some or none."""
        held = [part.holds for part in self.parts]
        return HOLDS if all(held) else IN_PART if any(held) else FAILS

    @property
    def numbers(self) -> dict[str, float]:
        """Collect the numbers of all parts."""
        return {name: value for part in self.parts for name, value in part.numbers.items()}

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data."""
        parts = [{"ours": part.ours, "holds": bool(part.holds), "numbers": dict(part.numbers)} for part in self.parts]
        row = {"claim": self.key, "where": self.where, "thesis": self.words, "verdict": self.verdict}
        return row | {"because": self.because, "parts": parts, "figures": list(self.figures)}
