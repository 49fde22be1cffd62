"""The machine of a case: its recordings, made by the independent rig."""

from __future__ import annotations

import numpy as np

from benchmarks.hidden_effects.cases import Case
from flexarm_env import Recording
from tests.rig import SIGNALS, simulate


def record(case: Case) -> list[Recording]:
    """Return the recordings of a case, rounded as a file has them."""
    return [_run(case, *run) for run in case.runs]


def _run(case: Case, experiment: str, gains: float, payload: float) -> Recording:
    settings = case.settings | {"pd": gains, "payload": case.settings.get("payload", 0.0) + payload}
    made = simulate(settings, experiment, case.seed)
    signals = {name: np.round(made[name], 5) for name in SIGNALS}
    known = {"payload": payload} if payload else {}
    return Recording.from_arrays(experiment, made["time"], "current", np.round(made["current"], 5), signals, conditions=known)
