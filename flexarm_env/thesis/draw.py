"""Figures of the thesis as SVG and PNG, in the project's style."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib
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
WIDTH, TOP, HEIGHT = 7.5, 1.05, 1.55  # [inch]
DPI = 110


def draw(sheet: Sheet) -> Figure:
    """Return the figure of a sheet."""
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(WIDTH, TOP + HEIGHT * len(sheet.panels)), layout="constrained")
        own = any(panel.window is not None for panel in sheet.panels)
        all_axes = figure.subplots(len(sheet.panels), 1, sharex=not own, squeeze=False)[:, 0]
        for axes, panel in zip(all_axes, sheet.panels, strict=True):
            _panel(axes, panel)
        _legend(figure, sheet)
        all_axes[-1].set_xlabel(sheet.x)
        for axes, panel in zip(all_axes, sheet.panels, strict=True):
            span = panel.window or sheet.span
            if span is None:
                axes.margins(x=0.01)
            else:
                axes.set_xlim(*span)
        figure.align_ylabels(all_axes)
    return figure


def save(figure: Figure, stem: Path) -> list[Path]:
    """Write a figure as PNG and SVG; return their paths.

    Raises:
        InputError: if the place cannot be written.
    """
    paths = [stem.with_name(f"{stem.name}.{ending}") for ending in ("png", "svg")]
    try:
        with matplotlib.rc_context({**STYLE, "savefig.dpi": DPI}):
            for path, metadata in zip(paths, ({"Software": None}, {"Date": None, "Creator": "FlexArm"}), strict=True):
                figure.savefig(path, metadata=metadata)
    except OSError as error:
        raise InputError(f"cannot write {stem}: {error.strerror}; name a folder that can be written") from None
    return paths


def _panel(axes: Axes, panel: Panel) -> None:
    for curve in panel.curves:
        axes.plot(curve.x, curve.y, label=curve.label, **LOOK[curve.role])
    for height, words in panel.lines:
        axes.axhline(height, color=INK, lw=0.7, ls=(0, (6, 3)))
        axes.annotate(words, (1.0, height), (-2, 2), xycoords=("axes fraction", "data"), textcoords="offset points", ha="right", fontsize=7)
    if panel.compressed:
        axes.set_yscale("symlog", linthresh=1.0)
    if panel.span is not None:
        axes.set_ylim(*panel.span)
    axes.set_ylabel(panel.label)


def _legend(figure: Figure, sheet: Sheet) -> None:
    """Title and one legend for all panels: the same label is the same curve."""
    shown: dict[str, Any] = {}
    for axes in figure.axes:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            shown.setdefault(label, handle)
    figure.suptitle(f"Fig. {sheet.number}  {sheet.title}", x=0.01, ha="left", weight="bold", size=10)
    figure.legend(shown.values(), shown.keys(), loc="outside upper left", ncols=min(len(shown), 3), fontsize=8)
