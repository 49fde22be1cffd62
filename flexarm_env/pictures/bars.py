"""Bar charts of the error after each step, of the error budget, of the ranking of effects, and of the change of each constant."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import plotly.graph_objects as go

from flexarm_env.identify.calibrate.estimate import Estimate
from flexarm_env.identify.explain.budget import REST, Budget
from flexarm_env.identify.percent import percent
from flexarm_env.identify.results import Candidate, Diagnosis
from flexarm_env.pictures import words
from flexarm_env.pictures.plots import legend, with_layout
from flexarm_env.pictures.style import AFTER, AFTER_BAR, BEFORE, BEFORE_BAR, INK, QUIET_BAR

NOISE_BAR = {"color": "white", "line": {"color": INK, "width": 1}, "pattern": {"shape": ".", "fgcolor": INK, "size": 5}}
REMOVED_BAR = {
    "color": "rgba(0,0,0,0)",
    "line": {"color": "#888888", "width": 1},
    "pattern": {"shape": "-", "fgcolor": "#cccccc", "size": 6},
}
ADDED_BAR = {
    "color": "rgba(0,0,0,0)",
    "line": {"color": BEFORE, "width": 1.5},
    "pattern": {"shape": "x", "fgcolor": BEFORE, "size": 7},
}
#: Looks of constants and effects in their order, and of what nothing explains.
STEP_BARS = (
    {"color": "#8c8c8c"},
    {"color": AFTER},
    {"color": "#56b4e9", "pattern": {"shape": "/", "fgcolor": "white", "size": 8, "solidity": 0.12}},
    {"color": "#009e73", "pattern": {"shape": ".", "fgcolor": "white", "size": 6}},
)
NOTHING_BAR = {
    "color": "white",
    "line": {"color": BEFORE, "width": 1.5},
    "pattern": {"shape": ".", "fgcolor": BEFORE, "size": 6, "solidity": 0.1},
}
RANKED = 8


def waterfall(steps: Sequence[tuple[str, float]]) -> go.Figure:
    """Draw the error over the noise after each step, the part that the step removed or added, and the noise floor.

    Numbers stand beside the names, so that every bar and box ends where its value is.
    """
    values = [value for _, value in steps]
    names = [f"{_broken(name)} <b>{words.number(value)}</b>" for name, value in steps]
    looks = [BEFORE_BAR, *[QUIET_BAR] * (len(steps) - 2), AFTER_BAR] if len(steps) > 1 else [BEFORE_BAR]
    figure = go.Figure()
    for name, value, look in zip([*names, "noise floor <b>1</b>"], [*values, 1.0], [*looks, NOISE_BAR], strict=True):
        figure.add_trace(go.Bar(x=[value], y=[name], orientation="h", marker=look, hoverinfo="x+y"))
    for name, last, value in zip(names[1:], values, values[1:], strict=False):
        box = {"base": [min(last, value)], "y": [name], "orientation": "h", "hoverinfo": "skip"}
        figure.add_trace(go.Bar(x=[abs(last - value)], marker=REMOVED_BAR if value < last else ADDED_BAR, **box))
    figure.add_vline(x=1.0, line={"color": INK, "width": 1.2, "dash": "dot"})
    figure.update_yaxes(autorange="reversed", showgrid=False)
    figure.update_xaxes(title_text="rms error / noise", range=[0.0, 1.04 * max([*values, 1.2])])
    return with_layout(figure, 90 + 46 * (len(steps) + 1), barmode="overlay", bargap=0.3)


def budget(found: Budget) -> go.Figure:
    """Draw the shares of the excess error, of all signals and of each, as stacked bars."""
    rows = {"all signals": found.shares, **{words.label_of(signal): shares for signal, shares in found.signals.items()}}
    shown = {name: shares for name, shares in rows.items() if all(map(math.isfinite, shares.values()))}
    figure = go.Figure()
    for place, step in enumerate(found.shares):
        look = NOTHING_BAR if step == REST else STEP_BARS[place % len(STEP_BARS)]
        values = [100.0 * shares[step] for shares in shown.values()]
        name = "nothing" if step == REST else step.replace("_", " ")
        text = [percent(value / 100.0) for value in values]
        inside = {"text": text, "textposition": "inside", "insidetextanchor": "middle", "textangle": 0, "constraintext": "inside"}
        figure.add_trace(go.Bar(x=values, y=list(shown), name=name, orientation="h", marker=look, hoverinfo="x+name", **inside))
    figure.update_yaxes(autorange="reversed", showgrid=False)
    figure.update_xaxes(title_text="share of the excess error [%]", zeroline=True)
    figure.update_layout(uniformtext={"minsize": 11, "mode": "hide"})
    return with_layout(figure, 110 + 34 * len(shown), barmode="relative", bargap=0.25, top=40, **legend(1.02))


def _broken(name: str) -> str:
    return name.replace(" +", "<br>+").replace("constants refitted", "constants<br>refitted").replace("_", " ")


def ranking(diagnosis: Diagnosis, count: int = RANKED) -> go.Figure:
    """Draw the share of the excess error that each effect removes; bars of accepted effects are filled."""
    found = diagnosis.ranking[:count]
    same = {name for names in diagnosis.equivalent for name in names}
    figure = go.Figure()
    for one in found:
        gain = 100.0 * one.gain
        text = f"<b>{gain:.0f} %</b>" if one.accepted else f"{gain:.0f} %"
        figure.add_trace(
            go.Bar(
                x=[gain],
                y=[_label(one, same)],
                orientation="h",
                marker=AFTER_BAR if one.accepted else _equivalent_bar() if one.effect in same else QUIET_BAR,
                text=[text],
                textposition="outside" if gain < 85.0 else "inside",
                cliponaxis=False,
                hovertext=[words.parameters_of(one.estimates)],
            )
        )
    figure.update_yaxes(autorange="reversed", showgrid=False)
    figure.update_xaxes(title_text="excess error removed [%]", range=[0.0, 102.0])
    return with_layout(figure, 90 + 30 * len(found), barmode="overlay", bargap=0.3)


def _label(one: Candidate, same: set[str]) -> str:
    name = one.effect.replace("_", " ")
    return f"<b>✓ {name}</b>" if one.accepted else f"≈ {name}" if one.effect in same else name


def _equivalent_bar() -> dict[str, Any]:
    return {"color": "white", "line": {"color": AFTER, "width": 1}, "pattern": {"shape": "x", "fgcolor": AFTER, "size": 6}}


def constant_changes(estimates: Sequence[Estimate]) -> go.Figure | None:
    """Draw the change of each constant against the arm file [%] with its 90 % interval; None where none had a value."""
    shown = [e for e in estimates if e.nominal and all(map(math.isfinite, (e.nominal, e.value, e.low, e.high)))]
    if not shown:
        return None

    def percent(value: float, e: Estimate) -> float:
        return round(100.0 * (value - e.nominal) / abs(e.nominal), 3)

    value = [percent(e.value, e) for e in shown]
    above = [max(percent(e.high, e) - v, 0.0) for e, v in zip(shown, value, strict=True)]
    below = [max(v - percent(e.low, e), 0.0) for e, v in zip(shown, value, strict=True)]
    moved = [not e.low <= e.nominal <= e.high for e in shown]
    figure = go.Figure(
        go.Scatter(
            x=value,
            y=[words.constant_name(e).replace("_", " ") for e in shown],
            mode="markers",
            marker={"size": 9, "color": AFTER, "symbol": ["circle" if m else "circle-open" for m in moved]},
            error_x={"type": "data", "array": above, "arrayminus": below, "color": INK, "thickness": 1.4, "width": 4},
        )
    )
    figure.add_vline(x=0.0, line={"color": INK, "width": 1.2, "dash": "dot"})
    figure.update_yaxes(autorange="reversed")
    figure.update_xaxes(title_text="change against the arm file [%]")
    return with_layout(figure, 90 + 26 * len(shown))
