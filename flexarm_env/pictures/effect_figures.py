"""Figures of one effect: its torque curve, its contribution to the signals, and the proposed next run."""

from __future__ import annotations

import numpy as np
import plotly.graph_objects as go

from flexarm_env.experiments.next_run import NextRun
from flexarm_env.identify.explain.comparison import Comparison
from flexarm_env.identify.explain.effect_curve import UNITS, EffectCurve
from flexarm_env.pictures import words
from flexarm_env.pictures.highlight import CLOSE, most_informative_window, replay_of
from flexarm_env.pictures.overlays import title
from flexarm_env.pictures.plots import STEPS_PER_NOISE, curve, digits, legend, where_measured, with_layout
from flexarm_env.pictures.style import AFTER_LINE, BEFORE_LINE, INK, MEASURED, MEASURED_LINE


def own_curve(found: EffectCurve) -> go.Figure:
    """Draw torque against its driver: the estimate from the recordings, and the law as given and as fitted."""
    figure = go.Figure()
    dots = {"color": MEASURED, "size": 3, "opacity": 0.5}
    figure.add_trace(go.Scatter(x=digits(found.x), y=digits(found.y), mode="markers", marker=dots, name="data, single samples"))
    figure.add_trace(
        go.Scatter(
            x=digits(found.bins),
            y=digits(found.middle),
            mode="markers",
            marker={"color": INK, "size": 7, "symbol": "diamond"},
            error_y={
                "type": "data",
                "array": digits(found.high - found.middle),
                "arrayminus": digits(found.middle - found.low),
                "color": INK,
                "thickness": 1.2,
                "width": 2,
            },
            name="data: median and middle half",
        )
    )
    if found.effect:
        for values, line, name in ((found.given, BEFORE_LINE, "law as given"), (found.fitted, AFTER_LINE, "fitted law")):
            thick = line | {"width": 2.4}
            figure.add_trace(go.Scatter(x=digits(found.line), y=digits(values), mode="lines", line=thick, name=name))
    low, high = np.percentile(found.y, [0.5, 99.5])
    low, high = min(low, *found.fitted, *found.given), max(high, *found.fitted, *found.given)
    margin = 0.06 * (high - low) or 1.0
    figure.update_xaxes(title_text=f"{'arm ' if found.driver != 'time' else ''}{found.driver} [{UNITS[found.driver]}]")
    figure.update_yaxes(title_text=f"{found.quantity} [N·m]", range=[low - margin, high + margin])
    return with_layout(figure, 400, top=52, **legend())


def contribution(without: Comparison, after: Comparison) -> tuple[go.Figure, str]:
    """Draw the residual without an effect and the effect's contribution, in the most informative window.

    Args:
        without: of the corrected arm less the effect.
        after: of the corrected arm.

    Returns:
        The figure, and the signal and recording shown.
    """
    recording, signal, start = most_informative_window(without, after, CLOSE)
    old, new = replay_of(without, recording), replay_of(after, recording)
    inside = (old.time >= start) & (old.time <= start + CLOSE)
    step = after.noise[signal] / STEPS_PER_NOISE
    time, measured, model = old.time[inside], old.measured[signal][inside], old.windows[signal][inside]
    missing = where_measured(time, measured - model, measured)
    added = time, new.windows[signal][inside] - model
    figure = go.Figure()
    for points, line, name in (
        (missing, MEASURED_LINE | {"width": 7.0}, "residual without it"),
        (added, AFTER_LINE | {"width": 2.0}, "its contribution"),
    ):
        figure.add_trace(curve(*points, step, line=line, name=name))
    figure.update_xaxes(title_text="time [s]")
    figure.update_yaxes(title_text=title(signal))
    return with_layout(figure, 330, "x unified", **legend()), f"{words.label_of(signal)}, recording {recording}"


def next_input(run: NextRun) -> go.Figure:
    """Draw the command of a proposed run over time."""
    kind = run.input_kind
    step = max(float(np.ptp(run.command)), 1e-9) / 2000.0
    figure = go.Figure(curve(run.time, run.command, step, line={"color": INK, "width": 1.3, "shape": "hv"}))
    figure.update_xaxes(title_text="time [s]")
    figure.update_yaxes(title_text=f"{kind} [{'A' if kind == 'current' else 'V'}]")
    return with_layout(figure, 240)
