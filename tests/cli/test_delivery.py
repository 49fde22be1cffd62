"""Files come before what is printed, so that output which cannot be printed loses none."""

from __future__ import annotations

import errno
import io
import json
import os
import sys

import pytest
from cli_stand_ins import needs_plots

from flexarm_env.errors import InputError
from flexarm_env.files import write_whole
from flexarm_env.terminal.delivery import deliver


class FullDisk(io.StringIO):
    """Output on a disk without room."""

    def write(self, text):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


@pytest.mark.parametrize(
    ("command", "files"),
    [
        pytest.param(["inspect"], ["report.html"], marks=needs_plots),
        pytest.param(["compare"], ["report.html"], marks=needs_plots),
        pytest.param(["diagnose"], ["save.toml", "report.html"], marks=needs_plots),
        (["add", "backlash"], ["save.toml"]),
        (["fit"], ["save.toml"]),
        (["simulate"], ["save.csv"]),
        (["effects"], []),
        (["envs"], []),
        (["diagnose", "--settings"], []),
    ],
    ids=lambda words: " ".join(words),
)
def test_a_full_stdout_loses_no_file(flexarm, identify, runs, tmp_path, monkeypatch, command, files):
    read = [runs] if command[0] in ("inspect", "compare", "diagnose", "add", "fit") else []
    named = {f"--{name.partition('.')[0]}": tmp_path / name for name in ("json.json", *files)}
    monkeypatch.setattr(sys, "stdout", FullDisk())
    assert flexarm(*command, *read, *(word for pair in named.items() for word in pair)) == 2
    assert os.strerror(errno.ENOSPC) in flexarm.err
    assert sorted(tmp_path.iterdir()) == sorted(named.values())
    assert json.loads(named["--json"].read_text())


def test_a_file_that_cannot_be_written_keeps_nothing_else_back(tmp_path, capsys):
    lost, kept = tmp_path / "no" / "arm.toml", tmp_path / "page.html"
    files = [(place, lambda path: write_whole(path, "text")) for place in (lost, None, kept)]
    with pytest.raises(InputError) as caught:
        deliver(tmp_path / "none" / "it.json", {}, ["a table"], files)
    for place in (tmp_path / "none" / "it.json", lost):
        assert f"cannot write {place}: " in str(caught.value)
    assert kept.read_text() == "text"
    assert capsys.readouterr().out.startswith("a table")


def test_a_fault_in_drawing_a_page_keeps_no_table_back(tmp_path, capsys):
    def fail(path):
        raise ArithmeticError

    with pytest.raises(ArithmeticError):
        deliver(tmp_path / "it.json", {}, ["a table"], [(tmp_path / "page.html", fail)])
    assert (tmp_path / "it.json").exists()
    assert capsys.readouterr().out.startswith("a table")
