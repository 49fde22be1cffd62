"""Figures of `.plot()`: one Plotly figure of an arm, a recording, a comparison or a diagnosis."""

from __future__ import annotations

from functools import singledispatch

import plotly.graph_objects as go
from plotly.subplots import make_subplots

from flexarm_env.arm import Arm
from flexarm_env.experiments.simulate import simulate
from flexarm_env.identify.explain.comparison import Comparison
from flexarm_env.identify.results import Diagnosis
from flexarm_env.pictures import bars, overlays, words
from flexarm_env.pictures.highlight import most_informative_window, replay_of
from flexarm_env.recordings.recording import Recording

DURATION = 5.0


@singledispatch
def figure_of(shown: object) -> go.Figure:
    """Draw a result."""
    raise TypeError(f"nothing draws a {type(shown).__name__}")


@figure_of.register
def _(arm: Arm) -> go.Figure:
    """Draw the noise-free response of the arm's sensors to pulses of the command."""
    drawn = overlays.recorded(simulate(arm, "pulse", duration=DURATION, noise=False))
    return drawn.update_layout(title_text=f"Arm {arm.name} under pulses", margin_t=70)


@figure_of.register
def _(recording: Recording) -> go.Figure:
    """Draw the command and the measured signals."""
    return overlays.recorded(recording).update_layout(title_text=f"Recording {recording.name}", margin_t=70)


@figure_of.register
def _(result: Comparison) -> go.Figure:
    """Draw measured and modelled signals of the recording with the largest error."""
    name, _, _ = most_informative_window(result)
    return overlays.signals(replay_of(result, name), None, result.noise)


@figure_of.register
def _(result: Diagnosis) -> go.Figure:
    """Draw the ranking of effects beside the error after each step."""
    figure = make_subplots(1, 2, horizontal_spacing=0.22, subplot_titles=["excess error removed [%]", "held-out error / noise"])
    parts = [bars.ranking(result), bars.waterfall(words.steps_of(result.error, result.effects))]
    for column, part in enumerate(parts, start=1):
        for trace in part.data:
            figure.add_trace(trace, 1, column)
        figure.update_xaxes(range=part.layout.xaxis.range, row=1, col=column)
        figure.update_yaxes(autorange="reversed", row=1, col=column)
    height = max(part.layout.height for part in parts) + 60
    return figure.update_layout(
        template="plotly_white", height=height, showlegend=False, barmode="overlay", title_text=words.verdict(result)[:90]
    )
