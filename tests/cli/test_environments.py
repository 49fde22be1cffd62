"""The list of environments."""

from __future__ import annotations

import json

import gymnasium as gym
import pytest

from flexarm_env.arm import Arm
from flexarm_env.registration import IDS, SHAPED


@pytest.mark.parametrize("arm", ["thesis", "cu-flexible"])
def test_envs_lists_what_gymnasium_makes(flexarm, arm, tmp_path):
    assert flexarm("envs", "--arm", arm, "--json", tmp_path / "envs.json") == 0
    found = json.loads((tmp_path / "envs.json").read_text())
    assert found.keys() == IDS.keys()
    for id, facts in found.items():
        env = gym.make(id, arm=arm)
        assert id in flexarm.out
        assert env.observation_space.shape == (len(facts["observation"]),)
        assert env.spec.max_episode_steps == facts["steps"] == facts["seconds"] * facts["rate"]
        assert facts["action"]["limit"] == Arm.load(arm).constants["drive"]["limit"]
        assert list(facts["drawn"]) == (["payload.mass"] if "Random" in id else ["target"] if "Goal" in id else [])
    for words in (
        "strain_base" if arm == "thesis" else "tip_deflection",
        "5 s, 1000 steps",
        "10 s, 2000 steps",
        "0.3 kg",
        *SHAPED,
    ):
        assert words in flexarm.out


def test_envs_names_what_an_arm_cannot_have(flexarm):
    assert flexarm("envs", "--arm", "cu-rigid") == 0
    assert "FlexArm/Slew-v0" in flexarm.out
    assert "Not with this arm: FlexArm/Damp-Random-v0" in " ".join(flexarm.out.split())
    assert "drive.limit" in flexarm.refused("envs", "--arm", "emps")
