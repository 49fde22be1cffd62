"""The command `thesis`: what it writes, and what it refuses."""

from __future__ import annotations

import importlib.util
import json
import re

import pytest
from cli_stand_ins import needs_plots

FIGURES = [f"2-{k}" for k in range(6, 10)] + [f"3-{k}" for k in range(5, 11)] + [f"4-{k}" for k in range(2, 20)]


@pytest.mark.slow
@needs_plots
def test_it_writes_a_page_with_every_figure_and_row(flexarm, tmp_path):
    folders = tmp_path / "one", tmp_path / "two"
    for folder in folders:
        assert flexarm("thesis", "--output", folder, "--json", tmp_path / f"{folder.name}.json") == 0
        assert "Of 19 claims" in flexarm.out
    page = (folders[0] / "index.html").read_text(encoding="utf-8")
    made = {path.name for path in folders[0].iterdir()}
    assert {f"figure-{n}.{ending}" for n in FIGURES for ending in ("svg", "png")} <= made
    named = set(re.findall(r'(?:src|href)="(figure-[\w-]+\.(?:svg|png))"', page))
    assert named == {name for name in made if name.startswith("figure-")}
    assert all(f'id="T{k}"' in page for k in range(1, 20))
    assert "<script" not in page
    assert not re.search(r"https?://", page)
    numbers = [json.loads((tmp_path / f"{folder.name}.json").read_text()) for folder in folders]
    assert numbers[0] == json.loads((folders[0] / "thesis.json").read_text())
    assert all(row["verdict"] for row in numbers[0]["claims"])
    # the same again, bit for bit, but for the times that T19 measures
    for name in made - {"index.html", "thesis.json"}:
        assert (folders[0] / name).read_bytes() == (folders[1] / name).read_bytes(), name
    assert numbers[0]["claims"][:18] == numbers[1]["claims"][:18]
    assert numbers[0]["errata"] == numbers[1]["errata"]


@needs_plots
def test_a_file_in_the_folder_s_place_is_refused(flexarm, tmp_path):
    (tmp_path / "file").write_text("")
    said = flexarm.refused("thesis", "--output", tmp_path / "file")
    assert said == f"flexarm: cannot make folder {tmp_path / 'file'}: File exists; name another\n"


def test_without_the_library_for_pictures_it_says_what_to_install(flexarm, tmp_path, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    assert "flexarm-env[plots]" in flexarm.refused("thesis", "--output", tmp_path / "out")
    assert not (tmp_path / "out").exists()
