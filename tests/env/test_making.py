"""Environments as they are made: unknown arguments, registration as JSON, seconds at any rate, pictures."""

from __future__ import annotations

import importlib.metadata
import json
import subprocess
import sys
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
from env_steps import actions, same, steps_of, steps_of_many
from gymnasium.envs.registration import EnvSpec
from gymnasium.vector import AutoresetMode

from flexarm_env import Arm, InputError
from flexarm_env.env import Disturbance, FlexArmEnv
from flexarm_env.registration import IDS

NATIVE = {"vectorization_mode": "vector_entry_point"}


def make_many(id: str, **arguments: object) -> gym.vector.VectorEnv:
    return gym.make_vec(id, 3, **NATIVE, **arguments)


@pytest.mark.parametrize("make", [gym.make, make_many, lambda id, **arguments: FlexArmEnv("slew", **arguments)])
def test_an_unknown_keyword_is_refused_as_python_refuses_it(make) -> None:
    with pytest.raises(TypeError, match="got an unexpected keyword argument 'frameskip'") as caught:
        make("FlexArm/Slew-v0", frameskip=1)
    assert isinstance(caught.value, InputError)
    assert "\n" not in str(caught.value)
    with pytest.raises(TypeError, match="'randomize'; did you mean 'randomise'"):
        make("FlexArm/Slew-v0", randomize={})


def test_an_arm_without_a_limit_can_be_given_one() -> None:
    env = gym.make("FlexArm/Slew-v0", arm=Arm.load("emps").with_values({"drive.limit": 5.0}))
    env.reset(seed=0)
    assert env.step(np.ones(1))[4]["command"] == 5.0


def arguments(folder: Path) -> dict:
    path = folder / "corrected.toml"
    Arm.load("thesis-fem").with_effect("backlash", gap=0.02).save(path)
    return {
        "arm": path,
        "prior": Arm.load("thesis").with_values({"hub.inertia": np.float64(0.3)}),
        "disturb": Disturbance(tap_rate=3.0),
        "vary": {"hub.inertia": np.float32(0.1)},
        "randomise": {"payload.mass": np.array([0.0, 0.1])},
        "control_rate": np.int64(100),
    }


@pytest.mark.parametrize("id", IDS)
def test_the_registration_is_json_from_which_an_equal_environment_is_made(id: str, tmp_path: Path) -> None:
    given = arguments(tmp_path)
    if "Random" in id:
        given["randomise"] = {"payload.mass": (0.0, 0.1)}
    one = gym.make(id, **given)
    two = gym.make(EnvSpec.from_json(one.spec.to_json()))
    assert two.spec.to_json() == one.spec.to_json()
    assert two.unwrapped.prior == one.unwrapped.prior
    assert two.spec.max_episode_steps == one.unwrapped.setup.samples
    assert same(one.reset(seed=1), two.reset(seed=1))
    assert same(steps_of(one, actions(60, 1)[:, 0]), steps_of(two, actions(60, 1)[:, 0]))


def test_the_registration_of_many_arms_is_json(tmp_path: Path) -> None:
    one = make_many("FlexArm/Slew-v0", autoreset_mode=AutoresetMode.SAME_STEP, **arguments(tmp_path))
    two = gym.make_vec(EnvSpec.from_json(one.spec.to_json()))
    assert json.loads(two.spec.to_json()) == json.loads(one.spec.to_json())
    assert (two.num_envs, two.metadata["autoreset_mode"]) == (3, AutoresetMode.SAME_STEP)
    assert same(one.reset(seed=1), two.reset(seed=1))
    assert same(steps_of_many(one, actions(60, 3)), steps_of_many(two, actions(60, 3)))


def length(env: gym.Env) -> int:
    """Steps of an episode without a command."""
    env.reset(seed=0)
    for step in range(1, 10_000):
        if env.step(np.zeros(1))[3]:
            return step
    raise AssertionError("no end")


@pytest.mark.parametrize(
    ("given", "steps"),
    [
        ({}, 1000),
        ({"control_rate": 50.0}, 250),
        ({"control_rate": 400.0}, 2000),
        ({"duration": 0.5}, 100),
        ({"duration": 7.5, "control_rate": 100}, 750),
        ({"max_episode_steps": 30}, 30),
    ],
)
def test_an_episode_keeps_its_seconds(given: dict, steps: int) -> None:
    one = gym.make("FlexArm/Damp-v0", **given)
    assert length(one) == steps
    assert one.spec.max_episode_steps == steps
    many = make_many("FlexArm/Damp-v0", **given)
    assert many.unwrapped.max_episode_steps == steps
    sync = gym.make_vec("FlexArm/Damp-v0", 1, vectorization_mode="sync", **given)
    assert sync.envs[0].spec.max_episode_steps == steps


@pytest.mark.parametrize(("rate", "frames"), [(200.0, 200), (50.0, 50), (62.5, 62.5)])
def test_a_film_has_the_rate_of_its_pictures(rate: float, frames: float) -> None:
    for env in (gym.make("FlexArm/Slew-v0", control_rate=rate), make_many("FlexArm/Slew-v0", control_rate=rate)):
        assert env.metadata["render_fps"] == frames
        assert isinstance(env.metadata["render_fps"], type(frames))


@pytest.mark.parametrize(("rate", "drawn"), [(200.0, 10), (40.0, 40), (500.0, 4)])
def test_a_window_shows_true_time(rate: float, drawn: int, monkeypatch) -> None:
    pytest.importorskip("pygame")
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    env = FlexArmEnv("slew", control_rate=rate, render_mode="human")
    times: list[float] = []
    monkeypatch.setattr(env, "render", lambda: times.append(env.batch.outcome[2, 0]))
    env.reset(seed=0)
    times.clear()
    for _ in range(40):
        env.step(np.zeros(1))
    assert len(times) == drawn
    monkeypatch.undo()
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    env.render()
    assert env.view.renderer.fps == pytest.approx(rate * drawn / 40)
    env.close()


def test_many_arms_are_drawn_as_single_ones() -> None:
    pytest.importorskip("pygame")
    many = make_many("FlexArm/Damp-v0", render_mode="rgb_array", max_episode_steps=4)
    singles = [gym.make("FlexArm/Damp-v0", render_mode="rgb_array", max_episode_steps=4) for _ in range(3)]
    many.reset(seed=3)
    for i, env in enumerate(singles):
        env.reset(seed=3 + i)
    for action in actions(4, 3):
        pictures = many.render()
        assert isinstance(pictures, tuple)
        assert same(pictures, tuple(env.render() for env in singles))
        many.step(action)
        for env, own in zip(singles, action, strict=True):
            env.step(own)
    many.step(actions(1, 3)[0])  # the next episodes
    for env in singles:
        env.reset()
    assert same(many.render(), tuple(env.render() for env in singles))
    many.close()
    with pytest.raises(InputError, match="'rgb_array' and None"):
        make_many("FlexArm/Damp-v0", render_mode="human")


def test_the_package_declares_no_entry_point_that_gymnasium_ignores() -> None:
    project = Path(__file__).parents[2] / "pyproject.toml"
    assert "gymnasium.envs" not in project.read_text()


PROGRAM = """
import sys
class Absent:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] == "stable_baselines3":
            raise ModuleNotFoundError(f"No module named '{name}'", name=name.partition(".")[0])
sys.meta_path.insert(0, Absent())
import flexarm_env.sb3
"""


def test_without_sb3_one_line_names_what_to_install() -> None:
    run = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, cwd=Path(__file__).parents[2])
    assert run.returncode == 1
    last = run.stderr.strip().splitlines()[-1]
    assert last == "ModuleNotFoundError: flexarm_env.sb3 needs Stable-Baselines3: pip install 'flexarm-env[train]'"
    assert "During handling" not in run.stderr
    assert "train" in importlib.metadata.metadata("flexarm-env").get_all("Provides-Extra")
