"""Threads share the arms of a step: they change no bit, sleep and wake, survive a stop, and end with their environment."""

from __future__ import annotations

import gc
import threading
import time

import gymnasium as gym
import numpy as np
import pytest

from flexarm_env.vector_env import FlexArmVectorEnv

ARMS = 200


def make(threads: int, arms: int = ARMS) -> FlexArmVectorEnv:
    envs = gym.make_vec("FlexArm/Track-v0", arms, vectorization_mode="vector_entry_point", threads=threads, max_episode_steps=40)
    assert isinstance(envs.unwrapped, FlexArmVectorEnv)
    envs.reset(seed=1)
    return envs.unwrapped


def actions(steps: int, arms: int = ARMS) -> np.ndarray:
    return np.random.default_rng(0).uniform(-1.0, 1.0, (steps, arms, 1)).astype(np.float32)


def check_same(ours: object, theirs: object) -> None:
    if isinstance(ours, dict):
        assert isinstance(theirs, dict)
        assert ours.keys() == theirs.keys()
        for name in ours:
            check_same(ours[name], theirs[name])
        return
    assert np.array_equal(np.asarray(ours), np.asarray(theirs))


@pytest.mark.parametrize(("threads", "arms"), [(2, ARMS), (3, ARMS), (7, 33), (2, 2)])
def test_threads_change_nothing(threads: int, arms: int) -> None:
    one, several = make(1, arms), make(threads, arms)
    for k, action in enumerate(actions(100, arms)):
        if k % 25 == 0:
            time.sleep(0.01)  # so that helpers fall asleep
        for ours, theirs in zip(one.step(action), several.step(action), strict=True):
            check_same(theirs, ours)
    several.close()


def test_a_step_that_is_stopped_leaves_no_thread_at_work() -> None:
    one, two = make(1), make(2)
    crew = two.batch.crew
    assert crew is not None

    def stopped(first: int, last: int) -> None:
        raise KeyboardInterrupt

    for _ in range(20):
        with pytest.raises(KeyboardInterrupt):
            crew.run(stopped)
        arena = two.batch.arena.copy()
        time.sleep(0.001)
        assert np.array_equal(arena, two.batch.arena)
    one.reset(seed=5)
    two.reset(seed=5)
    for action in actions(50):
        for ours, theirs in zip(one.step(action), two.step(action), strict=True):
            check_same(theirs, ours)
    two.close()


@pytest.mark.parametrize("closed", [True, False])
def test_threads_end_with_their_environment(closed: bool) -> None:
    before = set(threading.enumerate())
    envs = make(3)
    envs.step(actions(1)[0])
    helpers = set(threading.enumerate()) - before
    assert len(helpers) == 2
    if closed:
        envs.close()
        envs.close()
    del envs
    gc.collect()
    for helper in helpers:
        helper.join(5.0)
        assert not helper.is_alive()
