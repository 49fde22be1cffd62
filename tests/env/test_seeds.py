"""Seeds of a reset: of Python or numpy, the largest, and none at first."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest
from env_steps import same

MANY = {"id": "FlexArm/Slew-Random-v0", "num_envs": 3, "vectorization_mode": "vector_entry_point"}


@pytest.mark.parametrize("seed", [None, [None, None, None]])
def test_a_first_reset_without_seeds_is_random_for_each_arm(seed: object) -> None:
    loads = []
    for _ in range(2):
        envs = gym.make_vec(**MANY)
        envs.reset(seed=seed)
        loads += [envs.unwrapped.drawn_arm(i).value("effects.payload.mass") for i in range(3)]
    assert len(set(loads)) == 6


def test_of_seeds_that_some_arms_lack_the_others_hold() -> None:
    envs, one = gym.make_vec(**MANY), gym.make("FlexArm/Slew-Random-v0").unwrapped
    first = envs.reset(seed=[None, 5, None])[0]
    assert same(first[1], one.reset(seed=5)[0])
    again = envs.reset(seed=[6, None, None])[0]
    assert same(again[1], one.reset()[0])
    assert same(again[0], one.reset(seed=6)[0])


@pytest.mark.parametrize(
    ("given", "plain"),
    [
        (np.int32(3), [3, 4, 5]),
        (np.array(3), [3, 4, 5]),
        (np.array([1, 2, 9]), [1, 2, 9]),
        (2**64 - 3, [2**64 - 3 + i for i in range(3)]),
    ],
)
def test_seeds_of_numpy_are_those_of_python(given: object, plain: list[int]) -> None:
    envs, one = gym.make_vec(**MANY), gym.make("FlexArm/Slew-Random-v0").unwrapped
    first = envs.reset(seed=given)[0]
    assert all(same(first[i], one.reset(seed=seed)[0]) for i, seed in enumerate(plain))
