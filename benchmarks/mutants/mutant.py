"""Mutants: the same file with one small fault in it, and a seeded sample of them.

The faults are those of cosmic-ray: another operator, another comparison, a number one larger or smaller, a condition negated,
a loop that never runs. Faults that cannot change what the program does are left out: those in annotations and in imports for
the types alone, and the removal of a decorator of the compiler.
"""

from __future__ import annotations

import ast
import random
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code
from cosmic_ray.plugins import get_operator, operator_names

from benchmarks.mutants.reach import PACKAGE, PROJECT
from benchmarks.mutants.spared import without_effect

PARTS = ("plant", "effects", "recordings", "identify")


@dataclass(frozen=True)
class Mutant:
    """One fault in one file: the `occurrence`-th place (from 0) where an operator of cosmic-ray applies."""

    name: str
    file: str
    line: int
    operator: str
    occurrence: int

    def source(self, root: Path = PROJECT) -> str:
        """Make the text of the file with the fault."""
        text: str = mutate_code((root / self.file).read_text(encoding="utf-8"), get_operator(self.operator)(), self.occurrence)
        return text

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data."""
        return asdict(self)


def sample(seed: int, part: str, count: int) -> list[Mutant]:
    """Draw places in a part's files, each as likely as any other, and at each place one of the faults possible there."""
    draw = random.Random(f"{seed} {part}")
    places: dict[tuple[str, tuple[int, int], tuple[int, int]], list[tuple[str, int]]] = {}
    for file in sorted((PROJECT / PACKAGE / part).rglob("*.py")):
        for name, occurrence, start, end in _faults(file):
            places.setdefault((str(file.relative_to(PROJECT)), start, end), []).append((name, occurrence))
    drawn = draw.sample(sorted(places), min(count, len(places)))
    return [
        Mutant(f"{part}-{number:03}", place[0], place[1][0], *draw.choice(places[place])) for number, place in enumerate(drawn)
    ]


def _faults(file: Path) -> Iterator[tuple[str, int, tuple[int, int], tuple[int, int]]]:
    text = file.read_text(encoding="utf-8")
    parsed, spared = get_ast(text), without_effect(ast.parse(text))
    for name in operator_names():
        operator_class = get_operator(name)
        if operator_class.arguments():
            continue
        operator = operator_class()
        places = (place for node in ast_nodes(parsed) for place in operator.mutation_positions(node))
        for occurrence, (start, end) in enumerate(places):
            if not any(first <= start and end <= last for first, last in spared):
                yield name, occurrence, start, end
