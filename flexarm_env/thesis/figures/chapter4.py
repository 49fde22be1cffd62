"""Figures 4.2 to 4.22."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexarm_env.thesis import chapter3, suppression
from flexarm_env.thesis.constants import CLAMPED_DELAY
from flexarm_env.thesis.runs import Run, clock
from flexarm_env.thesis.sheet import BEHIND, MAIN, OTHER, SIGNAL, THIRD, Curve, Panel, Sheet, panels
from flexarm_env.thesis.suppression import delayed, slew, stand_in, with_friction, without_friction

FREE = "without control"
NOISY = "stand-in for the rig: six elements, gears, noise"


def sheets() -> list[Sheet]:
    """Build Figs. 4.2 to 4.22."""
    return [
        *(clamped(number, delay) for number, delay in (("4.2", 0.0), ("4.3", CLAMPED_DELAY))),
        unstable(),
        saturated(),
        rig(),
        frictionless(),
        *after_pulses(),
        *slews(),
        comparison(),
        *experiments(),
    ]


def clamped(number: str, delay: float) -> Sheet:
    """Figs. 4.2 and 4.3."""
    double, once = chapter3.double_inertia(), chapter3.hub_inertia()
    runs = (
        (chapter3.clamped_control(double, 0.0), FREE, BEHIND),
        (chapter3.clamped_control(once, -1.0, delay), "K_mo = −1, arm counted once (diverges)", OTHER),
        (chapter3.clamped_control(double, -1.0, delay), "K_mo = −1, model as printed", MAIN),
    )
    # with the arm counted once the strain exceeds the panel: drawn while comparable to the others
    size = 1.5 * float(np.max(np.abs(runs[2][0][:, 2])))
    gone = int(np.argmax(np.abs(runs[1][0][:, 2]) > size))
    ends = (None, gone, None)
    found = []
    for column, name in ((2, "strain"), (1, "speed"), (3, "command")):
        curves = [
            Curve(clock(len(out))[:end], out[:end, column], label, role)
            for (out, label, role), end in zip(runs, ends, strict=True)
        ]
        found.append(Panel(SIGNAL[name], curves))
    return Sheet(number, f"Clamped model without friction, K_mo = −1, t_d = {delay:g} s", found, span=(0.0, 4.0))


def unstable() -> Sheet:
    """Fig. 4.4."""
    runs = [(delayed(limited=False), "K_mo = −1, t_d = 0.026 s", MAIN)]
    found = [Panel(p.label, p.curves, compressed=True) for p in panels(runs, "strain", "speed", "command")]
    return Sheet("4.4", "Pinned model with friction, current not limited (axes linear to ±1)", found)


def saturated() -> Sheet:
    """Fig. 4.5."""
    runs = [
        (delayed(limited=True, friction=False), "without dry friction", BEHIND),
        (delayed(limited=True), "K_mo = −1, t_d = 0.026 s", MAIN),
    ]
    return Sheet("4.5", "Pinned model, current limited to 5 A", panels(runs, "strain", "speed", "command"), span=(0.0, 3.0))


def rig() -> Sheet:
    """Fig. 4.6."""
    runs = [(suppression.stand_in_delayed(), NOISY, MAIN)]
    return Sheet(
        "4.6",
        "The same on the stand-in, second gage × K in place of M_o",
        panels(runs, "strain", "speed", "command"),
        span=(0.0, 3.0),
        note="Of the rig in the thesis.",
    )


def frictionless() -> Sheet:
    """Fig. 4.7."""
    runs = [
        (without_friction(0.0), FREE, BEHIND),
        (suppression.printed_torque(), "M_o of eq. 4.4 as printed", OTHER),
        (without_friction(-1.0), "K_mo = −1, t_d = 0", MAIN),
    ]
    return Sheet("4.7", "Pinned model without dry friction", panels(runs, "strain", "speed", "command"), span=(0.0, 4.0))


def after_pulses() -> list[Sheet]:
    """Figs. 4.8 to 4.14."""
    free, helped = (with_friction(0.0, 0.0), FREE, BEHIND), "with friction compensation"
    made = [
        ("4.8", "K_mo = −1, t_d = 0, with friction", [(with_friction(-1.0, -1.0), "K_mo = −1", MAIN)]),
        ("4.9", "K_mo = −1, t_d = 0, compensation at low speed", [(with_friction(-1.0, -1.0, True), helped, MAIN)]),
        ("4.10", "K_mo = +1, t_d = 0, with friction", [(with_friction(1.0, 1.0), "K_mo = +1", MAIN)]),
        ("4.11", "K_mo = +1, t_d = 0, compensation at low speed", [(with_friction(1.0, 1.0, True), helped, MAIN)]),
        ("4.12", "K_mo at low speed only", _low(False)),
        ("4.13", "K_mo at low speed only, with compensation", _low(True)),
        (
            "4.14",
            "Combined: K_mo = −1 at high speed, +1 and compensation at low",
            [
                (with_friction(-1.0, 1.0, True), "current limited to 5 A", OTHER),
                (with_friction(-1.0, 1.0, True, limited=False), "current not limited", MAIN),
            ],
        ),
    ]
    return [
        Sheet(number, title, panels([free, *runs], "strain", "speed", "command"), span=(0.0, 4.0)) for number, title, runs in made
    ]


def _low(compensation: bool) -> list[tuple[Run, str, str]]:
    return [
        (with_friction(0.0, -1.0, compensation), "K_mo = −1 as the caption has it", OTHER),
        (with_friction(0.0, 1.0, compensation), "K_mo = +1 as the text has it", MAIN),
    ]


SLEWS = {
    "4.15": ("pd", "PD alone"),
    "4.16": ("vibration_dual", "PD and combined controller"),
    "4.17": ("vibration_low", "PD and suppression at low speed only"),
    "4.18": ("vibration_high", "PD and suppression at high speed only"),
}


def slews() -> list[Sheet]:
    """Figs. 4.15 to 4.18."""
    alone = (slew("pd"), SLEWS["4.15"][1], BEHIND)
    return [_slew(number, slew(name), words, () if name == "pd" else (alone,)) for number, (name, words) in SLEWS.items()]


def _slew(number: str, made: Run, words: str, behind: Sequence[tuple[Run, str, str]] = ()) -> Sheet:
    angle, *rest = panels([*behind, (made, words, MAIN)], "angle", "speed", "strain", "command")
    target = Curve(made.time, np.rad2deg(made.target), "set-point", THIRD)
    return Sheet(number, f"100°: {words}", [Panel(angle.label, [*angle.curves, target]), *rest])


def comparison() -> Sheet:
    """Fig. 4.19."""
    alone = slew("pd")
    found = [
        Panel("strain [V]", [Curve(alone.time, alone.strain, "PD alone", BEHIND), Curve(made.time, made.strain, words, role)])
        for made, words, role in ((slew(name), words, MAIN) for name, words in list(SLEWS.values())[1:])
    ]
    looks = (MAIN, OTHER, THIRD)
    shown = [Panel(p.label, [p.curves[0], _as(p.curves[1], look)], (-0.5, 0.5)) for p, look in zip(found, looks, strict=True)]
    return Sheet("4.19", "Strain under the four, from 0.8 s on", shown, span=(0.8, 5.0))


def _as(curve: Curve, role: str) -> Curve:
    return Curve(curve.x, curve.y, curve.label, role)


def experiments() -> list[Sheet]:
    """Figs. 4.20 to 4.22."""
    alone, practical = stand_in("pd"), stand_in("vibration_practical")
    both = [(alone, "PD alone", BEHIND), (practical, "and suppression at high speed, gage × 1.18 A/V", MAIN)]
    strain = panels(both, "strain")[0]
    note = "Of the rig in the thesis; here of the finer model that stands in for it."
    sheets = [
        _slew("4.20", alone, "PD alone, on the stand-in"),
        _slew("4.21", practical, "practical choice, on the stand-in", both[:1]),
    ]
    last = Sheet(
        "4.22", "Strain under both, on the stand-in", [strain, Panel(strain.label, strain.curves, (-0.3, 0.3), window=(1.5, 5.0))]
    )
    return [Sheet(s.number, s.title, s.panels, s.x, s.span, note) for s in (*sheets, last)]
