"""Gymnasium environments of a flexible arm: observations as the rig measures them. Each registered task has a class here."""

from __future__ import annotations

from typing import Any

from flexarm_env.env.arguments import EnvArguments
from flexarm_env.env.flexarm import FlexArmEnv
from flexarm_env.env.task_envs import TASK_OF_CLASS, task_env
from flexarm_env.env.variation import Disturbance

__all__ = ["Disturbance", "EnvArguments", "FlexArmEnv", *TASK_OF_CLASS]


def __getattr__(name: str) -> Any:
    if name not in TASK_OF_CLASS:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return task_env(name)
