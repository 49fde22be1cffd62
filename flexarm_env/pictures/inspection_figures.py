"""Figures of an overview: recorded signals with their faults marked, and what recordings can show of an arm."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go

from flexarm_env.arm import short_name
from flexarm_env.identify.inspect.excitation import DETECTABLE, SHOWN, ConstantExcitation, EffectExcitation
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.pictures import words
from flexarm_env.pictures.inspection_words import ordered
from flexarm_env.pictures.overlays import recorded
from flexarm_env.pictures.plots import digits, legend, with_layout
from flexarm_env.pictures.style import AFTER, BEFORE, INK, QUIET
from flexarm_env.recordings.recording import Recording

#: Faulty samples that a figure marks, at most.
MOST_MARKS = 400
_MARK: dict[str, Any] = {"symbol": "x", "size": 7, "color": BEFORE}


def signals(recording: Recording, faults: Sequence[Fault]) -> go.Figure:
    """Draw the command and the signals of a recording; samples at fault are crossed, breaks in time are dashed lines."""
    figure = recorded(recording).update_traces(showlegend=False)
    figure.update_xaxes(range=[float(recording.time[0]), float(recording.time[-1])])
    own = [fault for fault in faults if fault.recording == recording.name]
    rows = [recording.input_kind, *words.signals_of(list(recording.signals))]
    named = False
    for fault in own:
        if fault.kind == "glued" and fault.value is not None:
            figure.add_vline(x=fault.value, line={"color": BEFORE, "width": 1.5, "dash": "dash"})
        elif fault.signal in rows and fault.rows:
            marks = np.array(fault.rows)[:: -(-len(fault.rows) // MOST_MARKS)]
            values = recording.command if fault.signal == recording.input_kind else recording.signals[fault.signal]
            look = {"mode": "markers", "marker": _MARK, "name": "at fault", "legendgroup": "fault", "showlegend": not named}
            trace = go.Scatter(x=digits(recording.time[marks], 7), y=digits(values[marks]), **look)
            figure.add_trace(trace, rows.index(fault.signal) + 1, 1)
            named = True
    for row, name in enumerate(rows):
        kinds = [fault.kind for fault in own if fault.signal == name]
        if kinds:
            figure.layout.annotations[row].text += f"  <b>✗ {', '.join(dict.fromkeys(kinds))}</b>"
    height = 60 + 150 * len(rows)
    return with_layout(figure, height, top=52, **legend(1.0 + 24.0 / (height - 60))) if named else figure


def constants(found: Sequence[ConstantExcitation]) -> go.Figure:
    """Draw the half width of each constant's interval before and after a fit, on a logarithmic scale."""
    known = [one for one in found if one.value != 0.0]
    names = [short_name(one.path).replace("_", " ") for one in known]
    figure = go.Figure()
    for title, widths, colours in (
        ("before", [one.prior for one in known], [QUIET] * len(known)),
        ("after", [one.half_width for one in known], [AFTER if one.state == SHOWN else BEFORE for one in known]),
    ):
        share = [100.0 * width / abs(one.value) for width, one in zip(widths, known, strict=True)]
        symbol = ["line-ns-open" if title == "before" else "circle" if one.state == SHOWN else "x" for one in known]
        look = {"size": 11, "color": colours, "symbol": symbol, "line": {"width": 3, "color": colours}}
        text = [f"{name}, {title} a fit: ± {words.number(value, 2)} %" for name, value in zip(names, share, strict=True)]
        figure.add_trace(go.Scatter(x=share, y=names, mode="markers", marker=look, text=text, hoverinfo="text"))
    return _ladder(figure, len(known), "half width of the 90 % interval [%]")


def effects(found: Sequence[EffectExcitation]) -> go.Figure:
    """Draw the smallest size of each effect that recordings show, over its typical size, on a logarithmic scale."""
    shown = [one for one in ordered(found) if math.isfinite(one.sizes)]
    names = [one.effect.replace("_", " ") for one in shown]
    detectable = [one.state == DETECTABLE for one in shown]
    colours = [AFTER if one else BEFORE for one in detectable]
    look = {"size": 11, "color": colours, "symbol": ["circle" if one else "x" for one in detectable]}
    text = [f"{name}: {words.number(one.sizes, 2)} of its typical size" for name, one in zip(names, shown, strict=True)]
    sizes = [one.sizes for one in shown]
    figure = go.Figure(go.Scatter(x=sizes, y=names, mode="markers", marker=look, text=text, hoverinfo="text"))
    figure.add_vline(x=1.0, line={"color": INK, "width": 1.2, "dash": "dot"})
    return _ladder(figure, len(shown), "smallest size shown, over the typical size")


def _ladder(figure: go.Figure, rows: int, title: str) -> go.Figure:
    """Lay out one row per name over a logarithmic axis."""
    marks = [mark * 10.0**decade for decade in range(-6, 7) for mark in (1, 2, 5)]  # of decades alone a narrow axis has none
    figure.update_xaxes(type="log", title_text=title, tickvals=marks, ticktext=[f"{mark:g}" for mark in marks])
    figure.update_yaxes(autorange="reversed")
    return with_layout(figure, 70 + 22 * max(rows, 2))
