"""From a plan to an algorithm of Stable-Baselines3 or sb3-contrib."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import torch
from sb3_contrib import TQC, RecurrentPPO
from sb3_contrib.common.recurrent.policies import RecurrentActorCriticPolicy
from sb3_contrib.tqc.policies import TQCPolicy
from stable_baselines3 import PPO, SAC
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.policies import BasePolicy
from stable_baselines3.sac.policies import SACPolicy

from agents.learning.episodes import EpisodeVecEnv, spaces_of
from agents.learning.networks import TwoViewPolicy
from agents.learning.options import Plan

ACTIVATIONS = {"tanh": torch.nn.Tanh, "relu": torch.nn.ReLU, "elu": torch.nn.ELU}
POLICIES: dict[str, type[BasePolicy]] = {
    "ppo": TwoViewPolicy,
    "recurrent_ppo": RecurrentActorCriticPolicy,
    "sac": SACPolicy,
    "tqc": TQCPolicy,
}
#: Beginnings of the names of weights that only training needs.
TRAINING_ONLY = ("mlp_extractor.value_net.", "value_net.", "lstm_critic.", "critic.", "critic_target.")
ON_POLICY = ("ppo", "recurrent_ppo")


def make_model(plan: Plan, env: EpisodeVecEnv, seed: int) -> BaseAlgorithm:
    """Build an algorithm that is ready to learn on CPU.

    On-policy algorithms update after whole episodes of all arms, so that a run can be taken up again between two of them.
    """
    learning = plan.learning
    common: dict[str, Any] = {
        "policy": POLICIES[plan.algorithm],
        "env": env,
        "policy_kwargs": policy_arguments(plan, env.interface.size),
        "learning_rate": lambda left: learning.last_learning_rate + left * (learning.learning_rate - learning.last_learning_rate),
        "gamma": learning.gamma,
        "batch_size": learning.batch_size,
        "seed": seed,
        "device": "cpu",
    }
    if plan.algorithm in ON_POLICY:
        build = PPO if plan.algorithm == "ppo" else RecurrentPPO
        return build(
            **common,
            n_steps=env.steps,
            n_epochs=learning.epochs,
            gae_lambda=learning.gae_lambda,
            clip_range=learning.clip,
            ent_coef=learning.entropy,
        )
    build = SAC if plan.algorithm == "sac" else TQC
    return build(
        **common,
        buffer_size=learning.buffer,
        learning_starts=learning.warm_up,
        gradient_steps=learning.gradient_steps,
        train_freq=1,
        tau=learning.tau,
    )


def policy_arguments(plan: Plan, visible: int) -> dict[str, Any]:
    """Make the arguments of the algorithm's policy class, beside its spaces."""
    network = plan.network
    arguments: dict[str, Any] = {"net_arch": list(network.layers), "activation_fn": ACTIVATIONS[network.activation]}
    if plan.algorithm in ON_POLICY:
        arguments["log_std_init"] = network.log_std
    if plan.algorithm == "ppo":
        arguments |= {"visible": visible, "own_spread": network.spread == "own"}
    if plan.algorithm == "recurrent_ppo":
        arguments["lstm_hidden_size"] = network.memory
    return arguments


def bare_policy(plan: Plan, visible: int) -> BasePolicy:
    """Build an untrained policy with `visible` features, to be loaded with weights."""
    seen, action = spaces_of(visible, plan.interface.actions)
    return POLICIES[plan.algorithm](seen, action, lambda _: 0.0, **policy_arguments(plan, visible))


def hidden_weights(plan: Plan, visible: int) -> int:
    """Count the weights of the layers between the features and the last layer of a policy, without building it."""
    network, first, count = plan.network, visible, 0
    if plan.algorithm == "recurrent_ppo":  # each of an LSTM's four gates has two biases
        first, count = network.memory, 4 * network.memory * (visible + network.memory + 2)
    return count + sum((inputs + 1) * units for inputs, units in pairwise([first, *network.layers]))
