"""Figures of measured and modelled signals with their residuals."""

from __future__ import annotations

from typing import Any

import plotly.graph_objects as go
from plotly.subplots import make_subplots

from flexarm_env.identify.explain.comparison import Comparison, Replay
from flexarm_env.identify.replay.readings import extent
from flexarm_env.parameters import INPUTS
from flexarm_env.pictures import words
from flexarm_env.pictures.highlight import CLOSE, most_informative_window, replay_of
from flexarm_env.pictures.plots import STEPS_PER_NOISE, Floats, curve, legend, where_measured, with_layout
from flexarm_env.pictures.style import AFTER_LINE, BEFORE_LINE, INK, MEASURED_LINE
from flexarm_env.recordings.recording import Recording

AS_GIVEN, CORRECTED = "model as given", "corrected"


def title(signal: str) -> str:
    """Format name and unit of a signal: "arm angle [rad]"."""
    label, unit = words.label_of(signal), words.unit_of(signal)
    return f"{label} [{unit}]"


def signals(old: Replay, new: Replay | None, noise: dict[str, float]) -> go.Figure:
    """Draw measured and modelled signals of a recording, each with its residual, in windows or as one free run."""
    names = words.signals_of(list(old.measured))
    titles = [text for s in names for text in (title(s), f"{words.label_of(s)}, residual [σ of noise]")]
    heights = [part for _ in names for part in (2.2, 1.0)]
    height = 130 + 330 * len(names)
    gap = 34.0 / (height - 130)
    figure = make_subplots(2 * len(names), 1, shared_xaxes=True, vertical_spacing=gap, row_heights=heights, subplot_titles=titles)
    figure.update_annotations(x=0, xanchor="left", font_size=13)
    models = [(AS_GIVEN, BEFORE_LINE, old), *([(CORRECTED, AFTER_LINE, new)] if new is not None else [])]
    kinds: list[str] = []
    for i, signal in enumerate(names):
        first, step = i == 0, noise[signal] / STEPS_PER_NOISE
        measured = old.measured[signal]
        there = where_measured(old.time, measured, measured)
        figure.add_trace(curve(*there, step, name="measured", line=MEASURED_LINE, showlegend=first), 2 * i + 1, 1)
        kinds.append("both")
        for name, line, replay in models:
            for kind, curves in (("windows", replay.windows), ("free", replay.free)):
                look: dict[str, Any] = {"name": name, "legendgroup": name, "line": line, "visible": kind == "windows"}
                off = where_measured(replay.time, (measured - curves[signal]) / noise[signal], measured)
                figure.add_trace(curve(replay.time, curves[signal], step, showlegend=first, **look), 2 * i + 1, 1)
                residual = curve(*off, 1.0 / STEPS_PER_NOISE, showlegend=False, **look)
                figure.add_trace(residual, 2 * i + 2, 1)
                kinds += [kind, kind]
        band(figure, 2 * i + 2)
    figure.update_xaxes(title_text="time [s]", row=2 * len(names))
    with_layout(figure, height, "x unified", top=92, **legend(1.0 + 22.0 / (height - 130)), updatemenus=[_switch(kinds)])
    return figure


def band(figure: go.Figure, row: int) -> None:
    """Shade the band that noise alone explains: two standard deviations."""
    figure.add_hrect(y0=-2.0, y1=2.0, line_width=0, fillcolor="#dddddd", opacity=0.6, layer="below", row=row, col=1)


def _switch(kinds: list[str]) -> dict[str, Any]:
    def shown(kind: str) -> list[bool]:
        return [k in ("both", kind) for k in kinds]

    buttons = [
        {"label": "windows of 1 s", "method": "restyle", "args": ["visible", shown("windows")]},
        {"label": "one free run", "method": "restyle", "args": ["visible", shown("free")]},
    ]
    place = {"x": 0.0, "xanchor": "left", "y": 1.0, "yanchor": "bottom", "pad": {"b": 46}}
    return {"buttons": buttons, "type": "buttons", "direction": "right", **place}


def informative_window(before: Comparison, after: Comparison | None) -> tuple[go.Figure, str]:
    """Draw measured and modelled values in the most informative window; also name its signal and recording."""
    recording, signal, start = most_informative_window(before, after, CLOSE)
    old = replay_of(before, recording)
    inside = (old.time >= start) & (old.time <= start + CLOSE)
    step = before.noise[signal] / STEPS_PER_NOISE
    figure = go.Figure()
    time, measured = old.time[inside], old.measured[signal][inside]
    rows: list[tuple[tuple[Floats, Floats], dict[str, Any], str]] = [
        (where_measured(time, measured, measured), MEASURED_LINE, "measured"),
        ((time, old.windows[signal][inside]), BEFORE_LINE, AS_GIVEN),
    ]
    if after is not None:
        rows.append(((time, replay_of(after, recording).windows[signal][inside]), AFTER_LINE, CORRECTED))
    for points, line, name in rows:
        figure.add_trace(curve(*points, step, name=name, line=line))
    figure.update_xaxes(title_text="time [s]")
    figure.update_yaxes(title_text=title(signal))
    return with_layout(figure, 300, "x unified", **legend()), f"{words.label_of(signal)}, recording {recording}"


def recorded(recording: Recording) -> go.Figure:
    """Draw a recording alone: the command and the sensors' readings."""
    unit = INPUTS[recording.input_kind]
    rows: list[tuple[str, Floats]] = [(f"{recording.input_kind} [{unit}]", recording.command)]
    rows += [(title(s), recording.signals[s]) for s in words.signals_of(list(recording.signals))]
    figure = make_subplots(
        len(rows), 1, shared_xaxes=True, vertical_spacing=0.3 / (len(rows) + 1), subplot_titles=[t for t, _ in rows]
    )
    figure.update_annotations(x=0, xanchor="left", font_size=13)
    for i, (_, values) in enumerate(rows):
        step = max(float(extent(values)), 1e-12) / 5000.0
        there = where_measured(recording.time, values, values)
        figure.add_trace(curve(*there, step, line={"color": INK, "width": 1.2}), i + 1, 1)
    figure.update_xaxes(title_text="time [s]", row=len(rows))
    return with_layout(figure, 60 + 150 * len(rows))
