"""Figures of answers, against their goals."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

#: An answer to a case: the case, what was found, the time that it took, and who answered.
Answer = dict[str, Any]


@dataclass(frozen=True)
class Figure:
    """One line of the table: quantity, goal in words, value (None without cases), number of cases, and whether it is met."""

    what: str
    goal: str
    value: float | None
    count: int
    met: bool
    unit: str = "%"

    @property
    def text(self) -> str:
        """Format the value with its unit and the number of cases."""
        if self.value is None:
            return "none"
        if self.unit == "%":
            return f"{100.0 * self.value:.1f} % of {self.count}"
        return f"{self.value:.3g}{' ' + self.unit if self.unit else ''} ({self.count})"

    @property
    def judged(self) -> str:
        """Write whether it meets its goal, in a word; empty without cases."""
        return "" if self.value is None else "met" if self.met else "missed"


def first(answer: Answer) -> str | None:
    """Select the effect that a diagnosis names first, if any."""
    effects: list[str] = answer["found"]["effects"]
    return effects[0] if effects else None


def share(what: str, goal: float, answers: Sequence[Answer], test: Callable[[Answer], bool], at_most: bool = False) -> Figure:
    """Compute the share of answers that pass a test, against its goal."""
    value = float(np.mean([test(a) for a in answers])) if answers else None
    met = value is not None and (value <= goal if at_most else value >= goal)
    return Figure(what, f"{'≤' if at_most else '≥'} {100 * goal:.0f} %", value, len(answers), met)


def median(what: str, goal: str, values: Sequence[float], meets: Callable[[float], bool], unit: str) -> Figure:
    """Compute the median of values, against its goal."""
    value = float(np.median(values)) if values else None
    return Figure(what, goal, value, len(values), value is not None and meets(value), unit)


def coverage(what: str, goal: tuple[float, float], held: Sequence[bool]) -> Figure:
    """Compute the share of intervals that contain the truth, against its goal."""
    value = float(np.mean(held)) if held else None
    words = f"{100 * goal[0]:.0f} to {100 * goal[1]:.0f} %"
    return Figure(what, words, value, len(held), value is not None and goal[0] <= value <= goal[1])


def calibration(what: str, most: float, pairs: Sequence[tuple[float, bool]]) -> Figure:
    """Compute the expected calibration error: the mean difference of probabilities and the shares that were right."""
    groups: dict[float, list[bool]] = {}
    for probability, right in pairs:
        groups.setdefault(round(probability, 2), []).append(right)
    off = [len(rights) * abs(probability - float(np.mean(rights))) for probability, rights in groups.items()]
    value = sum(off) / len(pairs) if pairs else None
    return Figure(what, f"≤ {100 * most:.0f} %", value, len(pairs), value is not None and value <= most)
