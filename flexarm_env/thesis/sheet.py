"""A figure as data: panels of curves over a common axis, without Matplotlib; `draw` draws it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from flexarm_env.thesis.runs import Run

Floats = NDArray[np.float64]

#: Roles of curves, each with its own style in colour and in grey.
MAIN, OTHER, THIRD, BEHIND = "main", "other", "third", "behind"
#: The same, as points.
POINTS = "points"


@dataclass(frozen=True, eq=False)
class Curve:
    """A curve or points: x and y (samples,), a label for the legend, a role."""

    x: Floats
    y: Floats
    label: str
    role: str = MAIN


@dataclass(frozen=True)
class Panel:
    """Curves on one pair of axes.

    Attributes:
        label: of the y axis, with unit.
        curves: from back to front.
        span: ends of the y axis, or None for the range of the curves.
        compressed: whether the y axis is logarithmic on both sides of a linear middle.
        lines: heights of thin lines, with their labels.
        window: ends of a separate x axis, or None for the common one.
    """

    label: str
    curves: Sequence[Curve]
    span: tuple[float, float] | None = None
    compressed: bool = False
    lines: Sequence[tuple[float, str]] = ()
    window: tuple[float, float] | None = None


@dataclass(frozen=True)
class Sheet:
    """A figure.

    Attributes:
        number: as in the thesis, "3.5"; of Appendix A, "A.1".
        title: of the figure.
        panels: from top to bottom.
        x: label of the common axis, with unit.
        span: ends of the common axis, or None for all.
        note: explanation below the figure.
    """

    number: str
    title: str
    panels: Sequence[Panel]
    x: str = "time [s]"
    span: tuple[float, float] | None = None
    note: str = ""

    @property
    def stem(self) -> str:
        """Name of its files, "figure-3-5"."""
        return f"figure-{self.number.replace('.', '-').lower()}"


SIGNAL = {
    "angle": "hub angle [°]",
    "speed": "motor speed [rad/s]",
    "strain": "strain [V]",
    "command": "current [A]",
}


def panels(runs: Sequence[tuple[Run, str, str]], *names: str) -> list[Panel]:
    """Build one panel for each signal named, with every run's curve: (run, label, role) from back to front."""
    return [Panel(SIGNAL[name], [Curve(r.time, getattr(r, name), label, role) for r, label, role in runs]) for name in names]
