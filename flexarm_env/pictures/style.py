"""Colours that a colour-blind reader can tell apart (Okabe and Ito, 2008), and matplotlib's settings."""

from __future__ import annotations

from typing import Any

MEASURED = "#a3a3a3"
BEFORE = "#d55e00"
AFTER = "#0072b2"
QUIET = "#b8b8b8"
INK = "#222222"

STYLE: dict[str, Any] = {
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelcolor": INK,
    "axes.edgecolor": "#888888",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e6e6e6",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "xtick.color": INK,
    "ytick.color": INK,
    "lines.linewidth": 1.2,
    "legend.frameon": False,
    "figure.dpi": 100,
    "savefig.dpi": 160,
    "path.simplify_threshold": 0.7,
    # The same picture from the same numbers, byte for byte.
    "svg.hashsalt": "flexarm",
}
