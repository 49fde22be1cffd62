"""Notebook display of an arm, a recording, a comparison and a diagnosis: short tables, without Plotly."""

from __future__ import annotations

from collections.abc import Sequence
from functools import singledispatch
from html import escape

import numpy as np

from flexarm_env.arm import Arm, short_name
from flexarm_env.identify.explain.comparison import Comparison
from flexarm_env.identify.results import Diagnosis
from flexarm_env.parameters import INPUTS
from flexarm_env.pictures import words
from flexarm_env.recordings.recording import Recording

SHORT_RANKING = 6


@singledispatch
def as_html(shown: object) -> str:
    """Format a result as a piece of HTML."""
    raise TypeError(f"nothing shows a {type(shown).__name__}")


def _table(heading: str, columns: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    head = "".join(f"<th>{escape(column)}</th>" for column in columns)
    body = "".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<p><b>{escape(heading)}</b></p><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


@as_html.register
def _(arm: Arm) -> str:
    paths = [f"{section}.{key}" for section, table in arm.constants.items() for key in table]
    paths += [f"effects.{name}.{key}" for name, table in arm.effects.items() for key in table]
    rows = []
    for path in paths:
        unit = arm.parameter(path).under(arm.input).unit
        fitted = arm.fitted.get(path)
        spread = "" if fitted is None else f"{words.number(fitted['low'], 4)} to {words.number(fitted['high'], 4)}"
        rows.append([short_name(path), words.number(arm.value(path), 4), spread, words.plain_unit(unit)])
    heading = f"Arm {arm.name}, {arm.input} drive, measures {', '.join(arm.signals)}"
    return _table(heading, ["value", "", "90 % interval", "unit"], rows)


@as_html.register
def _(recording: Recording) -> str:
    unit = INPUTS[recording.input_kind]
    rows = [[recording.input_kind, *_reach(recording.command), unit]]
    for signal in words.signals_of(list(recording.signals)):
        label, unit = words.label_of(signal), words.unit_of(signal)
        rows.append([label, *_reach(recording.signals[signal]), unit])
    gaps = f", {words.counted(len(recording.gaps), 'gap')}" if recording.gaps else ""
    rate = f"{recording.duration:.4g} s at {1.0 / recording.sample_time:.4g} Hz"
    heading = f"Recording {recording.name}: {words.counted(len(recording), 'sample')}, {rate}{gaps}"
    return _table(heading, ["", "from", "to", "unit"], rows)


def _reach(values: np.ndarray) -> list[str]:
    return [words.number(float(np.nanmin(values))), words.number(float(np.nanmax(values)))]


@as_html.register
def _(result: Comparison) -> str:
    rows = [
        [
            words.label_of(r.signal),
            r.part,
            words.number(r.error),
            words.number(r.free_run),
        ]
        for r in result.rows
        if (r.recording == "all" or len(result.replays) == 1) and r.samples
    ]
    return _table(words.comparison(result), ["signal", "part", "windows of 1 s", "free run"], rows)


@as_html.register
def _(result: Diagnosis) -> str:
    probable = words.probabilities(result)
    ranking = [
        [
            "✓" if c.accepted else "",
            c.effect,
            f"{100 * c.gain:.0f} %",
            probable.get(c.effect, ""),
            words.parameters_of(c.estimates),
        ]
        for c in result.ranking[:SHORT_RANKING]
    ]
    steps = [[name, words.number(value)] for name, value in words.steps_of(result.error, result.effects)]
    first = _table(words.verdict(result), ["step", "held-out error over noise"], steps)
    second = _table("Effects", ["", "effect", "gain", "probability", "parameters (90 % interval)"], ranking)
    return first + (second if ranking else "")
