"""Reports, pictures and the demo."""

from __future__ import annotations

import importlib.util

from cli_stand_ins import needs_plots


@needs_plots
def test_reports_are_whole_pages_without_a_network(flexarm, identify, runs, tmp_path):
    for command in ("compare", "diagnose"):
        page = tmp_path / f"{command}.html"
        assert flexarm(command, runs, "--report", page) == 0
        text = page.read_text()
        assert text.rstrip().endswith("</html>")
        assert text.count("<script src=") == 0
        assert "Recording square" in text
        assert text.count('<div class="plot"') >= 2


def test_a_missing_library_for_pictures_is_one_line(flexarm, identify, runs, tmp_path, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    assert "flexarm-env[plots]" in flexarm.refused("compare", runs, "--report", tmp_path / "r.html")
    assert "flexarm-env[plots]" in flexarm.refused("demo", "--output", tmp_path)


def test_a_missing_library_of_the_lab_is_one_line(flexarm, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    assert "pip install 'flexarm-env[lab]'" in flexarm.refused("lab")


@needs_plots
def test_the_demo_draws_its_pictures(flexarm, identify, tmp_path):
    assert flexarm("demo", "--output", tmp_path / "demo") == 0
    made = {p.name for p in (tmp_path / "demo").iterdir()}
    assert {"loop.png", "loop.svg", "overlay.png", "waterfall.svg", "report.html", "demo.json"} <= made
    assert "0.06 rad" in flexarm.out
    (tmp_path / "file").write_text("")
    flexarm.refused("demo", "--output", tmp_path / "file")
