"""A copy of an environment goes on bit for bit, in the middle of an episode, and in a process that has not built its arm."""

from __future__ import annotations

import copy
import io
import pickle
import subprocess
import sys
from pathlib import Path

import cloudpickle
import gymnasium as gym
import joblib
import numpy as np
import pytest
from env_steps import TROUBLE, actions, same, steps_of, steps_of_all, steps_of_many
from gymnasium.vector import AsyncVectorEnv, AutoresetMode
from soft_stop import soft_stop

from flexarm_env import Arm, catalogue
from flexarm_env.env import FlexArmEnv
from flexarm_env.registration import IDS
from flexarm_env.tasks import COMMON_TERMS, RewardTerm, Task


def stored(thing: object) -> object:
    file = io.BytesIO()
    joblib.dump(thing, file)
    file.seek(0)
    return joblib.load(file)


COPIES = {
    "deepcopy": copy.deepcopy,
    "pickle": lambda thing: pickle.loads(pickle.dumps(thing)),
    "cloudpickle": lambda thing: pickle.loads(cloudpickle.dumps(thing)),
    "joblib": stored,
}
every_copy = pytest.mark.parametrize("copied", COPIES.values(), ids=list(COPIES))
#: Commands that arrive late, and a reading that depends on past ones.
LATE = Arm.load("thesis").with_values({"sensors.arm_angle.delay": 0.0175}).with_effect("input_delay", delay=0.012)
ARGUMENTS = [{}, {"arm": LATE, "control_rate": 100.0}, {"arm": "thesis-fem", "vary": {"hub.inertia": 0.1}}]


@every_copy
@pytest.mark.parametrize("arguments", ARGUMENTS)
@pytest.mark.parametrize("id", IDS)
def test_a_copy_of_an_environment_goes_on(id: str, arguments: dict, copied) -> None:
    env = gym.make(id, disturb=TROUBLE, duration=1.0, **arguments)
    taken = actions(300, 1)[:, 0]
    before = copied(env)
    assert same(before.reset(seed=5), env.reset(seed=5))
    steps_of(env, taken[:70])
    middle = copied(env)
    assert same(steps_of(middle, taken[70:]), steps_of(env, taken[70:]))
    assert not same(middle.step(taken[0])[0], middle.step(-taken[0])[0])  # it moves


@every_copy
@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
@pytest.mark.parametrize("threads", [1, 2])
def test_a_copy_of_many_arms_goes_on(threads: int, mode: AutoresetMode, copied) -> None:
    envs = gym.make_vec(
        "FlexArm/Track-Random-v0",
        40,
        vectorization_mode="vector_entry_point",
        autoreset_mode=mode,
        threads=threads,
        disturb=TROUBLE,
        max_episode_steps=25,
    )
    taken = actions(90, 40)
    before = copied(envs)
    assert same(before.reset(seed=5), envs.reset(seed=5))
    steps_of_many(envs, taken[:30])
    middle = copied(envs)
    assert same(steps_of_many(middle, taken[30:]), steps_of_many(envs, taken[30:]))
    for each in (envs, before, middle):
        each.close()


def test_a_copy_is_another_environment() -> None:
    env = gym.make("FlexArm/Slew-v0")
    env.reset(seed=0)
    other, alone = copy.deepcopy(env), copy.deepcopy(env)
    first = env.step(np.ones(1))[0]
    for _ in range(20):
        other.step(-np.ones(1))
    assert same(alone.step(np.ones(1))[0], first)
    assert same(env.step(np.ones(1))[0], alone.step(np.ones(1))[0])


def test_a_copy_draws_the_same_pictures() -> None:
    pytest.importorskip("pygame")
    env = gym.make("FlexArm/Damp-v0", render_mode="rgb_array")
    env.reset(seed=0)
    for _ in range(5):
        env.step(np.ones(1))
        env.render()
    other = pickle.loads(pickle.dumps(env))
    assert same(other.render(), env.render())
    for each in (env, other):
        each.step(np.zeros(1))
    assert same(other.render(), env.render())


PROGRAM = """
import pickle, sys
sys.path.insert(0, sys.argv[1])
with open(sys.argv[2], "rb") as file:
    env, envs, alone, taken = pickle.load(file)
from env_steps import steps_of_all
found = steps_of_all(env, envs, alone, taken)
with open(sys.argv[2], "wb") as file:
    pickle.dump(found, file)
"""


def hurry(hub_speed: float) -> float:
    return abs(hub_speed) - SLOW


SLOW = 0.5
TERM_OF_A_FILE = """
from flexarm_env.tasks import RewardTerm
LEAST = 0.25
def haste(hub_speed):
    return abs(hub_speed) - LEAST
TERM = RewardTerm(haste, 2.0, "")
"""


def test_a_copy_goes_on_in_a_new_process(tmp_path: Path, monkeypatch) -> None:
    (tmp_path / "term_of_a_file.py").write_text(TERM_OF_A_FILE)
    monkeypatch.syspath_prepend(tmp_path)
    import term_of_a_file  # the other process does not have it

    cloudpickle.register_pickle_by_value(term_of_a_file)
    env = gym.make("FlexArm/Slew-Random-v0", arm=LATE, disturb=TROUBLE, duration=0.5)
    envs = gym.make_vec("FlexArm/Damp-v0", 3, vectorization_mode="vector_entry_point", disturb=TROUBLE, max_episode_steps=40)
    alone = FlexArmEnv(Task("mine", 3.0, target=0.5, terms=(*COMMON_TERMS, term_of_a_file.TERM)), "thesis-fem")
    check_in_a_new_process(tmp_path, env, alone, envs, actions(120, 3))


def check_in_a_new_process(folder: Path, env: gym.Env, alone: gym.Env | None, envs: gym.vector.VectorEnv | None, taken) -> None:
    """Send environments in the middle of an episode to a new process, and compare its steps with those here."""
    for each in filter(None, (env, alone, envs)):
        each.reset(seed=2)
        for action in taken[:30]:
            each.step(action if each is envs else action[0])
    path = folder / "sent"
    path.write_bytes(cloudpickle.dumps((env, envs, alone, taken)))
    program = [sys.executable, "-c", PROGRAM, str(Path(__file__).parent.parent), str(path)]
    run = subprocess.run(program, capture_output=True, text=True, cwd=Path(__file__).parents[2])
    assert run.returncode == 0, run.stderr
    assert same(pickle.loads(path.read_bytes()), steps_of_all(env, envs, alone, taken))


def test_a_term_keeps_its_source() -> None:
    term = RewardTerm(hurry, 1.0, "")
    sent = cloudpickle.loads(cloudpickle.dumps(term))
    assert sent.function.source.startswith("def hurry")


def test_processes_of_gymnasium_step_what_they_are_sent() -> None:
    env = gym.make("FlexArm/Track-v0", disturb=TROUBLE)
    taken = actions(40, 1)
    env.reset(seed=1)
    there = AsyncVectorEnv([lambda: env], context="spawn")
    first, _ = there.reset(seed=8)
    seen = [first, *(there.step(action)[0] for action in taken)]
    there.close()
    here = [env.reset(seed=8)[0], *(env.step(action[0])[0] for action in taken)]
    assert same([one[0] for one in seen], here)


@pytest.mark.slow(minutes=2)
def test_an_arm_with_an_effect_of_ones_own_goes_on_in_a_new_process(tmp_path: Path) -> None:
    known = catalogue().extended(soft_stop(tmp_path))
    env = gym.make("FlexArm/Damp-v0", arm=Arm.load("thesis", known).with_effect("soft_stop", stiffness=2.0, start=0.0))
    check_in_a_new_process(tmp_path, env, None, None, actions(60, 1))
