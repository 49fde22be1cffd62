"""Steps of environments, and their comparison bit for bit."""

from __future__ import annotations

from typing import Any

import numpy as np

#: Taps and drop-outs, so that a step depends on every random draw.
TROUBLE = {"tap_rate": 4.0, "dropout_rate": 4.0}


def actions(steps: int, arms: int) -> np.ndarray:
    return np.random.default_rng(3).uniform(-1.0, 1.0, (steps, arms, 1)).astype(np.float32)


def same(first: object, second: object) -> bool:
    """Whether two observations, infos or what they hold are equal bit for bit."""
    if isinstance(first, dict):
        return isinstance(second, dict) and first.keys() == second.keys() and all(same(first[k], second[k]) for k in first)
    if isinstance(first, list | tuple):
        return len(first) == len(second) and all(same(a, b) for a, b in zip(first, second, strict=True))
    one, two = np.asarray(first), np.asarray(second)
    if one.dtype == object:
        return all((a is None and b is None) or same(a, b) for a, b in zip(one, two, strict=True))
    return bool(np.array_equal(one, two))


def steps_of(env: Any, taken: np.ndarray) -> list[Any]:
    """Take steps with a single environment, and reset it at the end of each episode; list all that comes."""
    found = []
    for action in taken:
        result = env.step(action)
        found.append(result)
        if result[2] or result[3]:
            found.append(env.reset())
    return found


def steps_of_many(envs: Any, taken: np.ndarray) -> list[Any]:
    """Take steps with many arms; list all that comes."""
    return [envs.step(action) for action in taken]


def steps_of_all(env: Any, envs: Any, alone: Any, taken: np.ndarray) -> list[Any]:
    """Take steps with two single environments and many arms, of which all but the first may be None."""
    return [
        steps_of(env, taken[:, 0]),
        steps_of_many(envs, taken) if envs is not None else [],
        steps_of(alone, taken[:, 0]) if alone is not None else [],
    ]
