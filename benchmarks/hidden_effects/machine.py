"""The machine of a case: its recordings, made by the independent rig."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from flexarm_env import Recording
from tests.rig import SIGNALS, simulate

#: A run of a case: the rig's experiment, the factor on the controller's gains, and a known payload [kg].
Plan = tuple[str, float, float]


def record(settings: Mapping[str, float], runs: Sequence[Plan], seed: int) -> list[Recording]:
    """Simulate the recordings of a machine's runs, rounded as in a file."""
    return [_recorded(settings, run, seed) for run in runs]


def largest_command(settings: Mapping[str, float], runs: tuple[Plan, ...], seed: int) -> float:
    """Find the largest command [A] of a machine's runs."""
    return max(float(np.abs(_played(settings, run, seed)["current"]).max()) for run in runs)


def _played(settings: Mapping[str, float], run: Plan, seed: int) -> dict[str, np.ndarray]:
    experiment, gains, payload = run
    return simulate({**settings, "pd": gains, "payload": settings.get("payload", 0.0) + payload}, experiment, seed)


def _recorded(settings: Mapping[str, float], run: Plan, seed: int) -> Recording:
    made, (experiment, _, payload) = _played(settings, run, seed), run
    signals = {name: np.round(made[name], 5) for name in SIGNALS}
    known = {"payload": payload} if payload else {}
    return Recording.from_arrays(experiment, made["time"], "current", np.round(made["current"], 5), signals, conditions=known)
