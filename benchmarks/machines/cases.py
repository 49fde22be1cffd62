"""The cases: an arm as given, recordings of a machine, and the difference; each determined by its seed and index."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from itertools import count
from typing import Any

import numpy as np

from benchmarks.machines.catalogue import CATALOGUE, OUTSIDE, PLANT, SENSORS
from benchmarks.machines.effects import Hidden, Sized, draw_details
from benchmarks.machines.experiments import Run, runs
from benchmarks.machines.families import FAMILIES
from benchmarks.machines.machine import record
from benchmarks.machines.model import Model, Rng, log_uniform
from benchmarks.machines.spread import drawn, spreads
from benchmarks.machines.strength import Yardstick, find_size
from flexarm_env import Arm, Recording
from flexarm_env.arm import short_name

#: Kinds of cases, in turn; effects of each.
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
COUNTS = {"one": 1, "two": 2, "three": 3, "sensor": 1, "outside": 1, "null": 0}
#: Excess error over the noise that each effect alone would leave, and the least that it must add beside the others.
STRENGTHS, LEAST = (3.0, 60.0), 1.5
#: Share of the nulls in which the constants are right, too.
EXACT = 0.3
#: Draws of effects for one machine before another is drawn.
TRIES = 8


@dataclass(frozen=True)
class Key:
    """The place of a case.

    Attributes:
        seed: of the benchmark.
        index: from 0.
    """

    seed: int
    index: int

    @property
    def kind(self) -> str:
        """One of COUNTS."""
        return KINDS[self.index % len(KINDS)]

    @property
    def name(self) -> str:
        """Name of the case's file."""
        return f"{self.index:04d}-{self.kind}"

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data."""
        return asdict(self) | {"name": self.name, "kind": self.kind}

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
        kinds = {"family": self.model.family, "effects": list(self.effects)}
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


def effects(draw: Rng, machine: Model, planned: tuple[Run, ...], kind: str) -> tuple[Sized, ...] | None:
    """Draw the effects that the model of a machine lacks; None where it has none of that kind that shows."""
    if not COUNTS[kind]:
        return ()
    names = possible(machine, kind)
    yard = Yardstick(machine, planned)
    for _ in range(TRIES):
        chosen = [str(name) for name in draw.permutation(names)[: COUNTS[kind]]]
        if len(chosen) < COUNTS[kind] or not fit_together(chosen):
            continue
        sized = [_sized(draw, yard, name) for name in chosen]
        found = tuple(one for one in sized if one is not None)
        if len(found) == len(sized) and _differ(yard, found):
            return found
    return None


def possible(machine: Model, kind: str) -> list[str]:
    """List the effects of a kind that a machine can have and its model lacks."""
    arm = machine.arm
    pools: Mapping[str, Mapping[str, Hidden]] = {"outside": OUTSIDE, "sensor": SENSORS, "one": PLANT}
    found = []
    for name, hidden in pools.get(kind, CATALOGUE).items():
        effect = name.partition(".")[0]
        if effect in arm.known:
            modified = arm.known[effect].modifies
            if effect in arm.effects or not arm.can_have(effect) or (modified and modified not in arm.effects):
                continue
        if hidden.possible(machine):
            found.append(name)
    return found


def fit_together(names: list[str]) -> bool:
    """Whether effects lie in different parts of a machine, and the rig can combine them."""
    parts = [(CATALOGUE | OUTSIDE)[name].part for name in names]
    named = [part for part in parts if part]
    # the rig separates the motor's share of the friction of the model only
    splits = "gears" in named and bool({"viscous", "coulomb", "stiction", "cogging"} & set(names))
    return len(set(named)) == len(named) and not splits


def _sized(draw: Rng, yard: Yardstick, name: str) -> Sized | None:
    """Draw an effect's details and strength, and find its size."""
    hidden = (CATALOGUE | OUTSIDE)[name]
    sign = float(draw.choice([-1.0, 1.0])) if hidden.signed else 1.0
    largest = Sized(name.partition(".")[0], hidden, sign * hidden.largest(yard.machine), draw_details(draw, hidden, yard.machine))
    return find_size(yard, largest, log_uniform(draw, *STRENGTHS))


def _differ(yard: Yardstick, found: tuple[Sized, ...]) -> bool:
    """Whether each of several effects shows beside the others."""
    signatures = [yard.signature(sized) for sized in found] if len(found) > 1 else []
    return all(yard.left(own, signatures[:i] + signatures[i + 1 :]) >= LEAST for i, own in enumerate(signatures))
