"""Compare, fit, add and diagnose with a progress bar."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import flexarm_env
from flexarm_env.arm import Arm
from flexarm_env.recordings.recording import Recording
from flexarm_env.terminal.progress import progress

if TYPE_CHECKING:
    from flexarm_env.identify.explain.comparison import Comparison
    from flexarm_env.identify.inspect.overview import Overview
    from flexarm_env.identify.results import Addition, Diagnosis, Fit


def inspect(arm: Arm, recordings: Sequence[Recording]) -> Overview:
    """Look at recordings before anything is fitted."""
    from flexarm_env.identify.inspect.overview import overview

    with progress("inspecting") as bar:
        return overview(arm, list(recordings), bar)


def compare(arm: Arm, recordings: Sequence[Recording], rate: float | None = None) -> Comparison:
    """Compare an arm with its recordings."""
    with progress("comparing") as bar:
        return flexarm_env.compare(arm, list(recordings), progress=bar, rate=rate)


def compare_and_inspect(arm: Arm, recordings: Sequence[Recording], rate: float | None = None) -> Comparison:
    """Compare an arm with its recordings, with the faults of these among the notes."""
    found = compare(arm, recordings, rate)
    return replace(found, notes=[*faults(arm, recordings), *found.notes])


def faults(arm: Arm, recordings: Sequence[Recording]) -> list[str]:
    """List the faults of recordings, a line each."""
    return flexarm_env.inspect_recordings(arm, list(recordings)).notes


def fit(arm: Arm, recordings: Sequence[Recording], seed: int, rate: float | None = None) -> Fit:
    """Refit the constants."""
    with progress("fitting") as bar:
        return flexarm_env.fit(arm, list(recordings), progress=bar, seed=seed, rate=rate)


def add(effect: str, arm: Arm, recordings: Sequence[Recording], seed: int, rate: float | None = None) -> Addition:
    """Add an effect and refit."""
    arm.with_effect(effect)  # refuses an impossible effect before a bar shows
    with progress(f"adding {effect}") as bar:
        return flexarm_env.add(effect, arm, list(recordings), progress=bar, seed=seed, rate=rate)


def diagnose(
    arm: Arm, recordings: Sequence[Recording], seed: int, jobs: int, rate: float | None = None, time_limit: float | None = None
) -> Diagnosis:
    """Find out whether constants are wrong or an effect is missing."""
    with progress("diagnosing") as bar:
        given = list(recordings)
        return flexarm_env.diagnose(arm, given, progress=bar, seed=seed, jobs=jobs, rate=rate, time_limit=time_limit)


def write_page(
    path: Path, recordings: Sequence[Recording], before: Comparison, diagnosis: Diagnosis | None, made: Mapping[str, Any]
) -> None:
    """Write the page of a comparison or a diagnosis; arguments as those of `report.write_report`."""
    from flexarm_env.terminal.report import write_report

    with progress("writing the report") as bar:
        write_report(path, recordings, before, diagnosis, made, bar)
