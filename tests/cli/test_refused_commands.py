"""Commands that are refused or fail: one line each, and the exit code that says which."""

from __future__ import annotations

import os

import numpy as np
import pytest
from cli_stand_ins import GOOD_ARM, MAP

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


@pytest.mark.parametrize(
    ("arguments", "allowed"),
    [
        (["compare", "x.csv", "--rate", "abc"], "valid"),
        (["simulate", "--save", "x.csv", "--duration", "long"], "valid"),
        (["diagnose", "x.csv", "--jobs", "0"], "1"),
        (["diagnose", "x.csv", "--jobs", "257"], "256"),
        (["diagnose", "x.csv", "--jobs", "1.5"], "valid"),
        (["fit", "x.csv", "--seed", "-1"], "0"),
    ],
)
def test_a_number_that_is_refused_is_named_beside_what_is_allowed(flexarm, arguments, allowed):
    option, came = arguments[-2:]
    _, _, words = flexarm.refused(*arguments).partition(f"invalid value for '{option}': ")
    assert words.lstrip("'").startswith(came)
    assert allowed in words.partition(came)[2].partition("(see")[0]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_pipes_are_refused_and_not_waited_for(flexarm, runs, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "arm.toml").write_text(GOOD_ARM + MAP)
    for words in (
        ["compare", tmp_path / "pipe", "--arm", tmp_path / "arm.toml"],
        ["compare", runs, "--columns", tmp_path / "pipe"],
        ["effects", "coulomb", "--json", tmp_path / "pipe"],
    ):
        assert "regular file" in flexarm.refused(*words)
    assert "neither a file" in flexarm.refused("compare", runs, "--arm", tmp_path / "pipe")


@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (InputError("the recordings\nare too short"), 2, r"the recordings\nare too short"),
        (KeyboardInterrupt(), 130, "stopped"),
        (OSError(28, "No space left on device", "x.csv"), 2, "No space left"),
        (np.linalg.LinAlgError("Singular matrix"), 2, "fault of the program"),
        (BaseException("odd"), 2, "fault of the program"),
    ],
)
def test_whatever_goes_wrong_is_one_line(flexarm, identify, runs, monkeypatch, error, code, words):
    def fail(*args, **kwargs):
        raise error

    monkeypatch.setitem(vars(flexarm_env), "compare", fail)
    assert flexarm("compare", runs) == code
    assert len(flexarm.err.splitlines()) == 1
    assert words in flexarm.err
