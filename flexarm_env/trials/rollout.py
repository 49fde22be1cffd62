"""Let a controller or policy drive a set of arms, one episode each."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.tasks import Task
from flexarm_env.trials.measures import Trajectories
from flexarm_env.trials.sets import FIRST_SEED, ArmSet
from flexarm_env.vector_env import FlexArmVectorEnv


class Agent(Protocol):
    """Interface of evaluation: a controller of flexarm_env, or a policy with the same two methods."""

    def reset(self, count: int | None = None) -> None:
        """Start an episode of `count` arms."""

    def action(self, observation: NDArray[np.floating[Any]]) -> NDArray[np.float32]:
        """Compute shares of the limit (arms, 1) for physical observations (arms, signals + 1)."""


def roll_out(
    agent: Agent, task: Task, arm: Arm, arms: ArmSet, count: int, rate: float = 200.0, first_seed: int = FIRST_SEED
) -> Trajectories:
    """Drive `count` arms of a set through one episode each; the arms are the same for every agent.

    Args:
        agent: controller or policy.
        task: of the episode.
        arm: the nominal one.
        arms: set from which they are drawn.
        count: of arms.
        rate: usual control steps per second [Hz]; the set's share of them are made, and the agent has to be made for those.
        first_seed: of the first arm; the evaluation's by default.
    """
    rate = arms.rate_share * rate
    envs = FlexArmVectorEnv(count, task, arms.machine(arm), control_rate=rate, physical=True, **arms.arguments(arm))
    observations, _ = envs.reset(seed=first_seed)
    lost = [list(arm.signals).index(signal) for signal in arms.lost if signal in arm.signals]
    agent.reset(count)
    batch, steps = envs.batch, envs.max_episode_steps
    length = arm.constants.get("beam", {}).get("length", 1.0)
    strain = list(arm.signals).index("strain_base") if "strain_base" in arm.signals else None
    tip, target, strains, commands = (np.zeros((steps, count)) for _ in range(4))
    failed = np.zeros(count, dtype=bool)
    seen = batch.info()
    start = seen["hub_angle"]
    for k in range(steps):
        # the target of this sample: at its end the next one may begin
        target[k] = seen["target"]
        observations[:, lost] = 0.0
        observations, _, terminated, _, _ = envs.step(agent.action(observations))
        failed |= terminated
        seen = batch.info()
        tip[k] = seen["hub_angle"] + seen["tip_deflection"] / length
        commands[k] = seen["command"]
        if strain is not None:
            strains[k] = batch.noiseless_readings[:, strain]
    envs.close()
    return Trajectories(tip, target, strains, commands, failed, start, 1.0 / rate)
