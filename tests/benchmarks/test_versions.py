"""The run on the oldest and newest versions: its requirements, its Pythons, its counts and its table."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.versions import interpreters, table
from benchmarks.versions.requirements import PROJECT, direct_requirements, oldest_python
from benchmarks.versions.suite import TOP, Counts, folders_of_tests, read_counts
from flexarm_env.errors import InputError

SOME = """
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
    folder = tmp_path / "tests" / "some"
    folder.mkdir(parents=True)
    (folder / "test_some.py").write_text(SOME.replace("{folder}", str(PROJECT.parent / "shared")))
    (folder / "test_whole.py").write_text(WHOLE)
    (tmp_path / "tests" / "test_top.py").write_text("class TestOne:\n    def test_passes(self):\n        pass\n")
    (tmp_path / "pytest.ini").write_text("[pytest]\naddopts = --import-mode=importlib\n")
    command = [sys.executable, "-m", "pytest", "-n", workers, "--junit-xml=report.xml", "-p", "no:cacheprovider", "tests"]
    assert subprocess.run(command, cwd=tmp_path, capture_output=True, check=False).returncode == 1
    counts = read_counts(tmp_path / "report.xml")
    assert set(counts) == {"some", TOP}
    assert counts[TOP] == Counts(1, (), {})
    assert counts["some"].passed == 1
    assert set(counts["some"].failed) == {"tests.some.test_some.test_fails", "tests.some.test_some.test_error"}
    missing = "could not import 'no_such_library': No module named 'no_such_library'"
    assert counts["some"].skipped == {missing: 1, "no folder ../shared": 1}


def test_folders_without_tests_are_left_out():
    found = folders_of_tests()
    assert {TOP, "cli", "plant"} <= set(found)
    assert not {"rig", "reference", "inspect"} & set(found)  # the first two have no tests, the last is within identify


def run(python: str, *failed: str, folders: tuple[str, ...] = (), left_out: tuple[str, ...] = ()) -> dict:
    versions = dict.fromkeys([*table.SHOWN, "rich"], "1.2")
    counts = {"commit": "abc", "other_versions": {}, "passed": 7, "failed": failed, "skipped": {"a": 2, "b": 3}}
    return {
        "python": python,
        "requirements": versions,
        "left_out": list(left_out),
        "folders": dict.fromkeys(folders or folders_of_tests(), counts),
    }


def test_the_table_has_both_runs_and_what_was_left_out():
    count = len(folders_of_tests())
    text = table.markdown({"oldest": run("3.11.0"), "newest": run("3.14.1", "one", left_out=("train",))})
    assert f"| oldest | 3.11.0 | 1.2 | 1.2 | 1.2 | 1.2 | {7 * count} | 0 | {5 * count} |" in text
    assert f"| newest | 3.14.1 | 1.2 | 1.2 | 1.2 | 1.2 | {7 * count} | {count} | {5 * count} |" in text
    assert "`train` with the newest" in text
    assert "were run" not in text


def test_the_table_says_what_was_not_run():
    most = tuple(name for name in folders_of_tests() if name not in ("cli", "plant"))
    text = table.markdown({"oldest": run("3.11.0", folders=most)})
    assert "With the oldest versions no tests of `cli`, `plant` were run." in text
    assert "left out" not in text


@pytest.fixture
def record(tmp_path, monkeypatch):
    monkeypatch.setattr(table, "RECORD", tmp_path / "versions" / "versions.json")


@pytest.mark.usefixtures("record")
def test_a_run_of_one_side_keeps_the_other():
    table.keep({"newest": run("3.13.0")})
    runs = table.keep({"oldest": run("3.11.0", "one")})
    assert list(runs) == ["oldest", "newest"]
    assert runs["newest"]["python"] == "3.13.0"


@pytest.mark.usefixtures("record")
def test_a_run_of_some_folders_keeps_the_others_of_the_same_python():
    table.keep({"oldest": run("3.11.0", "one", folders=("cli", "plant"))})
    runs = table.keep({"oldest": run("3.11.0", folders=("plant",))})
    assert {name: len(each["failed"]) for name, each in runs["oldest"]["folders"].items()} == {"cli": 1, "plant": 0}
    runs = table.keep({"oldest": run("3.11.1", folders=("plant",))})
    assert list(runs["oldest"]["folders"]) == ["plant"]


@pytest.mark.usefixtures("record")
def test_a_folder_that_was_run_with_other_versions_says_so():
    table.keep({"oldest": run("3.11.0", folders=("cli", "plant"))})
    changed = run("3.11.0", folders=("plant",))
    changed["requirements"]["rich"] = "1.3"
    runs = table.keep({"oldest": changed})
    assert {name: each["other_versions"] for name, each in runs["oldest"]["folders"].items()} == {
        "cli": {"rich": "1.2"},
        "plant": {},
    }
    assert "With the oldest versions the tests of `cli` were run with rich 1.2." in table.markdown(runs)
    runs = table.keep({"oldest": run("3.11.0", folders=("env",))})
    assert runs["oldest"]["folders"]["cli"]["other_versions"] == {}
    assert runs["oldest"]["folders"]["plant"]["other_versions"] == {"rich": "1.3"}
