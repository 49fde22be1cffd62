"""Figures for print: measured and modelled signals with residuals, the error after each step, and the loop as a whole."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, ParamSpec

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from flexarm_env.errors import InputError
from flexarm_env.identify.explain.comparison import Comparison, Replay
from flexarm_env.identify.results import Candidate, Diagnosis
from flexarm_env.pictures import words
from flexarm_env.pictures.highlight import ZOOM, most_informative_window, replay_of
from flexarm_env.pictures.plots import where_measured
from flexarm_env.pictures.style import AFTER, BEFORE, INK, MEASURED, QUIET, STYLE

P = ParamSpec("P")
BARS = 6


def _styled(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Draw in the project's style and leave matplotlib's settings as they were."""

    @functools.wraps(draw)
    def styled(*args: P.args, **kwargs: P.kwargs) -> Figure:
        with matplotlib.rc_context(STYLE):
            return draw(*args, **kwargs)

    return styled


def save(figure: Figure, stem: Path, kinds: Sequence[str] = ("png", "svg")) -> list[Path]:
    """Write a figure as PNG and SVG, or one of them; return their paths.

    Raises:
        InputError: if the place cannot be written.
    """
    metadata = {"png": {"Software": None}, "svg": {"Date": None, "Creator": "FlexArm"}}
    paths = [stem.with_suffix(f".{kind}") for kind in kinds]
    try:
        with matplotlib.rc_context(STYLE):
            for path, kind in zip(paths, kinds, strict=True):
                figure.savefig(path, metadata=metadata[kind])
    except OSError as error:
        raise InputError(f"cannot write {stem}: {error.strerror}; name a folder that can be written") from None
    return paths


@_styled
def overlay(before: Comparison, after: Comparison, recording: str, names: tuple[str, str]) -> Figure:
    """Draw measured and modelled signals of a recording, one above the other, each with its residual.

    Args:
        before: of the arm as given.
        after: of the corrected arm.
        recording: name of the recording.
        names: of the two arms in the legend.
    """
    old, new = replay_of(before, recording), replay_of(after, recording)
    signals = words.signals_of(list(old.measured))
    figure = Figure(figsize=(9.5, 1.0 + 2.45 * len(signals)), layout="constrained")
    ratios = [part for _ in signals for part in (2.2, 1.0)]
    axes = figure.subplots(2 * len(signals), 1, sharex=True, squeeze=False, height_ratios=ratios)[:, 0]
    for i, signal in enumerate(signals):
        top, bottom = axes[2 * i], axes[2 * i + 1]
        _curves(top, old, new, signal, names)
        _residuals(bottom, old, new, signal, before.noise[signal])
    axes[0].legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3)
    axes[-1].set_xlabel("time [s]")
    axes[-1].set_xlim(old.time[0], old.time[-1])
    figure.suptitle(f"{recording}: replayed in windows of 1 s from estimated states", x=0.01, ha="left", weight="bold")
    figure.align_ylabels(axes)
    return figure


@_styled
def waterfall(steps: Sequence[tuple[str, float]], free: Sequence[tuple[str, float]]) -> Figure:
    """Draw the held-out error after each step, in windows and in one free run, beside the noise.

    Args:
        steps: name and error over noise, in windows of 1 s.
        free: the same for the free run.
    """
    figure = Figure(figsize=(8.0, 3.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    _falling(left, steps, "windows of 1 s")
    _falling(right, free, "one free run")
    return figure


@_styled
def loop(before: Comparison, after: Comparison, diagnosis: Diagnosis) -> Figure:
    """Draw the loop in one picture: where the model fails, the ranking of effects, the error after each step."""
    figure = Figure(figsize=(13.0, 3.7), layout="constrained")
    grid = figure.add_gridspec(2, 3, width_ratios=[1.5, 1.0, 0.85], height_ratios=[2.0, 1.0])
    top = figure.add_subplot(grid[0, 0])
    bottom = figure.add_subplot(grid[1, 0], sharex=top)
    recording, signal, start = most_informative_window(before, after)
    old, new = replay_of(before, recording), replay_of(after, recording)
    name = words.label_of(signal)
    _curves(top, old, new, signal, ("model as given", f"with {' and '.join(diagnosis.effects) or 'new constants'}"))
    _residuals(bottom, old, new, signal, before.noise[signal])
    top.set_title(f"1  Where it fails: {name}, recording “{recording}”")
    top.legend(loc="best", fontsize=8)
    top.tick_params(labelbottom=False)
    top.set_xlim(start, start + ZOOM)
    _fit_height(top, start, start + ZOOM)
    _fit_height(bottom, start, start + ZOOM)
    bottom.set_xlabel("time [s]")
    _ranking(figure.add_subplot(grid[:, 1]), diagnosis.ranking[:BARS])
    steps = words.steps_of(diagnosis.error, diagnosis.effects)
    _falling(figure.add_subplot(grid[:, 2]), steps, "3  Held-out error by step")
    figure.align_ylabels([top, bottom])
    return figure


def _curves(axes: Axes, old: Replay, new: Replay, signal: str, names: tuple[str, str]) -> None:
    label, unit = words.label_of(signal), words.unit_of(signal)
    axes.plot(*where_measured(old.time, old.measured[signal], old.measured[signal]), color=MEASURED, lw=2.6, label="measured")
    axes.plot(old.time, old.windows[signal], color=BEFORE, lw=1.1, ls=(0, (4, 1.2)), label=names[0])
    axes.plot(new.time, new.windows[signal], color=AFTER, lw=1.1, label=names[1])
    axes.set_ylabel(f"{label}\n[{unit}]")


def _residuals(axes: Axes, old: Replay, new: Replay, signal: str, noise: float) -> None:
    axes.axhspan(-2.0, 2.0, color="#eeeeee", zorder=0)
    for one, colour in ((old, BEFORE), (new, AFTER)):
        measured = one.measured[signal]
        axes.plot(*where_measured(one.time, (measured - one.windows[signal]) / noise, measured), color=colour, lw=0.8)
    axes.set_ylabel("residual\n[noise σ]")


def _fit_height(axes: Axes, start: float, stop: float) -> None:
    """Fit the y axis to the curves between start and stop [s]."""
    shown = np.concatenate([np.asarray(line.get_ydata())[_inside(line, start, stop)] for line in axes.get_lines()])
    low, high = np.nanmin(shown), np.nanmax(shown)
    axes.set_ylim(low - 0.06 * (high - low), high + 0.06 * (high - low))


def _inside(line: Any, start: float, stop: float) -> Any:
    x = np.asarray(line.get_xdata())
    return (x >= start) & (x <= stop)


def _ranking(axes: Axes, candidates: Sequence[Candidate]) -> None:
    names = [c.effect.replace("_", " ") for c in candidates]
    gains = [max(100.0 * c.gain, 0.0) for c in candidates]
    colours = [AFTER if c.accepted else QUIET for c in candidates]
    axes.barh(names, gains, color=colours, height=0.62)
    axes.invert_yaxis()
    axes.set_xlim(0.0, 100.0)
    axes.set_xlabel("share of the excess error that it removes [%]")
    axes.set_title("2  Which effect is missing")
    axes.grid(axis="y", visible=False)
    for place, candidate in enumerate(candidates):
        if candidate.accepted and candidate.estimates:
            inside = gains[place] > 55.0
            axes.annotate(
                words.parameters_of(candidate.estimates).replace("), ", ")\n").replace(" (", "\n("),
                (1.5 if inside else gains[place] + 1.5, place),
                va="center",
                color="white" if inside else INK,
                fontsize=8 if len(candidate.estimates) == 1 else 6,
            )


def _falling(axes: Axes, steps: Sequence[tuple[str, float]], title: str) -> None:
    """Draw horizontal bars, which leave room for the long names of effects."""
    names = [name.replace("_", " ").replace(" +", "\n+") for name, _ in steps]
    values = [value for _, value in steps]
    colours = [BEFORE, *[QUIET] * (len(steps) - 2), AFTER] if len(steps) > 1 else [BEFORE]
    bars = axes.barh(names, values, color=colours, height=0.6)
    axes.bar_label(bars, [words.number(value) for value in values], padding=3, color=INK)
    axes.invert_yaxis()
    axes.axvline(1.0, color=INK, lw=1.0, ls="--")
    axes.set_xlim(0.0, 1.18 * max([*values, 1.2]))
    axes.set_xlabel("rms error / noise (dashed: noise)")
    axes.set_title(title)
    axes.grid(axis="y", visible=False)
    axes.tick_params(axis="y", length=0)
