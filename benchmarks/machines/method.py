"""The method that answers: a diagnosis, of which a crash or a refusal is an answer too."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from benchmarks.answers.run import by_diagnosis
from flexarm_env import Arm, Recording

#: Verdict on a case that ended in an error.
FAILED = "failed"


def by_diagnosis_or_failure(arm: Arm, recordings: Sequence[Recording]) -> dict[str, Any]:
    """Diagnose; where that ends in an error give its message, so that the other cases are still answered."""
    try:
        return by_diagnosis(arm, recordings)
    except Exception as error:
        message = f"{type(error).__name__}: {error}"
        return {
            "verdict": FAILED,
            "effects": [],
            "probability": [],
            "ranking": [],
            "error": {},
            "constants": {},
            "message": message,
        }
