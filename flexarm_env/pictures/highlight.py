"""The most informative window of the recordings: the one in which a correction reduces the residual most."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from flexarm_env.identify.explain.comparison import Comparison, Replay
from flexarm_env.identify.replay.readings import count_of, errors_of
from flexarm_env.pictures import words

ZOOM, CLOSE = 1.6, 0.8  # [s], in print and on a page that may be a phone's


def replay_of(comparison: Comparison, recording: str) -> Replay:
    """Find the replay of a recording by its name."""
    return next(replay for replay in comparison.replays if replay.name == recording)


def most_informative_window(before: Comparison, after: Comparison | None = None, length: float = ZOOM) -> tuple[str, str, float]:
    """Locate the window in which the residual over the noise falls most: recording, signal, start [s].

    Args:
        before: of the arm as given.
        after: of the corrected arm; without it, or where no residual falls, the window has the largest residual.
        length: of the window [s].
    """
    best, found = -np.inf, ("", "", 0.0)
    for old in before.replays:
        new = None if after is None else replay_of(after, old.name)
        span = min(max(int(length / float(np.median(np.diff(old.time)))), 1), len(old.time))
        for signal in words.signals_of(list(old.measured)):
            gains = _reduction(old, new, signal, before.noise[signal], span)
            if gains.size and gains.max() > best:
                best, found = float(gains.max()), (old.name, signal, float(old.time[int(gains.argmax())]))
    return most_informative_window(before, None, length) if after is not None and best <= 0.0 else found


def worst_signals(comparison: Comparison) -> list[str]:
    """Sort the signals by error over noise, the largest first."""
    powers = {}
    for signal, noise in comparison.noise.items():
        total = sum(float(_power(one, signal, noise).sum()) for one in comparison.replays)
        powers[signal] = total / sum(count_of(one.measured[signal]) for one in comparison.replays)
    return sorted(words.signals_of(list(powers)), key=lambda signal: -powers[signal])


def error_by_second(replays: Sequence[Replay], noise: dict[str, float]) -> list[list[float]]:
    """Compute, for each recording, the rms error over noise of all signals in each second; NaN where nothing was measured."""
    out = []
    for one in replays:
        power = np.sum([_power(one, signal, noise[signal]) for signal in one.measured], axis=0)
        count = np.sum([~np.isnan(values) for values in one.measured.values()], axis=0)
        second = one.time.astype(int)
        totals = [(power[second == s].sum(), count[second == s].sum()) for s in np.unique(second)]
        out.append([float(np.sqrt(total / readings)) if readings else math.nan for total, readings in totals])
    return out


def _reduction(old: Replay, new: Replay | None, signal: str, noise: float, span: int) -> np.ndarray:
    """Compute the reduction of the sum of squares over `span` samples, by first sample."""
    fall = _power(old, signal, noise) - (0.0 if new is None else _power(new, signal, noise))
    sums = np.cumsum(np.concatenate([[0.0], fall]))
    return np.asarray(sums[span:] - sums[:-span])


def _power(one: Replay, signal: str, noise: float) -> np.ndarray:
    return np.nan_to_num(errors_of(one.measured[signal], one.windows[signal], noise) ** 2, nan=1e12, posinf=1e12)
