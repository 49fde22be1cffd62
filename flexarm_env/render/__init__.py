"""Animation of the arm seen from above, with its command and its strain, in a window or as pixels."""

from __future__ import annotations

from flexarm_env.render.renderer import Renderer
from flexarm_env.render.scene import Scene, beam_shape

__all__ = ["Renderer", "Scene", "beam_shape"]
