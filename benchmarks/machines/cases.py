"""The cases: an arm as given, recordings of a machine, and the difference; each determined by its seed and index."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count
from typing import Any

import numpy as np

from benchmarks.answers.place import Place
from benchmarks.machines.effects import Sized
from benchmarks.machines.experiments import Run, runs
from benchmarks.machines.families import FAMILIES
from benchmarks.machines.lacks import effects
from benchmarks.machines.machine import record
from benchmarks.machines.model import Model
from benchmarks.machines.spread import drawn, spreads
from benchmarks.machines.twins import twins
from flexarm_env import Arm, Recording
from flexarm_env.arm import short_name

#: Kinds of cases, in turn.
KINDS = (
    "one",
    "two",
    "sensor",
    "one",
    "null",
    "one",
    "outside",
    "two",
    "one",
    "three",
    "sensor",
    "one",
    "null",
    "two",
    "outside",
    "one",
)
#: Share of the nulls in which the constants are right, too.
EXACT = 0.3


class Key(Place):
    """The place of a machine, which also says of what kind it is."""

    @property
    def kind(self) -> str:
        """One of COUNTS."""
        return KINDS[self.index % len(KINDS)]

    @property
    def name(self) -> str:
        """Name of the case's file."""
        return f"{super().name}-{self.kind}"

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data."""
        return super().as_json() | {"kind": self.kind}

    def pose(self) -> tuple[dict[str, Any], Arm, list[Recording]]:
        """Make the case: its plain data, the arm as given and the recordings."""
        made = case(self.seed, self.index)
        return made.as_json(), made.arm, made.recordings


@dataclass(frozen=True)
class Case:
    """One machine to be diagnosed.

    Attributes:
        key: its place.
        model: as given.
        machine: with its true constants.
        hidden: effects that the model lacks.
        runs: its experiments.
        recordings: made on the rig.
    """

    key: Key
    model: Model
    machine: Model
    hidden: tuple[Sized, ...]
    runs: tuple[Run, ...]
    recordings: list[Recording]

    @property
    def arm(self) -> Arm:
        """The arm as given."""
        return self.model.arm

    @property
    def effects(self) -> tuple[str, ...]:
        """Names of the hidden effects."""
        return tuple(sized.name for sized in self.hidden)

    @property
    def truth(self) -> dict[str, float]:
        """True constants, by their names in a diagnosis, and true parameters of hidden effects, as "payload.mass"."""
        found = {short_name(path): self.machine.values[path] for path in spreads(self.model)}
        for sized in self.hidden:
            found |= {f"{sized.name}.{key}": value for key, value in sized.truth(self.machine).items()}
        return found

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data, without model and recordings."""
        sizes = {"sizes": [s.size for s in self.hidden], "strengths": [s.strength for s in self.hidden]}
        alike = twins(self.machine, self.runs, self.hidden)
        kinds = {"family": self.model.family, "effects": list(self.effects), "twins": alike}
        return self.key.as_json() | kinds | sizes | {"runs": [run.name for run in self.runs], "truth": self.truth}


def keys(seed: int, number: int, kind: str | None = None) -> list[Key]:
    """List the first cases of a seed, of one kind if it is given."""
    found: Iterator[Key] = (Key(seed, index) for index in count())
    return [key for key, _ in zip((key for key in found if kind in (None, key.kind)), range(number), strict=False)]


def case(seed: int, index: int) -> Case:
    """Make a case. The same arguments give the same bits.

    Args:
        seed: of the benchmark.
        index: from 0.
    """
    key, draw = Key(seed, index), np.random.default_rng([seed, index])
    while True:
        family = str(draw.choice(list(FAMILIES)))
        model = FAMILIES[family](draw)
        machine = model if key.kind == "null" and draw.random() < EXACT else drawn(draw, model)
        planned = runs(draw, model)
        hidden = effects(draw, machine, planned, key.kind)
        if hidden is not None:
            settings = [sized.settings(machine) for sized in hidden]
            return Case(key, model, machine, hidden, planned, [record(machine, run, settings) for run in planned])
