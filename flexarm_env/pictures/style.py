"""Colours that a colour-blind reader can distinguish (Okabe and Ito, 2008), and the settings of both kinds of figures.

Nothing is encoded by colour alone: models differ in dashes, bars in patterns, regimes in symbols.
"""

from __future__ import annotations

from typing import Any

#: Rule of pages for a dark scheme. All colours turn, those of figures, too: hues stay, and white becomes #141414.
DARK = """
@media screen and (prefers-color-scheme: dark) {
  html { background: #fff; filter: invert(.92) hue-rotate(180deg); }
}
"""

MEASURED = "#a3a3a3"
BEFORE = "#d55e00"
AFTER = "#0072b2"
QUIET = "#b8b8b8"
INK = "#222222"
GRID = "#e6e6e6"

#: Name, colour and symbol of each regime of motion: stuck, moving slowly, moving fast.
REGIMES = (("stuck", "#222222", "diamond-open"), ("creeping", BEFORE, "x"), ("moving", AFTER, "circle"))

#: Lines of a page's figures.
MEASURED_LINE: dict[str, Any] = {"color": MEASURED, "width": 3.5}
BEFORE_LINE: dict[str, Any] = {"color": BEFORE, "width": 1.4, "dash": "5px,2px"}
AFTER_LINE: dict[str, Any] = {"color": AFTER, "width": 1.4}
#: Bars of a page's figures: as given, in between, final.
BEFORE_BAR = {"color": BEFORE, "pattern": {"shape": "/", "fgcolor": "white", "size": 7, "solidity": 0.25}}
QUIET_BAR = {"color": QUIET}
AFTER_BAR = {"color": AFTER}

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
    "grid.color": GRID,
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
