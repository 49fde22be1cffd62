"""The arm on its bench, seen from above."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from flexarm_env.plant.beam import Matrix
from flexarm_env.render.canvas import Canvas, Point, number
from flexarm_env.render.scene import Scene
from flexarm_env.render.style import BEAM, BENCH, FREE, HUB_AT, INK, PAPER, QUIET, REACH, RULE, SCALE, STUCK, TABLE, TARGET

HUB_RADIUS = 15.0  # [pixels]
BEAM_WIDTH = 5.0  # [pixels]
NEAR = math.cos(math.radians(11.0))


def point(angle: float, along: float, across: float = 0.0) -> Point:
    """Convert distances along and across (counter-clockwise) the hub's line at an angle [rad] to a point, in pixels."""
    c, s = math.cos(angle), math.sin(angle)
    return HUB_AT[0] + along * c - across * s, HUB_AT[1] - along * s - across * c


def draw_bench(canvas: Canvas, target: float | None) -> None:
    """Draw the bench and the scale of angles; the label of the target [rad] replaces that of a near tick."""
    canvas.box(*TABLE, BENCH, radius=14)
    canvas.disc(HUB_AT, SCALE, RULE)
    canvas.disc(HUB_AT, SCALE - 1.5, PAPER)
    for degrees in range(-170, 181, 10):
        angle, long = math.radians(degrees), degrees % 30 == 0
        canvas.line(point(angle, SCALE - (9 if long else 4)), point(angle, SCALE), QUIET if long else RULE, 1.5)
        if long and (target is None or math.cos(angle - target) < NEAR):
            canvas.text(f"{number(degrees, 'd')}°", point(angle, SCALE + 20), QUIET, 11, "center")


def draw_arm(canvas: Canvas, scene: Scene, length: float, gages: Sequence[float], exaggeration: float) -> None:
    """Draw target, hub, the hub's line and the beam with its gages.

    Args:
        canvas: to draw on.
        scene: to draw.
        length: of the beam, which the drawn length represents [m].
        gages: positions along the beam [m].
        exaggeration: factor on the deflection.
    """
    if scene.target is not None:
        _draw_target(canvas, scene.target)
    _draw_hub(canvas, scene)
    canvas.dashes(point(scene.hub_angle, HUB_RADIUS), point(scene.hub_angle, SCALE), QUIET, 1.5)
    scale = REACH / length

    def on_beam(stations: Matrix) -> Matrix:
        deflection = exaggeration * np.interp(stations, scene.stations, scene.deflection)
        return np.array([point(scene.hub_angle, scale * x, scale * v) for x, v in zip(stations, deflection, strict=True)])

    canvas.band(on_beam(scene.stations), BEAM_WIDTH, BEAM)
    for x, y in on_beam(np.asarray(gages, dtype=float)):
        canvas.mark((x, y))
    if exaggeration != 1.0:
        canvas.text(f"deflection × {exaggeration:g}", (TABLE[0] + 10, TABLE[1] + 14), INK, 12)


def _draw_target(canvas: Canvas, target: float) -> None:
    canvas.line(point(target, HUB_RADIUS), point(target, SCALE), TARGET, 1.5)
    canvas.polygon(np.array([point(target, SCALE - 1), point(target, SCALE + 9, 5), point(target, SCALE + 9, -5)]), TARGET)
    # A label left of the scale is right-aligned, one right of it left-aligned, which keeps both off the scale.
    side = math.cos(target)
    anchor = "center" if abs(side) < 0.3 else "midleft" if side > 0 else "midright"
    x, y = point(target, SCALE + (22 if anchor == "center" else 14), 10.0)
    canvas.text("target", (x, y), TARGET, 12, anchor)


def _draw_hub(canvas: Canvas, scene: Scene) -> None:
    """Draw the hub: round while it moves, clamped between labelled jaws while it sticks."""
    angle = scene.hub_angle
    if not scene.stuck:
        canvas.disc(HUB_AT, HUB_RADIUS, FREE)
        canvas.disc(HUB_AT, HUB_RADIUS - 4, PAPER)
        return
    corners = [(1, 1), (1, -1), (-1, -1), (-1, 1)]
    canvas.polygon(np.array([point(angle, (HUB_RADIUS + 2) * a, (HUB_RADIUS + 2) * b) for a, b in corners]), STUCK)
    canvas.text("sticks", point(angle, -48), STUCK, 13, "center")
