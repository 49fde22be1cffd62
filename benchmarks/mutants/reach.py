"""Which tests execute which line: a mutant is put to those that reach it, the shortest first."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
PACKAGE = "flexarm_env"


@dataclass(frozen=True)
class Reach:
    """The tests that execute each line of each file, and what each test takes in s."""

    seconds: dict[str, float]
    lines: dict[str, dict[int, list[str]]]

    def tests(self, name: str, line: int, budget: float) -> list[str]:
        """Choose tests for a line of a file, until they take a budget of seconds.

        A line that no test executes in Python is compiled. There the tests of its part serve, those that name its file or a
        folder of it first.
        """
        reaching: Sequence[str] = self.lines.get(name, {}).get(_statement(PROJECT / name, line), [])
        if not reaching:
            part = name.split("/")[1]
            reaching = [test for test in self.seconds if test.startswith(f"tests/{part}/")]
        own, chosen, taken = Path(name).with_suffix("").parts[2:], [], 0.0
        for test in sorted(reaching, key=lambda test: (not any(word in test for word in own), self.seconds[test], test)):
            if chosen and taken + self.seconds[test] > budget:
                continue
            chosen.append(test)
            taken += self.seconds[test]
        return chosen


def _statement(file: Path, line: int) -> int:
    """Locate the first line of the innermost statement around a line, under which coverage counts it."""
    nodes = ast.walk(ast.parse(file.read_text(encoding="utf-8")))
    around = [node for node in nodes if isinstance(node, ast.stmt) and node.lineno <= line <= int(node.end_lineno or line)]
    return max((node.lineno for node in around), default=line)
