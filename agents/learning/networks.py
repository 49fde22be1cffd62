"""A policy with a privileged critic."""

from __future__ import annotations

from typing import Any

import torch
from stable_baselines3.common.distributions import Distribution
from stable_baselines3.common.policies import ActorCriticPolicy
from stable_baselines3.common.torch_layers import MlpExtractor

#: Bounds of the logarithm of an action's standard deviation.
LEAST_LOG_STD, MOST_LOG_STD = -5.0, 1.0


class TwoViews(MlpExtractor):
    """Networks of a policy with the first `visible` features as inputs, and of a critic with all of them."""

    def __init__(self, visible: int, width: int, layers: list[int], activation: type[torch.nn.Module]) -> None:
        super().__init__(visible, {"pi": layers, "vf": []}, activation)
        critic = MlpExtractor(width, {"pi": [], "vf": layers}, activation)
        self.visible, self.value_net, self.latent_dim_vf = visible, critic.value_net, critic.latent_dim_vf

    def forward_actor(self, features: torch.Tensor) -> torch.Tensor:
        """Compute the inputs of the policy's last layer."""
        return self.policy_net(features[:, : self.visible])


class TwoViewPolicy(ActorCriticPolicy):
    """Actor and critic of PPO, where the critic has a simulator's privileged inputs, too (Pinto et al., RSS 2018).

    Actions are normal, with one standard deviation for all states, or with one of their own in each.

    Args:
        visible: number of the actor's features; the rest is for the critic.
        own_spread: whether the standard deviation depends on the state.
        arguments: of ActorCriticPolicy.
        options: of ActorCriticPolicy.
    """

    def __init__(self, *arguments: Any, visible: int, own_spread: bool = False, **options: Any) -> None:
        self.visible, self.own_spread = visible, own_spread
        super().__init__(*arguments, **options)

    def _build_mlp_extractor(self) -> None:
        layers = list(self.net_arch)
        self.mlp_extractor = TwoViews(self.visible, self.features_dim, layers, self.activation_fn)
        if self.own_spread:
            # made here, before the optimiser is
            self.spread_net = torch.nn.Linear(self.mlp_extractor.latent_dim_pi, self.action_space.shape[0])
            torch.nn.init.zeros_(self.spread_net.weight)
            torch.nn.init.zeros_(self.spread_net.bias)

    def _get_action_dist_from_latent(self, latent_pi: torch.Tensor) -> Distribution:
        if not self.own_spread:
            return super()._get_action_dist_from_latent(latent_pi)
        spread = torch.clamp(self.log_std + self.spread_net(latent_pi), LEAST_LOG_STD, MOST_LOG_STD)
        return self.action_dist.proba_distribution(self.action_net(latent_pi), spread)
