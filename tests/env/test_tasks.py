"""A file in flexarm_env/tasks/ is a task: its environments, its page, its reward."""

from __future__ import annotations

import doctest
import math
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest

from flexarm_env import InputError
from flexarm_env import env as environments
from flexarm_env.env import FlexArmEnv
from flexarm_env.env.arguments import EnvArguments
from flexarm_env.env.page import page_of
from flexarm_env.tasks import COMMON_TERMS, TASKS, RewardTerm, Task
from flexarm_env.tasks.catalogue import registered_tasks

HEADINGS = ("Description", "Action Space", "Observation Space", "Rewards", "Starting State", "Episode End", "Arguments")
PROJECT = Path(__file__).resolve().parent.parent.parent
every_task = pytest.mark.parametrize("task", TASKS.values(), ids=list(TASKS))

NEW_TASK = '''
import math
from flexarm_env.tasks import COMMON_TERMS, RewardTerm, Task

SLOW = 2.0

def speeding(hub_speed, stuck):
    """Penalise a hub that turns fast."""
    return 0.0 if stuck else -max(abs(hub_speed) - SLOW, 0.0)

def patience(time, target, start_angle, command):
    if abs(command) > 0.5:
        return -math.sqrt(time)
    return 0.1 * (target - start_angle)

LIFT_OFF = Task(
    "lift_off", duration=2.0, target=0.5, half_period=0.3, angle=0.1,
    terms=(*COMMON_TERMS[:2], RewardTerm(speeding, 0.3, "−max(abs(speed) − 2 rad/s, 0)"), RewardTerm(patience, 1.5, "patience")),
    summary="Lift off.", description="A paragraph of its own.",
)
'''
PROGRAM = """
import gymnasium as gym, numpy as np, flexarm_env
from gymnasium.vector import AutoresetMode, SyncVectorEnv

def flat(x):
    if isinstance(x, dict):
        return [(name, flat(x[name])) for name in sorted(x)]
    return [flat(part) for part in x] if isinstance(x, tuple) else np.asarray(x).tolist()

for id in ("FlexArm/LiftOff-v0", "FlexArm/LiftOff-Random-v0"):
    arguments = {"disturb": {"tap_rate": 4.0}, "max_episode_steps": 25}
    batch = gym.make_vec(id, 3, vectorization_mode="vector_entry_point", **arguments)
    singles = SyncVectorEnv([lambda: gym.make(id, **arguments)] * 3)
    assert flat(batch.reset(seed=5)) == flat(singles.reset(seed=5))
    for action in np.random.default_rng(0).uniform(-1.0, 1.0, (60, 3, 1)):
        one, two = batch.step(action), singles.step(action)
        assert flat(one) == flat(two)
info = one[4]
terms = [name for name in info if name.startswith("reward_")]
assert terms == ["reward_distance", "reward_closeness", "reward_speeding", "reward_patience"], terms
assert np.allclose(one[1], sum(info[name] for name in terms))
speed, stuck = info["hub_speed"], info["stuck"]
assert np.array_equal(info["reward_speeding"], np.where(stuck, 0.0, -np.maximum(np.abs(speed) - 2.0, 0.0)) * 0.3)
from flexarm_env.env import LiftOffEnv
env = LiftOffEnv()
env.reset(seed=0)
env.batch.states[:] = np.nan  # an arm whose numbers are lost
_, reward, terminated, _, info = env.step(np.zeros(1))
assert terminated and np.isfinite(reward) and info["reward_speeding"] == 0.0
assert "A paragraph of its own." in LiftOffEnv.__doc__ and "`reward_speeding`" in LiftOffEnv.__doc__
"""


def test_a_new_file_is_a_task_with_a_reward_of_its_own(tmp_path: Path) -> None:
    package = tmp_path / "flexarm_env"
    package.mkdir()
    for part in [*(PROJECT / "flexarm_env").iterdir(), PROJECT / "configs"]:
        if part.name not in ("tasks", "__pycache__"):
            (tmp_path / part.relative_to(PROJECT)).symlink_to(part)
    shutil.copytree(PROJECT / "flexarm_env" / "tasks", package / "tasks")
    (package / "tasks" / "lift_off.py").write_text(NEW_TASK, encoding="utf-8")
    where = {"cwd": tmp_path, "env": os.environ | {"PYTHONPATH": str(tmp_path)}}
    run = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, **where)
    assert run.returncode == 0, run.stderr


@every_task
def test_a_page_is_complete(task: Task) -> None:
    page = page_of(task)
    assert getattr(environments, f"{task.title}Env").__doc__ == page
    for heading in [*HEADINGS, "Version History"]:
        assert f"\n## {heading}\n" in page
    for words in (task.summary, task.description, f"{task.steps()} steps", *EnvArguments.__annotations__):
        assert words in page
    for term in task.terms:
        assert f"| `reward_{term.name}`" in page
        assert term.formula in page


@every_task
def test_the_example_of_a_page_runs(task: Task) -> None:
    test = doctest.DocTestParser().get_doctest(page_of(task), {}, task.name, None, 0)
    result = doctest.DocTestRunner().run(test)
    assert result.attempted >= 7
    assert result.failed == 0


@every_task
def test_an_environment_refuses_another_task(task: Task) -> None:
    for make in (gym.make, lambda id, **arguments: gym.make_vec(id, vectorization_mode="vector_entry_point", **arguments)):
        with pytest.raises(InputError, match=f"this environment's task is '{task.name}'"):
            make(f"FlexArm/{task.title}-v0", task="another")


def test_weights_take_the_place_of_those_of_the_terms() -> None:
    env = FlexArmEnv(Task("mine", 3.0, target=1.0, weights={"distance": 3.0}))
    env.reset(seed=0)
    _, reward, _, _, info = env.step(np.ones(1))
    assert reward == info["reward_distance"] == -3.0 * abs(1.0 - info["hub_angle"])
    assert info["reward_effort"] == 0.0


def haste(hub_speed: float) -> float:
    return -abs(hub_speed)


def misspelt(hub_angel: float) -> float:
    return hub_angel


def helped(hub_angle: float) -> float:
    return haste(hub_angle)


def silent(hub_speed: float) -> None:
    pass


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: RewardTerm(misspelt, 1.0, ""), "did you mean 'hub_angle'"),
        (lambda: RewardTerm(helped, 1.0, ""), "uses 'haste'"),
        (lambda: RewardTerm(lambda hub_angle: hub_angle, 1.0, ""), "with def"),
        (lambda: RewardTerm(haste, math.inf, ""), "weight = inf"),
        (lambda: RewardTerm(silent, 1.0, ""), "returns None"),
        (lambda: Task("mine", 1.0, terms=(*COMMON_TERMS, COMMON_TERMS[0])), "two reward terms 'distance'"),
    ],
)
def test_bad_terms_give_one_clear_line(make: Callable[[], object], words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        make()
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("files", "words"),
    [
        ({"a": "Slew it"}, "lower-case"),
        ({"a": "slew", "b": "slew"}, "exists already"),
    ],
)
def test_bad_names_of_tasks_give_one_clear_line(files: dict, words: str, tmp_path: Path, monkeypatch) -> None:
    package = tmp_path / f"tasks_{len(files)}"
    package.mkdir()
    for file, name in files.items():
        (package / f"{file}.py").write_text(f"from flexarm_env.tasks import Task\nTASK = Task({name!r}, 1.0)\n")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(InputError, match=words):
        registered_tasks(package.name, [str(package)])
