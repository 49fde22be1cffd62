"""Register the environments with Gymnasium: through its entry point, or when flexarm_env is imported."""

from __future__ import annotations

from gymnasium.envs.registration import register, registry

from flexarm_env.tasks import RANDOM_PAYLOAD, TASKS

#: Arguments of the variants of every task's environment, by the word in their ids.
VARIANTS: dict[str, dict[str, object]] = {"": {}, "-Random": {"randomise": {"payload.mass": RANDOM_PAYLOAD}}}

#: Task and variant of every id.
IDS = {f"FlexArm/{task.title}{variant}-v0": (task, variant) for task in TASKS.values() for variant in VARIANTS}


def register_all() -> None:
    """Register every environment that is not registered yet."""
    for id, (task, variant) in IDS.items():
        if id not in registry:
            register(
                id,
                entry_point=f"flexarm_env.env:{task.title}Env",
                vector_entry_point=f"flexarm_env.vector_env:{task.title}VectorEnv",
                max_episode_steps=task.steps(),
                kwargs=dict(VARIANTS[variant]),
            )
