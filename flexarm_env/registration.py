"""Register the environments with Gymnasium, when flexarm_env is imported."""

from __future__ import annotations

from typing import Any

from gymnasium.envs.registration import register, registry

from flexarm_env.tasks import RANDOM_PAYLOAD, TASKS

#: Lowest and highest target of the "-Goal" variants [rad].
GOALS = (-2.0, 2.0)
#: Arguments of the variants of every task's environment, by the word in their ids.
VARIANTS: dict[str, dict[str, Any]] = {
    "": {},
    "-Random": {"randomise": {"payload.mass": RANDOM_PAYLOAD}},
    "-Goal": {"goals": GOALS},
}

#: Task and variant of every id with the rig's readings as observations.
IDS = {f"FlexArm/{task.title}{variant}-v0": (task, variant) for task in TASKS.values() for variant in VARIANTS}
#: Task of every id with the observation, the action and the reward of the shipped policies.
SHAPED = {f"FlexArm/{task.title}-Shaped-v0": task for task in TASKS.values()}


def register_all() -> None:
    """Register every environment that is not registered yet.

    They have no max_episode_steps: an environment ends its episodes after their seconds, at any control rate.
    """
    for id, (task, variant) in IDS.items():
        if id not in registry:
            register(
                id,
                entry_point=f"flexarm_env.env:{task.title}Env",
                vector_entry_point=f"flexarm_env.vector_env:{task.title}VectorEnv",
                kwargs=dict(VARIANTS[variant]),
            )
    for id, task in SHAPED.items():
        if id not in registry:
            register(
                id,
                entry_point=f"flexarm_env.wrappers.registered:{task.title}Shaped",
                vector_entry_point=f"flexarm_env.wrappers.registered:{task.title}ShapedVector",
            )
