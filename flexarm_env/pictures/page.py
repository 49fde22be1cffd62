"""One self-contained HTML page of a comparison or a diagnosis, with Plotly figures; it needs no network.

Plotly's library alone has 4.8 MB as text, so it and the figures lie in the page compressed, and the browser unpacks them.
"""

from __future__ import annotations

import base64
import gzip
import math
from collections.abc import Sequence
from html import escape
from typing import Any

import numpy as np
import plotly.graph_objects as go
import plotly.offline
from numpy.typing import NDArray
from plotly.subplots import make_subplots

from flexarm_env import __version__
from flexarm_env.identify.results import Comparison, Diagnosis, Estimate, Replay
from flexarm_env.pictures import words
from flexarm_env.pictures.style import AFTER, BEFORE, INK, MEASURED, QUIET

_CSS = """
body { font: 16px/1.5 system-ui, sans-serif; color: #222; max-width: 1100px; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.15rem; margin-top: 2.2rem; }
.verdict { font-size: 1.15rem; border-left: 5px solid #0072b2; padding: .4rem 0 .4rem 1rem; }
table { border-collapse: collapse; } th, td { padding: .2rem .9rem .2rem 0; text-align: left; }
th { font-weight: 600; border-bottom: 1px solid #999; }
th.n, td.n { text-align: right; font-variant-numeric: tabular-nums; }
footer { margin-top: 3rem; color: #666; font-size: .85rem; }
"""
_TEMPLATE = "plotly_white"
_CONFIG = '{"displaylogo":false,"responsive":true}'
#: Curves are drawn in steps of the noise over this: what is finer is no information, and takes half the page.
STEPS_PER_NOISE = 50.0
_UNPACK = f"""
async function unpack(place) {{
  const bytes = Uint8Array.from(atob(place.textContent), c => c.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
}}
(async () => {{
  const library = document.createElement("script");
  library.textContent = await unpack(document.getElementById("plotly"));
  document.head.append(library);
  for (const place of document.querySelectorAll("div.figure")) {{
    const figure = JSON.parse(await unpack(place.firstElementChild));
    await Plotly.newPlot(place, figure.data, figure.layout, {_CONFIG});
  }}
}})().catch(error => {{
  for (const place of document.querySelectorAll("div.figure"))
    place.textContent = `This browser cannot draw the figure (${{error}}); any of 2023 or later can.`;
}});
"""


def page(before: Comparison, after: Comparison | None = None, diagnosis: Diagnosis | None = None) -> str:
    """Return the page's HTML.

    Args:
        before: the arm as it came.
        after: the corrected arm.
        diagnosis: how it was found.
    """
    sentence = words.comparison(before) if diagnosis is None else words.verdict(diagnosis)
    parts = [f'<p class="verdict">{escape(sentence)}</p>', _list((diagnosis or before).notes)]
    if diagnosis is not None:
        parts += _about(diagnosis)
    else:
        parts += ["<h2>Error over noise</h2>", _errors(before)]
    for old in before.replays:
        new = None if after is None else next(replay for replay in after.replays if replay.name == old.name)
        parts += [f"<h2>Recording {escape(old.name)}</h2>", _html(_signals(old, new, before.noise), old.name)]
    title = f"Arm {before.arm.name} against {len(before.replays)} recordings"
    return _document(title, parts)


def _document(title: str, parts: Sequence[str]) -> str:
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        f'<meta name="viewport" content="width=device-width"><style>{_CSS}</style>'
        f"</head>\n<body><h1>{escape(title)}</h1>\n"
        + "\n".join(parts)
        + f"\n<footer>FlexArm {__version__}</footer>\n"
        + _packed(plotly.offline.get_plotlyjs(), ' id="plotly"')
        + f"\n<script>{_UNPACK}</script></body></html>\n"
    )


def _about(diagnosis: Diagnosis) -> list[str]:
    steps = words.steps_of(diagnosis.error, diagnosis.effects)
    free = words.steps_of(diagnosis.free_run, diagnosis.effects)
    parts = ["<h2>Held-out error</h2>", _html(_falling(steps, free), "error")]
    if diagnosis.ranking:
        parts += ["<h2>Which effect</h2>", _html(_ranking(diagnosis), "ranking")]
        own = [e for c in words.accepted(diagnosis) for e in c.estimates]
        parts += [_estimates(own)] if own else []
    if diagnosis.constants:
        parts += ["<h2>Constants</h2>", _estimates(list(diagnosis.constants.values()))]
    return parts


def _html(figure: go.Figure, name: str) -> str:
    place = "figure-" + "".join(c if c.isalnum() else "-" for c in name)
    figure.update_layout(template=_TEMPLATE, font={"color": INK}, hovermode="x unified")
    height = f"{figure.layout.height}px"
    return f'<div class="figure" id="{place}" style="height:{height}">{_packed(figure.to_json())}</div>'


def _packed(text: str, attributes: str = "") -> str:
    """Return text as an element that no browser shows or runs."""
    packed = base64.b64encode(gzip.compress(text.encode(), compresslevel=9, mtime=0)).decode()
    return f'<script type="text/plain"{attributes}>{packed}</script>'


def _list(lines: Sequence[str]) -> str:
    return "<ul>" + "".join(f"<li>{escape(line)}</li>" for line in lines) + "</ul>" if lines else ""


def _table(columns: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    head = "".join(f"<th{' class=n' if i else ''}>{escape(column)}</th>" for i, column in enumerate(columns))
    body = "".join(
        "<tr>" + "".join(f"<td{' class=n' if i else ''}>{escape(cell)}</td>" for i, cell in enumerate(row)) + "</tr>"
        for row in rows
    )
    return f"<table><tr>{head}</tr>{body}</table>"


def _estimates(found: Sequence[Estimate]) -> str:
    rows = [
        [
            words.constant_name(e),
            words.rounded(e.nominal, e.low, e.high),
            words.rounded(e.value, e.low, e.high),
            words.interval(e),
            words.plain_unit(e.unit),
        ]
        for e in found
    ]
    return _table(["value", "before", "after", "90 % interval", "unit"], rows)


def _errors(result: Comparison) -> str:
    rows = [row for row in result.rows if row.recording == "all" or len(result.replays) == 1]
    names = {signal: label for signal, (label, _) in words.LABELS.items()}
    cells = [[f"{names.get(r.signal, r.signal)}, {r.part}", words.number(r.error), words.number(r.free_run)] for r in rows]
    return _table(["signal, part", "windows of 1 s", "free run"], cells)


def _signals(old: Replay, new: Replay | None, noise: dict[str, float]) -> go.Figure:
    """Measured and modelled signals of a recording, each with its residual, in windows or as one free run."""
    signals = words.signals_of(list(old.measured))
    heights = [part for _ in signals for part in (2.2, 1.0)]
    figure = make_subplots(2 * len(signals), 1, shared_xaxes=True, vertical_spacing=0.012, row_heights=heights)
    models = [("as given", BEFORE, old), *([("corrected", AFTER, new)] if new is not None else [])]
    kinds: list[str] = []
    for i, signal in enumerate(signals):
        label, unit = words.LABELS[signal]
        first = i == 0
        step = noise[signal] / STEPS_PER_NOISE
        _line(figure, 2 * i + 1, old.time, old.measured[signal], step, "measured", MEASURED, first, width=3.0)
        kinds.append("both")
        for name, colour, replay in models:
            for kind, curves in (("windows", replay.windows), ("free", replay.free)):
                off = (replay.measured[signal] - curves[signal]) / noise[signal]
                shown = kind == "windows"
                _line(figure, 2 * i + 1, replay.time, curves[signal], step, name, colour, first, visible=shown)
                _line(
                    figure, 2 * i + 2, replay.time, off, 1.0 / STEPS_PER_NOISE, f"{name}, residual", colour, False, visible=shown
                )
                kinds += [kind, kind]
        figure.update_yaxes(title_text=f"{label} [{unit}]", row=2 * i + 1)
        figure.update_yaxes(title_text="residual [σ]", row=2 * i + 2)
    figure.update_xaxes(title_text="time [s]", row=2 * len(signals))
    figure.update_layout(
        height=80 + 270 * len(signals),
        margin={"t": 60, "r": 10},
        legend={"orientation": "h", "y": 1.0, "yanchor": "bottom"},
        updatemenus=[_switch(kinds)],
    )
    return figure


def _line(
    figure: go.Figure,
    row: int,
    time: NDArray[np.float64],
    values: NDArray[np.float64],
    step: float,
    name: str,
    colour: str,
    legend: bool,
    width: float = 1.2,
    visible: bool = True,
) -> None:
    line = {"color": colour, "width": width}
    # The page's size: even times follow from the first two.
    steps = np.diff(time)
    even = np.allclose(steps, steps[0], rtol=1e-6)
    x = {"x0": 0.0, "dx": round(float(time[-1]) / len(steps), 9)} if even else {"x": np.round(time, 6).tolist()}
    look = {"name": name, "line": line, "mode": "lines", "showlegend": legend, "legendgroup": name, "visible": visible}
    trace: Any = go.Scattergl if len(time) > 20_000 else go.Scatter
    figure.add_trace(trace(y=_in_steps(values, step), **x, **look), row=row, col=1)


def _in_steps(values: NDArray[np.float64], step: float) -> list[float]:
    """Return values to the last decimal that a step needs; a list, since Plotly packs arrays into text that is longer."""
    finite = np.where(np.isfinite(values), values, np.nan)
    rounded: list[float] = np.round(finite, max(-math.floor(math.log10(step)), 0)).tolist()
    return rounded


def _switch(kinds: Sequence[str]) -> dict[str, Any]:
    def shown(kind: str) -> list[bool]:
        return [k in ("both", kind) for k in kinds]

    buttons = [
        {"label": "windows of 1 s from estimated states", "method": "restyle", "args": ["visible", shown("windows")]},
        {"label": "one free run", "method": "restyle", "args": ["visible", shown("free")]},
    ]
    return {"buttons": buttons, "type": "buttons", "direction": "right", "x": 1.0, "y": 1.0, "yanchor": "bottom"}


def _falling(steps: Sequence[tuple[str, float]], free: Sequence[tuple[str, float]]) -> go.Figure:
    figure = make_subplots(1, 2, subplot_titles=("windows of 1 s", "one free run"))
    for column, values in enumerate((steps, free), start=1):
        colours = [BEFORE, *[QUIET] * (len(values) - 2), AFTER] if len(values) > 1 else [BEFORE]
        heights = [value for _, value in values]
        text = [words.number(value) for value in heights]
        figure.add_trace(
            go.Bar(x=[name for name, _ in values], y=heights, text=text, textposition="outside", marker_color=colours),
            row=1,
            col=column,
        )
        figure.add_hline(y=1.0, line_dash="dash", row=1, col=column)
        figure.update_yaxes(title_text="rms error / noise (dashed: noise)", rangemode="tozero", row=1, col=column)
    figure.update_layout(showlegend=False, height=360, margin={"t": 60, "r": 10})
    return figure


def _ranking(diagnosis: Diagnosis) -> go.Figure:
    found = diagnosis.ranking[:12][::-1]
    figure = go.Figure(
        go.Bar(
            x=[100.0 * c.gain for c in found],
            y=[c.effect for c in found],
            orientation="h",
            marker_color=[AFTER if c.accepted else QUIET for c in found],
            hovertext=[words.parameters_of(c.estimates) for c in found],
        )
    )
    figure.update_xaxes(title_text="share of the excess error that it removes [%]")
    figure.update_layout(height=120 + 28 * len(found), margin={"t": 30, "r": 10})
    return figure
