"""The lab's overlay: measured, as given and now, with few enough points to follow a slider."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import plotly.graph_objects as go
from numpy.typing import NDArray
from plotly.subplots import make_subplots

from flexarm_env.identify.replay.run import Run
from flexarm_env.pictures import words
from flexarm_env.pictures.overlays import title
from flexarm_env.pictures.plots import digits, legend, where_measured, with_layout
from flexarm_env.pictures.style import AFTER_LINE, BEFORE_LINE, MEASURED_LINE

Floats = NDArray[np.float64]

POINTS = 1500  # of a curve
HEIGHT = 128  # [px] of each signal


def thinned(values: Floats) -> list[float]:
    """Thin values to about the number of points drawn, and round them to four digits."""
    return digits(values[:: max(len(values) // POINTS, 1)])


def overlay(run: Run, signals: list[str], given: Floats, now: Floats) -> go.Figure:
    """Draw each signal of a recording: measured, the model as given, and the current model.

    Args:
        run: the recording.
        signals: names of its columns.
        given: (samples, signals), the free replay of the arm as given.
        now: the same for the current arm.
    """
    order = words.signals_of(signals)
    figure = make_subplots(
        len(order), 1, shared_xaxes=True, vertical_spacing=0.3 / (len(order) + 1), subplot_titles=[title(s) for s in order]
    )
    figure.update_annotations(x=0, xanchor="left", font_size=13)
    for row, signal in enumerate(order, start=1):
        column = signals.index(signal)
        measured = run.measured[:, column]
        there = where_measured(run.time, measured, measured, POINTS)
        for (x, y), line, name in (
            ((digits(there[0]), digits(there[1])), MEASURED_LINE, "measured"),
            ((thinned(run.time), thinned(given[:, column])), BEFORE_LINE, "as given"),
            ((thinned(run.time), thinned(now[:, column])), AFTER_LINE, "now"),
        ):
            look: dict[str, Any] = {"name": name, "legendgroup": name, "showlegend": row == 1, "line": line}
            figure.add_trace(go.Scatter(x=x, y=y, mode="lines", **look), row, 1)
    figure.update_xaxes(title_text="time [s]", row=len(order))
    figure.update_layout(uirevision=run.name)  # a zoom outlives a drag
    return with_layout(figure, 90 + HEIGHT * len(order), "x unified", top=58, **legend(1.0 + 24.0 / (HEIGHT * len(order))))


def moved(signals: list[str], now: Floats) -> tuple[Mapping[str, Any], list[int]]:
    """Build the arguments of Plotly's restyle that move the curves of the current model."""
    order = words.signals_of(signals)
    ys = [thinned(now[:, signals.index(signal)]) for signal in order]
    return {"y": ys}, [3 * i + 2 for i in range(len(order))]
