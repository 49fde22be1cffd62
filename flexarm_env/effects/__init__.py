"""The catalogue of effects: one file each in this folder, and those registered by other packages."""

from __future__ import annotations

from flexarm_env.effects.base import Effect
from flexarm_env.effects.catalogue import Catalogue, catalogue, load_effect

__all__ = ["Catalogue", "Effect", "catalogue", "load_effect"]
