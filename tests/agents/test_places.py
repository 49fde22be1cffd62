"""Where the results of the agents' commands go is looked at before the work."""

from __future__ import annotations

import importlib
from pathlib import Path

import pytest

COMMANDS = {
    "compare": [],
    "evaluate": [],
    "recipe": [],
    "robustness": [],
    "sim_to_rig": [],
    "train": ["configs/agents/ppo_slew.toml"],
    "tune": ["pd"],
}
#: Commands that import policies, and so need the extra train.
WITH_POLICIES = ("compare", "robustness", "sim_to_rig")


def refusal(command: str, arguments: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    if command in WITH_POLICIES:
        pytest.importorskip("safetensors")
    main = importlib.import_module(f"agents.{command}").main
    assert main(arguments) == 2
    return capsys.readouterr().err


@pytest.mark.parametrize("command", COMMANDS)
def test_results_for_a_folder_that_is_a_file_are_refused_before_the_work(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    place = tmp_path / "results"
    place.write_text("of another")
    words = f"cannot make folder {place}: File exists; name another\n"
    assert refusal(command, [*COMMANDS[command], "--save", str(place)], capsys) == words
    assert place.read_text() == "of another"


BENCHMARKS = {"benchmarks.__main__": ["--start", "--output"], "benchmarks.fuzz.__main__": ["--files", "1", "--keep"]}


@pytest.mark.parametrize("module", BENCHMARKS)
def test_figures_for_no_place_are_refused_before_they_are_measured(module, tmp_path, capsys) -> None:
    (tmp_path / "there").write_text("of another")
    main = pytest.importorskip(module, exc_type=ImportError).main
    assert main([*BENCHMARKS[module], str(tmp_path / "there" / "figures.json")]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert "cannot make folder" in err


@pytest.mark.parametrize(("save", "words"), [("there/a.gif", "cannot make folder"), ("a.tiff", "name a .gif")])
def test_a_film_for_no_place_is_refused_before_it_is_made(
    save: str, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "there").write_text("of another")
    said = refusal("film", ["--save", str(tmp_path / save)], capsys)
    assert words in said
    assert len(said.splitlines()) == 1
