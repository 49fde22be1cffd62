"""Registers the environments with Gymnasium: through its entry point, or when flexarm_env is imported."""

from __future__ import annotations

from gymnasium.envs.registration import register, registry

#: Class, task and steps of an episode at 200 Hz, by the name in the id.
ENVIRONMENTS = {"Slew": ("SlewEnv", "slew", 1000), "Track": ("TrackEnv", "track", 2000), "Damp": ("DampEnv", "damp", 1000)}
#: What differs in the variants of each.
VARIANTS: dict[str, dict[str, object]] = {"": {}, "-Random": {"randomise": {"payload.mass": (0.0, 0.3)}}}


def register_all() -> None:
    """Register every environment that is not registered yet."""
    for name, (env, task, steps) in ENVIRONMENTS.items():
        for variant, arguments in VARIANTS.items():
            if f"FlexArm/{name}{variant}-v0" not in registry:
                register(
                    f"FlexArm/{name}{variant}-v0",
                    entry_point=f"flexarm_env.env:{env}",
                    vector_entry_point=f"flexarm_env.vector_env:{task}_vector",
                    max_episode_steps=steps,
                    kwargs=dict(arguments),
                )
