"""The policies that the repository carries: they load, they are small, and they do what the tables say."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

pytest.importorskip("stable_baselines3")

from agents.compare import evaluate_policies, find_policies
from agents.goals import GOALS, cell_of
from agents.learning.artefact import Artefact
from agents.learning.plan_file import read_plan

PROJECT = Path(__file__).parents[2]
RESULTS = PROJECT / "results"
STORED = sorted(RESULTS.glob("*/weights/*.safetensors"))
TABLE = RESULTS / "policies" / "policies.json"


def test_there_are_some_and_they_are_small() -> None:
    assert len(STORED) >= 3
    assert sum(path.stat().st_size for path in STORED) < 3e6


@pytest.mark.parametrize("path", STORED, ids=lambda path: f"{path.parts[-3]}-{path.stem}")
def test_a_stored_policy_loads(path: Path) -> None:
    artefact = Artefact.load(path)
    artefact.agent().reset(2)
    assert artefact.run["seed"] == int(path.stem.rpartition("-")[2])
    assert not Path(artefact.plan.arm).is_absolute()


@pytest.mark.parametrize("name", sorted(find_policies(RESULTS / "policies" / "weights")))
def test_a_stored_policy_was_trained_by_its_configuration(name: str) -> None:
    plan = read_plan(PROJECT / "configs" / "agents" / f"{name}.toml")
    for path in find_policies(RESULTS / "policies" / "weights")[name]:
        assert Artefact.load(path).plan == plan


def test_the_table_is_of_the_stored_policies() -> None:
    result = json.loads(TABLE.read_text(encoding="utf-8"))
    stored = {name: len(paths) for name, paths in find_policies(RESULTS / "policies" / "weights").items()}
    assert {name: len(entry["runs"]) for name, entry in result["policies"].items()} == stored
    assert result["arms"] >= 100


@pytest.mark.slow
def test_the_table_is_made_again_from_what_is_stored() -> None:
    result = json.loads(TABLE.read_text(encoding="utf-8"))
    paths = find_policies(RESULTS / "policies" / "weights")["ppo_slew"]
    again = cell_of(evaluate_policies(paths, "slew", "randomised", "thesis", result["arms"]))
    cells = result["tasks"]["slew"]["randomised"]["cells"]["ppo_slew"]
    for name in GOALS:
        # a stick-slip trajectory may go another way where a processor rounds otherwise
        assert again[name]["iqm"] == pytest.approx(cells[name]["iqm"], rel=0.02)
