"""An effect's own curve, what it adds to the signals, and the run that would tell more."""

from __future__ import annotations

import numpy as np
import plotly.graph_objects as go

from flexarm_env.identify.effect_curve import UNITS, EffectCurve
from flexarm_env.identify.next_run import NextRun
from flexarm_env.identify.results import Comparison
from flexarm_env.pictures import words
from flexarm_env.pictures.overlays import title
from flexarm_env.pictures.plots import STEPS_PER_NOISE, curve, digits, finished, legend
from flexarm_env.pictures.style import AFTER_LINE, BEFORE_LINE, INK, MEASURED, MEASURED_LINE
from flexarm_env.pictures.telling import CLOSE, most_telling, replay_of


def own_curve(found: EffectCurve) -> go.Figure:
    """Return torque against its driver: the data's estimate, and the law as given and as fitted."""
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
    return finished(figure, 400, top=52, **legend())


def contribution(without: Comparison, after: Comparison) -> tuple[go.Figure, str]:
    """Return what was missing without an effect, and what the effect adds, where that is most; and which signal it is.

    Args:
        without: the corrected arm less the effect.
        after: the corrected arm.
    """
    recording, signal, start = most_telling(without, after, CLOSE)
    old, new = replay_of(without, recording), replay_of(after, recording)
    inside = (old.time >= start) & (old.time <= start + CLOSE)
    step = after.noise[signal] / STEPS_PER_NOISE
    missing = old.measured[signal] - old.windows[signal]
    added = new.windows[signal] - old.windows[signal]
    figure = go.Figure()
    for values, line, name in (
        (missing, MEASURED_LINE | {"width": 7.0}, "missing without it"),
        (added, AFTER_LINE | {"width": 2.0}, "what it adds"),
    ):
        figure.add_trace(curve(old.time[inside], values[inside], step, line=line, name=name))
    figure.update_xaxes(title_text="time [s]")
    figure.update_yaxes(title_text=title(signal))
    return finished(figure, 330, "x unified", **legend()), f"{words.label_of(signal)}, recording {recording}"


def next_input(run: NextRun) -> go.Figure:
    """Return the command of a proposed run over time."""
    kind = run.input_kind
    step = max(float(np.ptp(run.command)), 1e-9) / 2000.0
    figure = go.Figure(curve(run.time, run.command, step, line={"color": INK, "width": 1.3, "shape": "hv"}))
    figure.update_xaxes(title_text="time [s]")
    figure.update_yaxes(title_text=f"{kind} [{'A' if kind == 'current' else 'V'}]")
    return finished(figure, 240)
