"""Figures of residuals against possible drivers (time, angle, speed, command) and by frequency."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots
from scipy.signal import welch

from flexarm_env.identify.explain.bands import at_own_rate
from flexarm_env.identify.explain.comparison import Comparison, Replay
from flexarm_env.parameters import INPUTS
from flexarm_env.pictures.overlays import AS_GIVEN, CORRECTED, band
from flexarm_env.pictures.plots import Floats, digits, in_steps, legend, where_measured, with_layout
from flexarm_env.pictures.style import AFTER_LINE, BEFORE_LINE, INK, REGIMES
from flexarm_env.recordings.recording import Recording

POINTS = 1300  # of a scatter
BINS = 24
#: Differences of the angle are taken over this [s], which keeps the speed above the noise.
SPEED_TIME = 0.04
#: Bound on the residual of a diverged replay, over the noise.
LARGEST = 1e6
SEGMENT = 1024  # samples, of Welch's method


@dataclass(frozen=True)
class Driver:
    """A quantity that may drive an error: name, unit, and values (samples,) of all recordings in order."""

    name: str
    unit: str
    values: Floats

    @property
    def title(self) -> str:
        """Format name and unit."""
        return f"{self.name} [{self.unit}]"


def drivers(comparison: Comparison, recordings: Sequence[Recording]) -> list[Driver]:
    """Collect time, command, and the angle and speed where they were measured, over all recordings."""
    replays = comparison.replays
    ends = np.cumsum([0.0, *(one.time[-1] for one in replays)])
    found = [
        Driver(
            "time, one recording after another", "s", np.concatenate([r.time + e for r, e in zip(replays, ends, strict=False)])
        )
    ]
    if "arm_angle" in comparison.noise:
        angles = [between_readings(one.time, one.measured["arm_angle"]) for one in replays]
        found.append(Driver("arm angle", "rad", np.concatenate(angles)))
    speeds = [_speed(one, comparison) for one in replays]
    if all(speed is not None for speed in speeds):
        found.append(Driver("arm speed", "rad/s", np.concatenate(speeds)))  # type: ignore[arg-type]
    unit = INPUTS[comparison.arm.input]
    pairs = zip(replays, recordings, strict=True)  # a comparison may have left out samples
    commands = [run.command[np.searchsorted(run.time - run.time[0], one.time)] for one, run in pairs]
    found.append(Driver(comparison.arm.input, unit, np.concatenate(commands)))
    return found


def _speed(one: Replay, comparison: Comparison) -> Floats | None:
    """Estimate the arm's speed [rad/s] from the measurements; None where neither speed nor angle was measured."""
    if "motor_speed" in one.measured:
        gain = comparison.arm.sensors["motor_speed"]["gain"] or 1.0
        speed = between_readings(one.time, one.measured["motor_speed"])
        return np.asarray(speed / gain / comparison.arm.constants["drive"]["gear_ratio"])
    if "arm_angle" not in one.measured:
        return None
    width = max(int(SPEED_TIME / float(np.median(np.diff(one.time)))), 1)
    angle = between_readings(one.time, one.measured["arm_angle"])
    smooth = np.convolve(np.pad(angle, width, "edge"), np.ones(2 * width + 1) / (2 * width + 1), "valid")
    return np.gradient(smooth, one.time)


def versus_driver(driver: Driver, before: Comparison, after: Comparison | None, signal: str) -> go.Figure:
    """Draw a signal's residual over its noise against a driver, by regime: as given above, corrected below."""
    models = [(AS_GIVEN, before), *([(CORRECTED, after)] if after is not None else [])]
    figure = make_subplots(
        len(models), 1, shared_xaxes=True, shared_yaxes="all", vertical_spacing=0.11, subplot_titles=[m for m, _ in models]
    )
    figure.update_annotations(x=0, xanchor="left", font_size=13)
    regime = np.concatenate([one.regime for one in before.replays])
    for row, (_, comparison) in enumerate(models, start=1):
        off = residual(comparison, signal)
        some = np.flatnonzero(np.isfinite(off) & np.isfinite(driver.values))
        some = some[:: max(len(some) // POINTS, 1)]
        for code, (name, colour, symbol) in enumerate(REGIMES):
            chosen = some[regime[some] == code]
            marker = {"color": colour, "symbol": symbol, "size": 5, "opacity": 0.75}
            look: dict[str, Any] = {
                "name": name,
                "legendgroup": name,
                "mode": "markers",
                "marker": marker,
                "showlegend": row == 1,
            }
            figure.add_trace(go.Scatter(x=digits(driver.values[chosen]), y=in_steps(off[chosen], 0.1), **look), row, 1)
        if driver.unit != "s":
            x, middle = _medians(driver.values, off)
            line = {"color": INK, "width": 2.5}
            figure.add_trace(
                go.Scatter(x=digits(x), y=in_steps(middle, 0.01), mode="lines", line=line, name="median", showlegend=row == 1),
                row,
                1,
            )
        band(figure, row)
    figure.update_xaxes(title_text=driver.title, row=len(models))
    figure.update_yaxes(title_text="residual [σ]")
    return with_layout(figure, 200 + 130 * len(models), top=52, **legend(1.08))


def residual(comparison: Comparison, signal: str) -> Floats:
    """Compute a signal's error over its noise (samples,), in windows of 1 s, over all recordings in order; NaN in gaps."""
    return np.concatenate([(r.measured[signal] - r.windows[signal]) / comparison.noise[signal] for r in comparison.replays])


def between_readings(time: Floats, values: Floats) -> Floats:
    """Interpolate a driver (samples,) between the readings of a slower sensor; NaN in gaps."""
    return (
        values
        if not np.isnan(values).any()
        else np.interp(time, *where_measured(time, values, values), left=np.nan, right=np.nan)
    )


def _medians(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    there = ~(np.isnan(x) | np.isnan(y))
    x, y = x[there], y[there]
    if not len(x):
        return x, y
    edges = np.linspace(np.percentile(x, 0.5), np.percentile(x, 99.5), BINS + 1)
    place = np.digitize(x, edges)
    full = [k for k in range(1, BINS + 1) if (place == k).sum() >= 5]
    return np.array([0.5 * (edges[k - 1] + edges[k]) for k in full]), np.array([np.median(y[place == k]) for k in full])


def spectrum(before: Comparison, after: Comparison | None, signal: str) -> go.Figure:
    """Draw the residual's spectrum, scaled to 1 for white noise of the sensor's size."""
    figure = go.Figure()
    for name, line, comparison in ((AS_GIVEN, BEFORE_LINE, before), (CORRECTED, AFTER_LINE, after)):
        if comparison is not None:
            frequency, size = amplitude(comparison, signal)
            figure.add_trace(go.Scatter(x=digits(frequency), y=digits(size), mode="lines", name=name, line=line))
    ends = digits(frequency[[0, -1]])
    figure.add_trace(
        go.Scatter(x=ends, y=[1.0, 1.0], mode="lines", name="noise", line={"color": INK, "width": 1.2, "dash": "dot"})
    )
    figure.update_xaxes(title_text="frequency [Hz]", type="log")
    figure.update_yaxes(title_text="residual / noise", type="log")
    return with_layout(figure, 330, "x unified", **legend())


def amplitude(comparison: Comparison, signal: str) -> tuple[Floats, Floats]:
    """Estimate the residual's amplitude spectrum over that of the sensor's white noise, with its frequencies [Hz]."""
    series = [at_own_rate(one, signal, float(np.median(np.diff(one.time)))) for one in comparison.replays]
    powers, weights = [], []
    shortest = min(len(errors) for errors, _ in series)
    frequency = np.zeros(0)
    for errors, interval in series:
        off = np.clip(np.nan_to_num(errors / comparison.noise[signal]), -LARGEST, LARGEST)
        frequency, power = welch(off, 1.0 / interval, nperseg=min(SEGMENT, shortest), detrend=False)
        powers.append(power / interval / 2.0)
        weights.append(len(off))
    whole = np.average(powers, axis=0, weights=weights)
    return frequency[1:-1], np.sqrt(whole[1:-1])  # Welch scales both ends differently
