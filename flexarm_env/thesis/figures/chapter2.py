"""Figures 2.6 to 2.9."""

from __future__ import annotations

import numpy as np

from flexarm_env.thesis import chapter2
from flexarm_env.thesis.chapter2 import collision, flexible, rigid
from flexarm_env.thesis.runs import Run, clock
from flexarm_env.thesis.sheet import BEHIND, MAIN, OTHER, SIGNAL, THIRD, Curve, Panel, Sheet, panels

STAND_IN = "stand-in for the rig: flexible, six elements, noise"
#: Window around the second set-point step [s].
ZOOM = (chapter2.STEP - 0.02, chapter2.STEP + 0.16)


def sheets() -> list[Sheet]:
    """Build Figs. 2.6 to 2.9."""
    return [tracking(), jumps("2.7", False), jumps("2.8", True), strains()]


def tracking() -> Sheet:
    """Fig. 2.6."""
    slow, made, heavy = flexible(), rigid(gap=True), rigid(gap=True, printed=True)
    runs = [
        (slow, STAND_IN, BEHIND),
        (made, "rigid, backlash and friction", MAIN),
        (heavy, "rigid, J_a = 0.158 kg m² as printed", OTHER),
    ]
    angle, speed, current = panels(runs, "angle", "speed", "command")
    target = Curve(made.time, np.rad2deg(made.target), "set-point", THIRD)
    wrong = chapter2.misprinted_friction()
    friction = [angle.curves[1], Curve(wrong.time, wrong.angle, "rigid, b_s on the acceleration (eq. 2.3 as printed)", OTHER)]
    return Sheet(
        "2.6",
        "Set-point, position, motor speed and control effort under PD",
        [Panel(angle.label, [*angle.curves, target]), Panel(angle.label, friction), speed, current],
        note="The upper half of the thesis's figure is its rig, whose recording is not printed; a finer model stands in for it.",
    )


def jumps(number: str, rate: bool) -> Sheet:
    """Fig. 2.7, or with the current's rate limited Fig. 2.8."""
    slow, with_gap, without = flexible(rate), rigid(True, rate), rigid(False, rate)
    law = collision(True, rate)
    printed = collision(True, rate, printed=True)
    time = clock(len(law))
    whole = _speeds((with_gap, "rigid, backlash, teeth give way", MAIN), (without, "rigid, no backlash", OTHER))
    collided = Curve(time, law[:, 1], "rigid, backlash, collision of eq. 2.19", THIRD)
    as_printed = Curve(time, printed[:, 1], "collision, parting by eq. 2.22 as printed", OTHER)
    near = [_part(curve, ZOOM) for curve in (*whole, collided)]
    late = (3.0, 4.2)
    apart = [_part(curve, late) for curve in (as_printed, collided)]
    at = "rate of current limited to 50 A/s" if rate else "rate of current not limited"
    return Sheet(
        number,
        f"Motor speed with and without backlash, {at}",
        [
            Panel(SIGNAL["speed"], _speeds((slow, STAND_IN, BEHIND)), window=(0.0, 10.0)),
            Panel(SIGNAL["speed"], whole, window=(0.0, 10.0)),
            Panel("after the step\n[rad/s]", near, window=ZOOM),
            Panel("gears part\n[rad/s]", apart, window=late),
        ],
    )


def strains() -> Sheet:
    """Fig. 2.9."""
    made = flexible()
    signals = (("motor_speed", SIGNAL["speed"]), ("strain_base", "base gage [V]"), ("strain_mid", "second gage [V]"))
    return Sheet(
        "2.9",
        "Motor speed, base gage and second gage",
        [Panel(label, [Curve(made.time, made.signals[signal], STAND_IN, MAIN)]) for signal, label in signals],
        span=(0.0, 5.0),
        note="Of the rig in the thesis; here of the finer model that stands in for it.",
    )


def _speeds(*runs: tuple[Run, str, str]) -> list[Curve]:
    return [Curve(made.time, made.speed, label, role) for made, label, role in runs]


def _part(curve: Curve, span: tuple[float, float]) -> Curve:
    inside = (curve.x >= span[0]) & (curve.x < span[1])
    return Curve(curve.x[inside], curve.y[inside], curve.label, curve.role)
