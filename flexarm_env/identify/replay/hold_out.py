"""Hold out less where a missing effect shows only in the held-out part."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.error_measure import error_measure, score, window_errors
from flexarm_env.identify.replay.readings import share_of
from flexarm_env.identify.replay.run import Run
from flexarm_env.identify.settings import Settings


def hold_out_late(calibrated: Arm, dataset: Dataset) -> Dataset:
    """Show calibrations more of the recordings where a calibrated arm is right in all that they saw and fails thereafter.

    An amplifier's limit, an end stop or a load may come into play once, late in a recording. Of each recording that fails,
    calibrations then see as large a share of its excess error as they see of the others' time.

    Args:
        calibrated: the arm with its constants calibrated.
        dataset: the recordings, held out as usual.

    Returns:
        The same dataset object where nothing changes.
    """
    if not error_measure(calibrated).judges_free_run:
        return dataset
    held, fitted = score(calibrated, dataset), score(calibrated, dataset, held_out=False)
    settings = dataset.settings
    if held.windows < settings.errors.explained:
        return dataset
    if fitted.excess > settings.preparation.late_least_shown * held.excess:
        return dataset
    runs = []
    for run, errors in zip(dataset.runs, window_errors(calibrated, dataset.plants(calibrated), dataset), strict=True):
        shares = share_of(run.measured)
        runs.append(_show(run, _share_shown(np.mean(errors**2, axis=1) - shares, shares, settings), settings))
    unchanged = all(new.train.sum() == run.train.sum() for new, run in zip(runs, dataset.runs, strict=True))
    return dataset if unchanged else replace(dataset, runs=tuple(runs))


def hold_out_notes(dataset: Dataset) -> list[str]:
    """Describe the recordings of which less is held out than usual, a line each."""
    usual = dataset.settings.preparation.held_out_share
    shown = [(run.name, float(time[run.train][-1] / time[-1])) for run in dataset.runs for time in [run.measured_time]]
    return [
        f"{name}: fits see the first {100 * share:.0f} %, not {100 * (1 - usual):.0f} %, since what the model lacks shows late"
        for name, share in shown
        if 100 * share > 100 * (1 - usual) + 1
    ]


def _share_shown(excesses: np.ndarray, shares: np.ndarray, settings: Settings) -> float:
    """Compute the share of a recording in which it shows enough of its excess error.

    Args:
        excesses: (samples,) error in excess of the noise, as a variance.
        shares: (samples,) of the signals that were measured.
        settings: thresholds.
    """
    total = np.cumsum(excesses)
    if total[-1] < (settings.errors.explained**2 - 1.0) * np.sum(shares):
        return 0.0
    return float(np.argmax(total >= (1.0 - settings.preparation.held_out_share) * total[-1]) + 1) / len(total)


def _show(run: Run, share: float, settings: Settings) -> Run:
    latest = 1.0 - settings.preparation.late_least_held_out
    seen = np.arange(len(run.time)) < min(share, latest) * len(run.time)
    time = run.measured_time
    return replace(run, train=run.train | (seen & (time < latest * time[-1])))
