"""A rig: its arm, its recordings, and the figure by which it is judged."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from flexarm_env.arm import Arm
from flexarm_env.recordings.recording import Recording
from flexarm_env.rigs.metric import Metric
from flexarm_env.terminal.inputs import calibration


@dataclass(frozen=True)
class Record:
    """One recording of a rig.

    Attributes:
        file: its path in the folder of measurements.
        name: in tables; the stem of the file by default.
        replacing: texts of the arm's column map that this recording has otherwise, such as the number of its cell.
        conditions: that the publisher states elsewhere than in the file, in SI.
        start: of the part that counts, as a share of the duration.
        stop: its end, likewise.
    """

    file: str
    name: str = ""
    replacing: Mapping[str, str] = field(default_factory=dict)
    conditions: Mapping[str, float] = field(default_factory=dict)
    start: float = 0.0
    stop: float = 1.0

    def read(self, folder: Path, arm: Arm) -> Recording:
        """Read the recording by the arm's column map.

        Args:
            folder: of the measurements.
            arm: of the rig.

        Raises:
            InputError: for a file that is absent, or that the map does not fit.
        """
        text = json.dumps(arm.columns)
        for one, other in self.replacing.items():
            text = text.replace(one, other)
        run = Recording.read(folder / self.file, json.loads(text), calibration(arm))
        run = replace(run, name=self.name or run.name, conditions=run.conditions | dict(self.conditions))
        if (self.start, self.stop) == (0.0, 1.0):
            return run
        end = None if self.stop == 1.0 else self.stop * run.duration
        return run.part(self.start * run.duration, end)


@dataclass(frozen=True)
class Published:
    """A figure that the publisher, or an independent study, found.

    Attributes:
        model: to which it belongs, in words.
        value: in the unit of the rig's metric.
    """

    model: str
    value: float


@dataclass(frozen=True)
class Rig:
    """A real machine whose recordings lie in a folder of measurements.

    Attributes:
        name: of its table row and of its files.
        title: in words.
        source: where arm and recordings come from.
        arm: name of the shipped arm: the maker's or publisher's model, without what is missing.
        training: the recordings that are diagnosed.
        held_out: the recordings that judge, never fitted.
        metric: of an arm on recordings.
        published: figures to compare with, the best last.
        goal: for the held-out figure; None where none is set.
    """

    name: str
    title: str
    source: str
    arm: str
    training: Sequence[Record]
    held_out: Sequence[Record]
    metric: Metric
    published: Sequence[Published] = ()
    goal: float | None = None

    def is_in(self, folder: Path) -> bool:
        """Whether all its files lie in a folder of measurements."""
        return all((folder / record.file).is_file() for record in (*self.training, *self.held_out))

    def reaches_goal(self, value: float) -> bool:
        """Whether a figure is as good as the goal."""
        if self.goal is None:
            return False
        return value >= self.goal if self.metric.higher_is_better else value <= self.goal
