"""Readings, command and legend beside the bench, and the strain's curve below it."""

from __future__ import annotations

import math

import numpy as np

from flexarm_env.plant.beam import Matrix
from flexarm_env.render.canvas import Canvas, number
from flexarm_env.render.scene import Scene
from flexarm_env.render.style import BEAM, COLUMN, FREE, INK, PANEL, PAPER, QUIET, RULE, STUCK, TARGET

SPAN = 5.0  # of the strain's curve [s]
LEAST_STRAIN = 0.2  # smallest half range of the strain's axis [V]


def draw_readings(canvas: Canvas, scene: Scene) -> None:
    """Write title, time, angles and deflection, and draw the command and the legend."""
    canvas.text(scene.title, (16, 20), INK, 14)
    canvas.text(f"{scene.time:.2f} s", (COLUMN[1], 20), INK, 14, "midright")
    left = COLUMN[0]
    target = "none" if scene.target is None else f"{number(math.degrees(scene.target), '.1f')}°"
    readings = [
        ("hub angle", f"{number(math.degrees(scene.hub_angle), '.1f')}°", INK),
        ("target", target, QUIET if scene.target is None else TARGET),
        ("tip deflection", f"{number(1e3 * scene.deflection[-1], '+.1f')} mm", BEAM),
        ("hub", "sticks" if scene.stuck else "moves", STUCK if scene.stuck else FREE),
    ]
    for row, (name, value, colour) in enumerate(readings):
        canvas.text(name, (left, 64 + 46 * row), QUIET, 11)
        canvas.text(value, (left, 82 + 46 * row), colour, 16)
    _draw_command(canvas, scene.command, top=252)
    _draw_legend(canvas, top=344)


def _draw_command(canvas: Canvas, command: float, top: float) -> None:
    left, right = COLUMN[0] + 4, COLUMN[1] - 4
    middle, half = (left + right) / 2, (right - left) / 2
    canvas.text("command", (COLUMN[0], top), QUIET, 11)
    canvas.text(f"{number(100 * command, '+.0f')} %", (COLUMN[1], top), INK, 12, "midright")
    canvas.box(left, top + 14, right - left, 16, RULE)
    canvas.box(left + 1, top + 15, right - left - 2, 14, PAPER)
    length = half * min(abs(command), 1.0)
    canvas.box(middle - length if command < 0.0 else middle, top + 16, length, 12, INK)
    for share, word in ((-1.0, "−limit"), (0.0, "0"), (1.0, "limit")):
        x = middle + half * share
        canvas.line((x, top + 10), (x, top + 34), QUIET, 1.5)
        anchor = {-1.0: "midleft", 0.0: "center", 1.0: "midright"}[share]
        canvas.text(word, (x, top + 42), QUIET, 11, anchor)


def _draw_legend(canvas: Canvas, top: float) -> None:
    left = COLUMN[0]
    middle = left + 12
    canvas.band(np.array([[left, top], [left + 24, top]]), 5, BEAM)
    canvas.dashes((left, top + 22), (left + 24, top + 22), QUIET, 1.5)
    canvas.mark((middle, top + 44))
    canvas.disc((middle, top + 66), 8, FREE)
    canvas.disc((middle, top + 66), 5, PAPER)
    canvas.box(middle - 8, top + 80, 16, 16, STUCK)
    for row, words in enumerate(("beam", "rigid beam", "strain gage", "hub moves", "hub sticks")):
        canvas.text(words, (left + 34, top + 22 * row), QUIET, 11)


def draw_strain(canvas: Canvas, scene: Scene) -> None:
    """Draw the curve of the base strain over the last seconds."""
    left, top, width, height = PANEL
    start = max(0.0, scene.time - SPAN)
    times, values = scene.trace
    shown = (times >= start) & (times <= start + SPAN)
    reach = _round_up(float(np.max(np.abs(values[shown]), initial=LEAST_STRAIN)))
    canvas.text("strain at the base [V]", (left, top - 13), INK, 12)
    canvas.text("time [s]", (left + width, top - 13), INK, 12, "midright")
    canvas.box(left, top, width, height, RULE)
    canvas.box(left + 1, top + 1, width - 2, height - 2, PAPER)
    for share, value in ((0.0, reach), (0.5, 0.0), (1.0, -reach)):
        canvas.line((left - 4, top + share * height), (left, top + share * height), QUIET)
        canvas.text(number(value, "+g"), (left - 7, top + share * height), QUIET, 11, "midright")
    canvas.line((left, top + height / 2), (left + width, top + height / 2), RULE)
    for second in range(math.ceil(start - 1e-9), math.floor(start + SPAN + 1e-9) + 1):
        x = left + width * (second - start) / SPAN
        canvas.line((x, top + height), (x, top + height + 4), QUIET)
        canvas.text(f"{second}", (x, top + height + 13), QUIET, 11, "center")
    canvas.curve(_in_panel(times[shown] - start, values[shown] / reach), BEAM)


def _in_panel(seconds: Matrix, shares: Matrix) -> Matrix:
    left, top, width, height = PANEL
    return np.column_stack([left + width * seconds / SPAN, top + height / 2 * (1.0 - shares)])


def _round_up(value: float) -> float:
    """Round up to the next of 1, 2, 3, 5, 7, 10, …, which keeps the axis from changing often."""
    power = 10.0 ** math.floor(math.log10(value))
    return power * next(step for step in (1, 2, 3, 5, 7, 10) if value <= step * power * (1 + 1e-9))
