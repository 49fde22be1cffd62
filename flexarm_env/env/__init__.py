"""Gymnasium environments of a flexible arm: what the rig measures, as users of Gymnasium expect it."""

from __future__ import annotations

from flexarm_env.env.flexarm import FlexArmEnv
from flexarm_env.env.pages import DampEnv, SlewEnv, TrackEnv
from flexarm_env.env.variation import Disturbance

__all__ = ["DampEnv", "Disturbance", "FlexArmEnv", "SlewEnv", "TrackEnv"]
