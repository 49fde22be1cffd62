"""Small faults that are put into the program: where they make no difference, and which tests they are put to."""

from __future__ import annotations

import ast

import pytest

from benchmarks.mutants.reach import PROJECT, Reach
from benchmarks.mutants.spared import without_effect

TEXT = """
from typing import TYPE_CHECKING
if TYPE_CHECKING:
    LIMIT = 3
@njit(fastmath=True)
def double(x: int = 1 + 1) -> 2 | None:
    y: int | 3 = x * 2
    return y
"""


def is_spared(piece: str, line: int) -> bool:
    column = TEXT.splitlines()[line - 1].index(piece)
    start, end = (line, column), (line, column + len(piece))
    return any(first <= start and end <= last for first, last in without_effect(ast.parse(TEXT)))


@pytest.mark.parametrize(("piece", "line"), [("3", 4), ("@njit(fastmath=True)", 5), ("2 |", 6), ("3", 7)])
def test_faults_that_change_nothing_are_spared(piece, line):
    assert is_spared(piece, line)


@pytest.mark.parametrize(("piece", "line"), [("1 + 1", 6), ("x * 2", 7), ("y", 8)])
def test_faults_in_what_is_executed_are_not(piece, line):
    assert not is_spared(piece, line)


FILE = "flexarm_env/effects/backlash.py"


def line_of(text: str) -> int:
    return next(number for number, line in enumerate((PROJECT / FILE).read_text().splitlines(), start=1) if text in line)


def test_a_mutant_is_put_to_the_tests_that_execute_its_statement_the_shortest_first():
    line = line_of("return [{")
    reach = Reach({"a": 5.0, "b": 1.0, "c": 1.5, "d": 0.1}, {FILE: {line: ["a", "b", "c"]}})
    assert reach.tests(FILE, line, budget=10.0) == ["b", "c", "a"]
    assert reach.tests(FILE, line, budget=3.0) == ["b", "c"]
    assert reach.tests(FILE, line, budget=0.5) == ["b"]


def test_a_line_that_is_compiled_is_put_to_the_tests_of_its_part_those_of_its_file_first():
    seconds = {
        "tests/effects/test_x.py::test[backlash]": 3.0,
        "tests/effects/test_x.py::test[drag]": 1.0,
        "tests/env/test_y.py::t": 0.1,
    }
    reach = Reach(seconds, {})
    assert reach.tests(FILE, line_of("gear_gap"), budget=60.0) == list(seconds)[:2]


def test_tests_that_name_the_folder_of_a_compiled_line_come_first():
    seconds = {"tests/plant/test_plant.py::quick": 0.1, "tests/plant/test_tangents.py::thorough": 9.0}
    file = "flexarm_env/plant/tangents/events.py"
    assert Reach(seconds, {}).tests(file, 60, budget=60.0) == list(seconds)[::-1]
