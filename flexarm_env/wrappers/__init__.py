"""Observation, action and reward of the shipped policies, as wrappers of one arm and of many."""

from __future__ import annotations

from flexarm_env.wrappers.interface import PolicyInterface
from flexarm_env.wrappers.options import ArmsOptions, InterfaceOptions, RewardOptions
from flexarm_env.wrappers.reward import ShapedReward
from flexarm_env.wrappers.shaped import Shaped
from flexarm_env.wrappers.shaped_vector import ShapedVector

__all__ = ["ArmsOptions", "InterfaceOptions", "PolicyInterface", "RewardOptions", "Shaped", "ShapedReward", "ShapedVector"]
