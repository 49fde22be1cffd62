"""Shared layout of a page's figures, and curves rounded to a fraction of the noise."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import plotly.graph_objects as go
from numpy.typing import NDArray

from flexarm_env.pictures.style import GRID, INK
from flexarm_env.recordings.recording import GAP

Floats = NDArray[np.float64]

#: Curves are rounded to the noise over this: finer digits carry no information and would double the page's size.
STEPS_PER_NOISE = 50.0
#: Beyond so many samples a curve is drawn by the graphics card.
MANY = 20_000


def with_layout(figure: go.Figure, height: int, hover: str = "closest", **layout: Any) -> go.Figure:
    """Apply the page's layout to a figure of a height [px]."""
    top = layout.pop("top", 26)
    figure.update_layout(
        template="plotly_white",
        font={"color": INK, "size": 12},
        hovermode=hover,
        height=height,
        margin={"l": 8, "r": 8, "t": top, "b": 8},
        **{"showlegend": False, **layout},
    )
    axes = {"automargin": True, "gridcolor": GRID, "zerolinecolor": "#bbbbbb", "title_standoff": 6}
    figure.update_xaxes(**axes)
    figure.update_yaxes(ticklabelstandoff=4, **axes)
    return figure


def legend(y: float = 1.0) -> dict[str, Any]:
    """Lay a legend out above the axes."""
    return {
        "showlegend": True,
        "legend": {"orientation": "h", "x": 0, "y": y, "yanchor": "bottom", "itemwidth": 30, "itemsizing": "constant"},
    }


def in_steps(values: Floats, step: float) -> list[float]:
    """Round values to the last decimal that a step needs; to a list, since Plotly's text for arrays is longer."""
    finite = np.where(np.isfinite(values), values, np.nan)
    rounded: list[float] = np.round(finite, max(-math.floor(math.log10(step)), 0)).tolist()
    return rounded


def digits(values: Floats, count: int = 4) -> list[float]:
    """Round values to a number of significant digits of the largest."""
    largest = float(np.nanmax(np.abs(values), initial=1e-300, where=np.isfinite(values)))
    return in_steps(np.asarray(values, dtype=float), largest * 10.0**-count)


def where_measured(time: Floats, values: Floats, measured: Floats, points: int | None = None) -> tuple[Floats, Floats]:
    """Select times [s] and values (n,) at the readings of a signal, with NaN in gaps, which breaks the line there.

    A slower sensor has a reading in some rows only. Its usual step is no gap.

    Args:
        time: (n,).
        values: (n,), of the signal or of its residual.
        measured: (n,), the signal; NaN where it was not measured.
        points: about how many to thin them to; None for all.
    """
    there = np.flatnonzero(~np.isnan(measured))
    whole = len(there) == len(measured)
    there = there[:: max(len(there) // points, 1) if points else 1]
    time, values = time[there], values[there]
    if whole or len(there) < 2:
        return time, values
    steps = np.diff(time)
    ends = np.flatnonzero(steps > GAP * np.median(steps)) + 1
    return np.insert(time, ends, time[ends]), np.insert(values, ends, np.nan)


def curve(time: Floats, values: Floats, step: float, **look: Any) -> Any:
    """Draw a line over time [s], its values rounded to a step."""
    # The page's size: even times follow from the first two.
    steps = np.diff(time)
    even = len(steps) > 0 and np.allclose(steps, steps[0], rtol=1e-6)
    x = {"x0": float(time[0]), "dx": round(float(time[-1] - time[0]) / len(steps), 9)} if even else {"x": digits(time, 7)}
    trace: Any = go.Scatter
    if len(time) > MANY:
        trace, line = go.Scattergl, look["line"]
        look["line"] = line | {"dash": "dash"} if "dash" in line else line  # WebGL lines take no dash lengths
    return trace(y=in_steps(values, step), mode="lines", **x, **look)
