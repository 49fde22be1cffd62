"""Commands that are refused or fail: one line each, and the exit code that says which."""

from __future__ import annotations

import numpy as np
import pytest
from cli_stand_ins import OWN

import flexarm_env
from flexarm_env.errors import InputError


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["compar"], "did you mean 'compare'"),
        (["--arms"], "--arms"),
        (["compare"], "RECORDING"),
        (["compare", "x.csv", "--arms", "thesis"], "did you mean '--arm'"),
        (["compare", "x.csv", "--arm"], "--arm"),
        (["diagnose", "x.csv", "--seed", "one"], "--seed"),
        (["diagnose", "x.csv", "--seed", "-1"], "--seed"),
        (["diagnose", "x.csv", "--jobs", "0"], "--jobs"),
        (["add"], "EFFECT"),
        (["add", "backlash"], "RECORDING"),
        (["simulate"], "--save"),
        (["simulate", "--save", "x.csv", "--rate", "fast"], "--rate"),
        (["effects", "backlas"], "did you mean 'backlash'"),
        (["effects", "a", "b"], "b"),
        (["effects", "no.py:Name"], "no.py"),
    ],
)
def test_a_mistyped_command_gets_one_line(flexarm, tmp_path, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    assert words in flexarm.refused(*arguments)


@pytest.mark.parametrize("option", ["--json", "--save", "--report"])
def test_places_that_cannot_be_written_are_refused_before_the_work(flexarm, identify, runs, tmp_path, option):
    (tmp_path / "file").write_text("")
    for place in (tmp_path, tmp_path / "no" / "x", tmp_path / "file" / "x"):
        assert "cannot write" in flexarm.refused("diagnose", runs, option, place)
    assert identify.log == []


def test_an_effect_that_cannot_be_added_is_refused(flexarm, identify, runs, tmp_path):
    file = tmp_path / "mine.py"
    assert "did you mean 'backlash'" in flexarm.refused("add", "backlas", runs)
    assert "exists" in flexarm.refused("add", f"{file}:Mine", runs)
    file.write_text(OWN)
    assert "did you mean 'Mine'" in flexarm.refused("add", f"{file}:Mien", runs)
    file.write_text("import nothing_of_the_sort")
    assert "ModuleNotFoundError" in flexarm.refused("add", f"{file}:Mine", runs)
    file.write_text("def :")
    assert "SyntaxError" in flexarm.refused("diagnose", runs, "--effects", f"{file}:Mine")
    file.write_text(OWN.replace("equation", "formula"))
    assert "equation" in flexarm.refused("diagnose", runs, "--effects", f"{file}:Mine")


@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (InputError("the recordings\nare too short"), 2, "the recordings are too short"),
        (KeyboardInterrupt(), 130, "stopped"),
        (OSError(28, "No space left on device", "x.csv"), 2, "No space left"),
        (np.linalg.LinAlgError("Singular matrix"), 2, "fault of the program"),
    ],
)
def test_whatever_goes_wrong_is_one_line(flexarm, identify, runs, monkeypatch, error, code, words):
    def fail(*args, **kwargs):
        raise error

    monkeypatch.setitem(vars(flexarm_env), "compare", fail)
    assert flexarm("compare", runs) == code
    assert len(flexarm.err.splitlines()) == 1
    assert words in flexarm.err
