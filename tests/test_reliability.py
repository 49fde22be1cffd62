"""The table of faults in docs/reliability.md agrees with the tests and the messages of the program."""

from __future__ import annotations

import ast
import functools
import re

import pytest
from documents import PROJECT

TABLE = PROJECT / "docs" / "reliability.md"
ROW = re.compile(r"^\| (.+) \| (.+) \| `(tests/[\w/]+\.py)::(\w+)(?:\[(.+)\])?` \|$", re.MULTILINE)
ROWS = [match.groups() for match in ROW.finditer(TABLE.read_text(encoding="utf-8"))]
FEWEST = 40


@functools.cache
def functions(file: str) -> dict[str, str]:
    """The source of every test of a file, by name."""
    text = (PROJECT / file).read_text(encoding="utf-8")
    return {
        node.name: ast.get_source_segment(text, node) or ""
        for node in ast.parse(text).body
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")
    }


@functools.cache
def program() -> str:
    """The texts of the program, joined where a message is written over several lines."""
    files = [file for top in ("flexarm_env", "agents") for file in sorted((PROJECT / top).rglob("*.py"))]
    text = "\n".join(file.read_text(encoding="utf-8") for file in files)
    return re.sub(r"\"\s*\n\s*f?\"", "", text)


def test_every_row_of_the_table_is_read():
    lines = [line for line in TABLE.read_text(encoding="utf-8").splitlines() if line.startswith("| ")]
    heads = [line for line in lines if line.endswith("| proved by |")]
    assert len(lines) - len(heads) == len(ROWS) >= FEWEST
    assert len({row[2:] for row in ROWS}) == len(ROWS)
    assert len({event for event, *_ in ROWS}) == len(ROWS)


@pytest.mark.parametrize(("event", "answer", "file", "test", "case"), ROWS, ids=[row[0][:50] for row in ROWS])
def test_a_row_names_a_test_and_a_message_that_exist(event, answer, file, test, case):
    assert test in functions(file), f"{file} has no test {test}"
    if case:
        assert f'"{case}": (' in (PROJECT / file).read_text(encoding="utf-8"), f"{file} has no case {case!r}"
    for message in re.findall(r"`([^`]+)`", answer):
        assert message in program(), f"the program says nowhere {message!r}"
