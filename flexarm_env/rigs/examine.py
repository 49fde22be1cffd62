"""One rig examined: diagnosed on its training records, judged on those that were held out."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from flexarm_env.arm import Arm
from flexarm_env.arm_text import arm_text
from flexarm_env.identify.diagnose import diagnose
from flexarm_env.identify.progress import ProgressCallback
from flexarm_env.identify.results import Diagnosis
from flexarm_env.recordings.recording import Recording
from flexarm_env.rigs.rig import Rig

#: The arms that are judged, in the order of their table.
STEPS = ("nominal", "refitted", "final")


@dataclass(frozen=True)
class Posed:
    """A rig with its arm and recordings read.

    Attributes:
        rig: the rig.
        arm: as the maker or publisher has it.
        training: recordings that are diagnosed.
        held_out: recordings that judge.
    """

    rig: Rig
    arm: Arm
    training: list[Recording]
    held_out: list[Recording]

    @property
    def key(self) -> str:
        """Checksum of the arm, the rig's description and the recordings, by which an answer is known again."""
        parts = [arm_text(self.arm), repr(self.rig), *(run.sha256 for run in (*self.training, *self.held_out))]
        return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


@dataclass(frozen=True)
class Examined:
    """A rig with its diagnosis.

    Attributes:
        posed: arm and recordings.
        diagnosis: of the training records.
    """

    posed: Posed
    diagnosis: Diagnosis

    @property
    def arms(self) -> dict[str, Arm]:
        """The arms that are judged, by their step."""
        found = self.diagnosis
        return dict(zip(STEPS, (found.nominal, found.refitted, found.arm), strict=True))

    def figures(self, recordings: Sequence[Recording]) -> dict[str, float]:
        """Compute the rig's figure of each arm on recordings."""
        return {step: self.posed.rig.metric.of(arm, recordings) for step, arm in self.arms.items()}


def pose(rig: Rig, folder: Path) -> Posed:
    """Read a rig's arm and recordings.

    Args:
        rig: the rig.
        folder: of the measurements.

    Raises:
        InputError: for a recording that is absent or does not fit.
    """
    arm = Arm.load(rig.arm)
    training, held_out = ([record.read(folder, arm) for record in part] for part in (rig.training, rig.held_out))
    return Posed(rig, arm, training, held_out)


def examine(posed: Posed, jobs: int = 1, progress: ProgressCallback | None = None) -> Examined:
    """Diagnose a rig on its training records.

    Args:
        posed: the rig with its recordings.
        jobs: processes.
        progress: called with the share done and a text.
    """
    return Examined(posed, diagnose(posed.arm, posed.training, progress, jobs=jobs))


def as_json(examined: Examined) -> dict[str, Any]:
    """Convert to plain data: the figures, the published ones beside them, and the diagnosis."""
    posed, found = examined.posed, examined.diagnosis
    rig, held_out = posed.rig, examined.figures(posed.held_out)
    return {
        "rig": rig.name,
        "title": rig.title,
        "source": rig.source,
        "arm": rig.arm,
        "training": [run.name for run in posed.training],
        "held_out": [run.name for run in posed.held_out],
        "metric": rig.metric.words,
        "unit": rig.metric.unit,
        "figures": held_out,
        "in_sample": examined.figures(posed.training),
        "published": [{"model": one.model, "value": one.value} for one in rig.published],
        "goal": rig.goal,
        "reached": rig.reaches_goal(held_out["final"]),
        "diagnosis": {key: value for key, value in found.as_json().items() if key not in ("trace", "settings", "smallest")},
        "key": posed.key,
    }
