"""Lines, shapes and text drawn on a surface in memory."""

from __future__ import annotations

import functools
import math
from typing import Any

import numpy as np

from flexarm_env.plant.beam import Matrix
from flexarm_env.render.style import GAGE, INK

Colour = tuple[int, int, int]
Point = tuple[float, float]

#: Supersampling: the surface is this much finer than the picture and scaled down at the end, for smooth edges.
FINER = 2
#: Further supersampling of text, because pygame sets each letter on a whole pixel.
TEXT_FINER = 3
#: Height of pygame's default font at a nominal height of 1, over that of a common font.
FONT_HEIGHT = 1.45
DASH, GAP = 7.0, 5.0  # [pixels]


class Canvas:
    """A picture being drawn; all positions and sizes are in pixels of the finished one, x to the right and y down.

    Args:
        pygame: the module.
        size: width and height.
        background: the colour of the empty canvas.
    """

    def __init__(self, pygame: Any, size: tuple[int, int], background: Colour) -> None:
        self.pygame = pygame
        self.size = size
        self.surface = pygame.Surface((FINER * size[0], FINER * size[1]), 0, 32)
        self.surface.fill(background)

    def box(self, left: float, top: float, width: float, height: float, colour: Colour, radius: float = 0.0) -> None:
        """Fill a rectangle with rounded corners."""
        place = self.pygame.Rect(*(round(FINER * number) for number in (left, top, width, height)))
        self.pygame.draw.rect(self.surface, colour, place, border_radius=round(FINER * radius))

    def disc(self, centre: Point, radius: float, colour: Colour) -> None:
        """Fill a circle."""
        self.pygame.draw.circle(self.surface, colour, (FINER * centre[0], FINER * centre[1]), FINER * radius)

    def mark(self, at: Point) -> None:
        """Mark a strain gage."""
        self.disc(at, 4.5, INK)
        self.disc(at, 3.0, GAGE)

    def polygon(self, points: Matrix, colour: Colour) -> None:
        """Fill the polygon with corners (k, 2)."""
        self.pygame.draw.polygon(self.surface, colour, FINER * points)

    def line(self, start: Point, end: Point, colour: Colour, width: float = 1.0) -> None:
        """Draw a straight line."""
        self.band(np.array([start, end]), width, colour)

    def dashes(self, start: Point, end: Point, colour: Colour, width: float = 1.0) -> None:
        """Draw a dashed straight line."""
        a, b = np.array(start), np.array(end)
        length = max(float(np.hypot(*(b - a))), 1e-9)
        for at in np.arange(0.0, length, DASH + GAP):
            ends = a + np.array([[at], [min(at + DASH, length)]]) * (b - a) / length
            self.band(ends, width, colour)

    def band(self, points: Matrix, width: float, colour: Colour) -> None:
        """Draw a smooth curve of constant width through (k, 2) points, k > 1."""
        along = np.gradient(points, axis=0)
        across = np.column_stack([-along[:, 1], along[:, 0]])
        across *= width / 2 / np.maximum(np.hypot(along[:, 0], along[:, 1]), 1e-9)[:, None]
        self.polygon(np.concatenate([points + across, (points - across)[::-1]]), colour)

    def curve(self, points: Matrix, colour: Colour) -> None:
        """Draw straight lines through (k, 2) points; fewer than two draw nothing."""
        if len(points) > 1:
            self.pygame.draw.lines(self.surface, colour, False, FINER * points, round(1.5 * FINER))

    def text(self, words: str, at: Point, colour: Colour, size: int = 12, anchor: str = "midleft") -> None:
        """Write a line with its anchor ("midleft", "center", …: pygame's names) at a point."""
        ink = _ink(self.pygame, words, colour, size)
        self.surface.blit(ink, ink.get_rect(**{anchor: (FINER * at[0], FINER * at[1])}))

    def finished(self) -> Any:
        """Scale the surface down to the finished size."""
        return self.pygame.transform.smoothscale(self.surface, self.size)


@functools.lru_cache(maxsize=128)
def _ink(pygame: Any, words: str, colour: Colour, size: int) -> Any:
    # No font outlives this call: other code in this process may quit pygame's fonts at any time.
    pygame.font.init()
    font = pygame.font.Font(None, round(FONT_HEIGHT * FINER * TEXT_FINER * size))
    ink = font.render(words, True, colour)
    return pygame.transform.smoothscale(ink, (math.ceil(ink.get_width() / TEXT_FINER), math.ceil(ink.get_height() / TEXT_FINER)))


def number(value: float, form: str) -> str:
    """Format a number with a true minus, and without a sign where it rounds to zero."""
    text = format(value, form)
    return text.lstrip("+-") if float(text) == 0.0 else text.replace("-", "−")
