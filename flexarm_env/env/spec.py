"""The registration of a made environment, in values that JSON has."""

from __future__ import annotations

import dataclasses
import enum
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from gymnasium.envs.registration import EnvSpec

from flexarm_env.arm import Arm
from flexarm_env.arm_text import arm_text


def plain_spec(spec: EnvSpec | None, steps: int) -> EnvSpec | None:
    """Write an environment's arguments in values that JSON has, and state the steps of an episode.

    Args:
        spec: as gymnasium.make gives it to the environment, or None.
        steps: of an episode.
    """
    if spec is None:
        return None
    arguments = {name: plain(value) for name, value in spec.kwargs.items() if name != "max_episode_steps"}
    return dataclasses.replace(spec, kwargs=arguments, max_episode_steps=steps)


def plain(value: Any) -> Any:
    """Convert a path to text, an arm to the tables of its file, and a setting to its numbers."""
    if isinstance(value, Arm):
        return tomllib.loads(arm_text(value))
    if isinstance(value, Mapping):
        return {key: plain(one) for key, one in value.items()}
    if isinstance(value, tuple | list):
        return [plain(one) for one in value]
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist()
    if isinstance(value, Path):
        return str(value)
    return value.value if isinstance(value, enum.Enum) else value
