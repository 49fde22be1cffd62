"""Time of a diagnosis of the shipped recordings."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import flexarm_env.demo
from flexarm_env import Arm, Recording, diagnose
from flexarm_env.demo.story import ARM, JOBS


def measure(say: Callable[[str], None]) -> dict[str, Any]:
    """Time one diagnosis, from recordings in memory to the verdict."""
    say(f"diagnosis of the shipped recordings on {JOBS} cores, one to three minutes")
    recordings = Recording.read_all(Path(flexarm_env.demo.__file__).parent)
    arm = Arm.load(ARM)
    start = time.perf_counter()
    found = diagnose(arm, recordings, jobs=JOBS)
    return {
        "diagnosis_s": time.perf_counter() - start,
        "diagnosis_jobs": JOBS,
        "diagnosis_recordings": len(recordings),
        "diagnosis_verdict": str(found.verdict),
    }
