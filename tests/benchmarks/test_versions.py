"""The run on the oldest and newest versions: its requirements, its Pythons, its counts and its table."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.versions import interpreters, table
from benchmarks.versions.requirements import PROJECT, direct_requirements, oldest_python
from benchmarks.versions.suite import read_counts
from flexarm_env.errors import InputError

TESTS = """
import pytest

def test_passes():
    pass

def test_fails():
    assert 1 == 2

@pytest.mark.skipif(True, reason="no folder {folder}")
def test_skipped():
    pass

@pytest.fixture
def broken():
    raise ValueError("setup")

def test_error(broken):
    pass
"""
WHOLE = 'import pytest\npytest.importorskip("no_such_library")\n\ndef test_one(): pass\n\ndef test_two(): pass\n'


def test_every_requirement_has_a_lower_bound():
    found = direct_requirements()
    assert {"numpy", "scipy", "torch", "pytest"} <= {each.name for each in found}
    assert len({str(each) for each in found}) == len(found)
    for each in found:
        assert any(part.operator in (">=", "==") for part in each.specifier), f"{each} has no lowest version"


def test_an_extra_left_out_takes_its_requirements_along():
    kept = {each.name for each in direct_requirements(["train"])}
    assert "torch" not in kept
    assert "optuna" in kept  # the extra control needs it as well


def test_an_unknown_extra_is_refused():
    with pytest.raises(InputError, match=r"no extra 'trane'; pyproject.toml has render"):
        direct_requirements(["trane"])


def program(folder: Path, name: str, code: int) -> None:
    file = folder / name
    file.write_text(f"#!/bin/sh\nexit {code}\n")
    file.chmod(0o755)


def test_the_newest_python_that_starts_is_taken(tmp_path, monkeypatch):
    least = oldest_python().minor
    program(tmp_path, f"python3.{least - 1}", 0)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(InputError, match="make versions NEWEST="):
        interpreters.newest_on_path()
    with pytest.raises(InputError, match="make versions OLDEST="):
        interpreters.oldest_on_path()
    program(tmp_path, f"python3.{least}", 0)
    program(tmp_path, f"python3.{least + 8}", 0)
    program(tmp_path, f"python3.{least + 9}", 127)  # as the names of a version manager that start nothing
    program(tmp_path, f"python3.{least + 10}-config", 0)
    assert interpreters.newest_on_path() == f"python3.{least + 8}"
    assert interpreters.oldest_on_path() == f"python3.{least}"


@pytest.mark.parametrize("workers", ["0", "1"])
def test_counts_are_those_of_the_tests(tmp_path, workers):
    (tmp_path / "test_some.py").write_text(TESTS.replace("{folder}", str(PROJECT.parent / "shared")))
    (tmp_path / "test_whole.py").write_text(WHOLE)
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    command = [sys.executable, "-m", "pytest", "-n", workers, "--junit-xml=report.xml", "-p", "no:cacheprovider"]
    assert subprocess.run(command, cwd=tmp_path, capture_output=True, check=False).returncode == 1
    counts = read_counts(tmp_path / "report.xml")
    assert counts.passed == 1
    assert {name.rpartition("::")[2] for name in counts.failed} == {"test_fails", "test_error"}
    missing = "could not import 'no_such_library': No module named 'no_such_library'"
    assert counts.skipped == {missing: 1, "no folder ../shared": 1}


def run(python: str, failed: tuple[str, ...], left_out: list[str]) -> dict:
    versions = dict.fromkeys([*table.SHOWN, "rich"], "1.2")
    return {"python": python, "requirements": versions, "passed": 7, "failed": failed, "skipped": {"a": 2, "b": 3}} | {
        "left_out": left_out
    }


def test_the_table_has_both_runs_and_what_was_left_out():
    text = table.markdown({"oldest": run("3.11.0", (), []), "newest": run("3.14.1", ("one",), ["train"])})
    assert "| oldest | 3.11.0 | 1.2 | 1.2 | 1.2 | 1.2 | 7 | 0 | 5 |" in text
    assert "| newest | 3.14.1 | 1.2 | 1.2 | 1.2 | 1.2 | 7 | 1 | 5 |" in text
    assert "`train` with the newest" in text
    assert "left out" not in table.markdown({"oldest": run("3.11.0", (), [])})


def test_a_run_of_one_side_keeps_the_other(tmp_path, monkeypatch):
    monkeypatch.setattr(table, "RECORD", tmp_path / "versions" / "versions.json")
    table.keep("newest", {"python": "3.13.0"})
    table.keep("oldest", {"python": "3.11.0"})
    runs = table.keep("newest", {"python": "3.14.0"})
    assert list(runs.items()) == [("oldest", {"python": "3.11.0"}), ("newest", {"python": "3.14.0"})]
