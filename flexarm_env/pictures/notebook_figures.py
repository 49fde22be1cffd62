"""What `.plot()` returns: one Plotly figure of an arm, a recording, a comparison or a diagnosis."""

from __future__ import annotations

from functools import singledispatch

import plotly.graph_objects as go
from plotly.subplots import make_subplots

from flexarm_env.arm import Arm
from flexarm_env.experiments.simulate import simulate
from flexarm_env.identify.results import Comparison, Diagnosis
from flexarm_env.pictures import bars, overlays, words
from flexarm_env.pictures.telling import most_telling, replay_of
from flexarm_env.recordings.recording import Recording

DURATION = 5.0


@singledispatch
def figure_of(shown: object) -> go.Figure:
    """Return a figure of a result."""
    raise TypeError(f"nothing draws a {type(shown).__name__}")


@figure_of.register
def _(arm: Arm) -> go.Figure:
    """What the arm's sensors show after pulses of the command, without noise."""
    drawn = overlays.recorded(simulate(arm, "pulse", duration=DURATION, noise=False))
    return drawn.update_layout(title_text=f"Arm {arm.name} under pulses", margin_t=70)


@figure_of.register
def _(recording: Recording) -> go.Figure:
    """What went in and what was measured."""
    return overlays.recorded(recording).update_layout(title_text=f"Recording {recording.name}", margin_t=70)


@figure_of.register
def _(result: Comparison) -> go.Figure:
    """Measured against modelled in the recording that the model misses most."""
    name, _, _ = most_telling(result)
    return overlays.signals(replay_of(result, name), None, result.noise)


@figure_of.register
def _(result: Diagnosis) -> go.Figure:
    """The ranking of effects beside the falling error."""
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
