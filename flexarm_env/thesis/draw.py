"""Figures of the thesis as SVG and PNG, in the project's style."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from flexarm_env.errors import InputError
from flexarm_env.pictures.style import AFTER, BEFORE, INK, QUIET, STYLE
from flexarm_env.thesis.sheet import BEHIND, MAIN, OTHER, POINTS, THIRD, Panel, Sheet

LOOK: dict[str, dict[str, Any]] = {
    BEHIND: {"color": QUIET, "lw": 2.2},
    MAIN: {"color": AFTER, "lw": 1.2},
    OTHER: {"color": BEFORE, "lw": 1.2, "ls": (0, (4, 1.4))},
    THIRD: {"color": INK, "lw": 1.0, "ls": (0, (1, 1))},
    POINTS: {"color": INK, "lw": 0, "marker": "o", "ms": 4.5, "mfc": "white"},
}
#: Sizes [inch]: width, height of a panel, gap between two, margins left, right, below, above without legend, height of a
#: row of the legend. Fixed, because an automatic layout draws everything twice.
WIDTH, PANEL, BETWEEN, BETWEEN_OWN = 7.5, 1.4, 0.12, 0.3
LEFT, RIGHT, BELOW, ABOVE, ROW = 0.95, 0.15, 0.5, 0.42, 0.19
#: Height of the only panel of a figure [inch].
ALONE = 2.8
DPI = 100
#: A hub at rest must be a level line: merging points as far as the project's style allows would tilt it.
OWN_STYLE = {**STYLE, "path.simplify_threshold": 0.1, "savefig.dpi": DPI}
COLUMNS = 2


def draw(sheet: Sheet) -> Figure:
    """Draw a sheet."""
    with matplotlib.rc_context(OWN_STYLE):
        own = any(panel.window is not None for panel in sheet.panels)
        figure, all_axes = _frame(sheet, own)
        for axes, panel in zip(all_axes, sheet.panels, strict=True):
            span = panel.window or sheet.span
            _panel(axes, panel, span)
            if span is None:
                axes.margins(x=0.01)
            else:
                axes.set_xlim(*span)
        _legend(figure, sheet)
        all_axes[-1].set_xlabel(sheet.x)
    return figure


def _frame(sheet: Sheet, own: bool) -> tuple[Figure, list[Axes]]:
    """Create the figure and its axes, from top to bottom."""
    count, gap = len(sheet.panels), BETWEEN_OWN if own else BETWEEN
    tall = PANEL if count > 1 else ALONE
    labels = {curve.label for panel in sheet.panels for curve in panel.curves}
    above = ABOVE + ROW * -(-len(labels) // COLUMNS)
    height = above + BELOW + count * tall + (count - 1) * gap
    figure = Figure(figsize=(WIDTH, height))
    all_axes = figure.subplots(count, 1, sharex=not own, squeeze=False)[:, 0]
    edges = {"left": LEFT / WIDTH, "right": 1.0 - RIGHT / WIDTH, "bottom": BELOW / height, "top": 1.0 - above / height}
    figure.subplots_adjust(**edges, hspace=gap / tall)
    return figure, list(all_axes)


def save(figure: Figure, stem: Path) -> list[Path]:
    """Write a figure as PNG and SVG; return their paths.

    Raises:
        InputError: if the place cannot be written.
    """
    paths = [stem.with_name(f"{stem.name}.{ending}") for ending in ("png", "svg")]
    try:
        with matplotlib.rc_context(OWN_STYLE):
            for path, metadata in zip(paths, ({"Software": None}, {"Date": None, "Creator": "FlexArm"}), strict=True):
                figure.savefig(path, metadata=metadata)
    except OSError as error:
        raise InputError(f"cannot write {stem}: {error.strerror}; name a folder that can be written") from None
    return paths


def _panel(axes: Axes, panel: Panel, span: tuple[float, float] | None) -> None:
    low, high = span or (-np.inf, np.inf)
    for curve in panel.curves:
        shown = (curve.x >= low) & (curve.x <= high)
        axes.plot(curve.x[shown], curve.y[shown], label=curve.label, **LOOK[curve.role])
    for height, words in panel.lines:
        axes.axhline(height, color=INK, lw=0.7, ls=(0, (6, 3)))
        place: dict[str, Any] = {
            "xycoords": ("axes fraction", "data"),
            "textcoords": "offset points",
            "va": "top",
            "ha": "right",
            "fontsize": 7,
        }
        axes.annotate(words, (1.0, height), (-3, -2), **place)
    if panel.compressed:
        axes.set_yscale("symlog", linthresh=1.0)
        axes.set_yticks([-1e4, -1e2, -1.0, 1.0, 1e2, 1e4])
    if panel.span is not None:
        axes.set_ylim(*panel.span)
    axes.set_ylabel(panel.label)
    axes.yaxis.set_label_coords(-0.6 / (WIDTH - LEFT - RIGHT), 0.5)


def _legend(figure: Figure, sheet: Sheet) -> None:
    """Draw the title and one legend for all panels: equal labels denote the same curve."""
    shown: dict[str, Any] = {}
    for axes in figure.axes:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            shown.setdefault(label, handle)
    height = figure.get_size_inches()[1]
    figure.text(0.12 / WIDTH, 1.0 - 0.12 / height, f"Fig. {sheet.number}  {sheet.title}", weight="bold", size=10, va="top")
    place = (LEFT / WIDTH, 1.0 - 0.3 / height)
    figure.legend(
        shown.values(), shown.keys(), loc="upper left", bbox_to_anchor=place, ncols=COLUMNS, fontsize=8, borderaxespad=0.0,
        borderpad=0.0, labelspacing=0.25,
    )  # fmt: skip
