"""Hold out later where what is missing shows only in the part that was held out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.data import HELD_OUT, Data
from flexarm_env.identify.hypothesis import excess
from flexarm_env.identify.predict import window_observers, window_replay
from flexarm_env.identify.problem import score
from flexarm_env.identify.refit import Refit, best_refit
from flexarm_env.identify.run import Run

#: Share of the held-out part's excess error below which the fitted part shows nothing of it, and the error that is worth it.
LEAST_SHOWN, WORTH = 0.05, 1.2
#: Share of a recording's time and of its samples that is held out at least.
LEAST_HELD_OUT = 0.1


def refit_and_split(nominal: Arm, data: Data) -> tuple[Refit, Data]:
    """Return the arm with its constants refitted, and the data with less held out if what it lacks shows too late."""
    found = best_refit(nominal, data)
    later = held_out_later(found.arm, data)
    return (found, data) if later is data else (best_refit(nominal, later), later)


def later_notes(data: Data) -> list[str]:
    """Return what a person should know of recordings that are held out later than usual, a line each."""
    seen = [(run.name, 100.0 * float(run.time[run.train][-1] / run.time[-1])) for run in data.runs]
    return [
        f"{name}: fits see the first {share:.0f} %, not {100 * (1 - HELD_OUT):.0f} %, since what the model lacks shows late"
        for name, share in seen
        if share > 100.0 * (1.0 - HELD_OUT) + 1.0
    ]


def held_out_later(found: Arm, data: Data) -> Data:
    """Return the data with fits that see more, where a refitted arm is right in all that they saw and fails thereafter.

    An amplifier's limit, an end stop or a load may come into play once, late in a recording. Of each recording that fails, fits
    then see as large a share of its excess error as they see of others' time.

    Args:
        found: the arm, refitted.
        data: the recordings, held out as usual.
    """
    if found.constants["drive"]["torque_noise"] > 0.0:  # feedback is all that such an arm is judged with
        return data
    held, fitted = score(found, data).windows, score(found, data, held_out=False).windows
    if held < WORTH or excess(fitted) > LEAST_SHOWN * excess(held):
        return data
    plants = data.plants(found)
    observers = {payload: window_observers(found, plant, data) for payload, plant in plants.items()}
    runs = []
    for run in data.runs:
        replayed = window_replay(plants[run.payload], run, observers[run.payload], data.noise, data.interval)
        errors = np.nan_to_num((run.measured - replayed) / data.noise, nan=1e6)
        runs.append(_until(run, _shown(np.mean(errors**2, axis=1) - 1.0)))
    unchanged = all(new.train.sum() == run.train.sum() for new, run in zip(runs, data.runs, strict=True))
    return data if unchanged else replace(data, runs=runs)


def _shown(excesses: np.ndarray) -> float:
    """Return the share of a recording (samples,) in which it shows enough of its excess error."""
    total = np.cumsum(excesses)
    if total[-1] < (WORTH**2 - 1.0) * len(total):
        return 0.0
    return float(np.argmax(total >= (1.0 - HELD_OUT) * total[-1]) + 1) / len(total)


def _until(run: Run, share: float) -> Run:
    latest = 1.0 - LEAST_HELD_OUT
    seen = np.arange(len(run.time)) < min(share, latest) * len(run.time)
    return replace(run, train=run.train | (seen & (run.time < latest * run.time[-1])))
