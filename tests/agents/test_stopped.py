"""Evaluations that Ctrl-C stops: the same command goes on, and its results are those of a run that was not stopped."""

from __future__ import annotations

import importlib
import re
import shutil
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("stable_baselines3")

from documents import PROJECT

from agents import cells
from flexarm_env.controllers import CONTROLLERS
from flexarm_env.trials.sets import ROBUSTNESS, SETS

STORED = PROJECT / "results"
#: Cells after which a run is stopped.
BEFORE = 2


def small(command: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Make a command's work small: few arms, controllers and policies. Return its arguments."""
    module: Any = importlib.import_module(f"agents.{command}")
    few = {name: CONTROLLERS[name] for name in ("pd", "vibration_low")}
    if command == "sim_to_rig":
        monkeypatch.setattr(module, "CASES", {"bias": module.CASES["bias"]})
        monkeypatch.setattr("agents.rig_controllers.CLASSICAL", ("pd",))
        weights = [f"weights/{name}-0.safetensors" for name in ("nominal-thesis-fem", "randomised-thesis-fem", "corrected-bias")]
        for name in ("arms/bias.toml", "arms/bias.json", *weights):
            for save in ("whole", "stopped"):
                copy(f"sim_to_rig/{name}", (folder / save / name).parent)
        return ["--count", "1", "--jobs", "1"]
    arguments = ["--count", "2", "--jobs", "1"]
    if command == "robustness":
        monkeypatch.setattr(module, "ROBUSTNESS", {name: ROBUSTNESS[name] for name in ("randomised", "half_rate")})
        arguments += ["pd", "ppo_slew"]
    else:
        monkeypatch.setattr(module, "SETS", {"randomised": SETS["randomised"]})
    if command == "evaluate":
        return [*arguments, "--controllers", *few]
    if command == "compare":
        monkeypatch.setattr(module, "CONTROLLERS", few)
        monkeypatch.setattr(module, "THESIS", tuple(few))
    copy("policies/weights/ppo_slew-0.safetensors", folder / "policies")
    return [*arguments, "--policies", str(folder / "policies")]


def copy(name: str, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copy(STORED / name, folder)


def results(folder: Path) -> dict[str, str]:
    texts = {path.name: path.read_text(encoding="utf-8") for path in sorted(folder.iterdir()) if path.suffix in (".json", ".md")}
    return {name: re.sub(r'(?m)^ "seconds": .*', "", text) for name, text in texts.items()}


@pytest.mark.parametrize("command", ["evaluate", "compare", "robustness", "sim_to_rig"])
def test_a_stopped_evaluation_ends_with_the_same_bytes(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    main = importlib.import_module(f"agents.{command}").main
    arguments, made, compute = small(command, tmp_path, monkeypatch), [], cells._compute

    def counted(function: Any, given: Any, place: Path) -> Any:
        if len(made) == stop_at:
            raise KeyboardInterrupt
        made.append(place)
        return compute(function, given, place)

    monkeypatch.setattr(cells, "_compute", counted)
    stop_at = -1
    assert main([*arguments, "--save", str(tmp_path / "whole")]) == 0
    every, stop_at = len(made), len(made) + BEFORE
    assert main([*arguments, "--save", str(tmp_path / "stopped")]) == 130
    assert capsys.readouterr().err.strip() == "stopped; the same command goes on"
    (left,) = (tmp_path / "stopped").glob("*.cells")
    assert sorted(left.iterdir()) == sorted(made[every:])
    stop_at = -1
    assert main([*arguments, "--save", str(tmp_path / "stopped")]) == 0
    assert len(made) == 2 * every > 2 * BEFORE
    assert results(tmp_path / "stopped") == results(tmp_path / "whole")
    assert not list(tmp_path.glob("*/*.cells"))
