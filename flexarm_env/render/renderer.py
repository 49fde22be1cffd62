"""The renderer: one picture per scene, in a window or as pixels."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from gymnasium.error import ClosedEnvironmentError, DependencyNotInstalled
from numpy.typing import NDArray

from flexarm_env.errors import InputError
from flexarm_env.render.canvas import Canvas
from flexarm_env.render.panels import draw_readings, draw_strain
from flexarm_env.render.scene import Scene
from flexarm_env.render.style import PAPER, SIZE
from flexarm_env.render.top_view import draw_arm, draw_bench


class Renderer:
    """Renderer of scenes.

    Args:
        mode: "human" opens a window, "rgb_array" needs no display.
        length: from the hub to the tip [m].
        fps: pictures per second of a window.
        gages: positions of the strain gages along the beam [m].
        exaggeration: factor on the drawn deflection; the picture states it.

    Raises:
        InputError: for an unknown mode, or a length, rate or factor that is not positive.
        gymnasium.error.DependencyNotInstalled: without pygame.
    """

    def __init__(
        self,
        mode: Literal["human", "rgb_array"],
        length: float,
        fps: float,
        gages: Sequence[float] = (),
        exaggeration: float = 1.0,
    ) -> None:
        if mode not in ("human", "rgb_array"):
            raise InputError(f"render mode {mode!r} does not exist: choose 'human' or 'rgb_array'")
        for name, value in (("length", length), ("fps", fps), ("exaggeration", exaggeration)):
            if not value > 0.0:
                raise InputError(f"{name} = {value:g} must be positive")
        self.mode = mode
        self.length = length
        self.fps = fps
        self.gages = gages
        self.exaggeration = exaggeration
        self._pygame: Any = _import_pygame()
        self._window: Any = None
        self._clock: Any = None

    def __reduce__(self) -> tuple[Any, ...]:
        # A copy opens a window of its own.
        return Renderer, (self.mode, self.length, self.fps, self.gages, self.exaggeration)

    def draw(self, scene: Scene) -> NDArray[np.uint8] | None:
        """Draw a scene.

        Returns:
            (height, width, 3) in mode "rgb_array"; None in mode "human", after waiting for the picture's turn.

        Raises:
            gymnasium.error.ClosedEnvironmentError: after close().
        """
        if self._pygame is None:
            raise ClosedEnvironmentError("this renderer is closed; make a new one to draw")
        canvas = Canvas(self._pygame, SIZE, PAPER)
        draw_bench(canvas, scene.target)
        draw_arm(canvas, scene, self.length, self.gages, self.exaggeration)
        draw_readings(canvas, scene)
        draw_strain(canvas, scene)
        picture = canvas.finished()
        if self.mode == "rgb_array":
            return np.frombuffer(bytearray(self._pygame.image.tobytes(picture, "RGB")), dtype=np.uint8).reshape(
                SIZE[1], SIZE[0], 3
            )
        self._show(picture)
        return None

    def _show(self, picture: Any) -> None:
        if self._window is None:
            self._pygame.display.init()
            self._window = self._pygame.display.set_mode(SIZE)
            self._pygame.display.set_caption("FlexArm")
            self._clock = self._pygame.time.Clock()
        self._window.blit(picture, (0, 0))
        self._pygame.event.pump()
        self._pygame.display.flip()
        self._clock.tick(self.fps)

    def close(self) -> None:
        """Close the window, if there is one; a closed renderer draws no more."""
        if self._window is not None:
            self._pygame.display.quit()
        self._window = self._pygame = None


def _import_pygame() -> Any:
    # pygame greets on stdout, which belongs to the caller.
    os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
    try:
        import pygame
    except ImportError as error:
        raise DependencyNotInstalled('pygame is not installed, run `pip install "flexarm-env[render]"`') from error
    return pygame
