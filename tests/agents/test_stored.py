"""The policies that the repository carries: they load, they are small, and they do what the tables say."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")

from agents.compare import evaluate_any, find_policies
from agents.goals import GOALS, cell_of
from agents.learning.artefact import Artefact
from agents.learning.plan_file import read_plan
from agents.rig import drive
from agents.rig_cases import CASES
from agents.sim_to_rig import PLANS, plan_of, policies_of
from flexarm_env import Arm
from flexarm_env.tasks import TASKS
from flexarm_env.trials.measures import measure

PROJECT = Path(__file__).parents[2]
RESULTS = PROJECT / "results"
STORED = sorted(RESULTS.glob("*/weights/*.safetensors"))
TABLE = RESULTS / "policies" / "policies.json"
MACHINE = RESULTS / "sim_to_rig"


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
    again = cell_of(evaluate_any(paths, "slew", "randomised", Arm.load("thesis"), result["arms"]))
    cells = result["tasks"]["slew"]["randomised"]["cells"]["ppo_slew"]
    for name in GOALS:
        # a stick-slip trajectory may go another way where a processor rounds otherwise
        assert again[name]["iqm"] == pytest.approx(cells[name]["iqm"], rel=0.02)


@pytest.mark.parametrize("case", CASES)
def test_the_machines_policies_were_trained_by_their_plans(case: str) -> None:
    for kind in PLANS:
        _, plan = plan_of(kind, case, MACHINE)
        for path in policies_of(MACHINE, kind, case):
            # where the corrected arm lies is written from the folder in which the policy was trained
            assert replace(Artefact.load(path).plan, arm="") == replace(plan, arm="")


def test_the_machines_table_is_of_what_is_stored() -> None:
    result = json.loads((MACHINE / "sim_to_rig.json").read_text(encoding="utf-8"))
    assert set(result["cases"]) == {case for case in CASES if all(policies_of(MACHINE, kind, case) for kind in PLANS)}
    for case, found in result["cases"].items():
        assert result["diagnoses"][case]["effects"] == [CASES[case].effect]
        for kind in PLANS:
            assert found["runs"][f"policy, {kind}"] == len(policies_of(MACHINE, kind, case)) >= 3


@pytest.mark.slow
def test_what_a_policy_does_on_the_machine_is_measured_again() -> None:
    result = json.loads((MACHINE / "sim_to_rig.json").read_text(encoding="utf-8"))
    agents = [Artefact.load(path).agent() for path in policies_of(MACHINE, "corrected", "cable")]
    task, machine = TASKS["slew"], CASES["cable"].settings
    runs = [measure(drive(agent, task, machine, result["episodes"]), task) for agent in agents]
    again = cell_of({name: np.array([run[name] for run in runs]) for name in GOALS})
    for name in GOALS:
        stored = result["cases"]["cable"]["cells"]["policy, corrected"][name]["iqm"]
        assert again[name]["iqm"] == pytest.approx(stored, rel=0.05), name
