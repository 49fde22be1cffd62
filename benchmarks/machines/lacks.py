"""The effects that the model of a machine lacks: drawn at random, each of a strength, and each beside the others."""

from __future__ import annotations

from collections.abc import Mapping

from benchmarks.machines.catalogue import CATALOGUE, PLANT, SENSORS
from benchmarks.machines.effects import Hidden, Sized, draw_details
from benchmarks.machines.experiments import Run
from benchmarks.machines.model import Model, Rng, log_uniform
from benchmarks.machines.outside import OUTSIDE
from benchmarks.machines.strength import Yardstick, find_size

#: Effects of each kind of case.
COUNTS = {"one": 1, "two": 2, "three": 3, "sensor": 1, "outside": 1, "null": 0}
#: Excess error over the noise that each effect alone would leave, and the least that it must add beside the others.
STRENGTHS, LEAST = (3.0, 60.0), 1.5
#: Draws of effects for one machine before another is drawn.
TRIES = 8
#: Share of the models without friction and with several effects missing that lack dry friction.
DRY = 0.5


def effects(draw: Rng, machine: Model, planned: tuple[Run, ...], kind: str) -> tuple[Sized, ...] | None:
    """Draw the effects that the model of a machine lacks; None where it has none of that kind that shows."""
    if not COUNTS[kind]:
        return ()
    names = possible(machine, kind)
    yard = Yardstick(machine, planned)
    for _ in range(TRIES):
        chosen = _chosen(draw, names, COUNTS[kind])
        if len(chosen) < COUNTS[kind] or not fit_together(chosen):
            continue
        sized = [_sized(draw, yard, name) for name in chosen]
        found = tuple(one for one in sized if one is not None)
        if len(found) == len(sized) and _differ(Yardstick(machine, planned, found), found):
            return found
    return None


def _chosen(draw: Rng, names: list[str], count: int) -> list[str]:
    """Choose effects; of several that a model without friction lacks, one is often the friction."""
    mixed = [str(name) for name in draw.permutation(names)]
    if count > 1 and "coulomb" in mixed and draw.random() < DRY:
        mixed = ["coulomb", *(name for name in mixed if name != "coulomb")]
    return mixed[:count]


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
    """Whether each of several effects shows beside the others, under the commands of the machine that has all."""
    signatures = [yard.signature(sized) for sized in found] if len(found) > 1 else []
    return all(yard.left(own, signatures[:i] + signatures[i + 1 :]) >= LEAST for i, own in enumerate(signatures))
