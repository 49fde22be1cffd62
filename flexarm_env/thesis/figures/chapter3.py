"""Figures 3.1 and 3.5 to 3.10."""

from __future__ import annotations

from flexarm_env.thesis import chapter3, printed
from flexarm_env.thesis.chapter3 import after_pulse, clamped_pulse
from flexarm_env.thesis.frequency import over_time
from flexarm_env.thesis.runs import Floats, Run, clock
from flexarm_env.thesis.sheet import BEHIND, MAIN, OTHER, POINTS, SIGNAL, Curve, Panel, Sheet, panels

STAND_IN = "stand-in for the rig: six elements, gears"
#: Window and spacing [s] of the frequency over time; motion besides the vibration makes the estimate scatter.
WINDOW, EVERY = 0.3, 0.04
SPAN = (0.4, 4.0)


def sheets() -> list[Sheet]:
    """Build Figs. 3.1 and 3.5 to 3.10."""
    return [slew(), coulomb(), adjusted(), clamped(), combined(), damping(), payload()]


def slew() -> Sheet:
    """Fig. 3.1."""
    made = chapter3.slew()
    return Sheet(
        "3.1",
        "Second gage and speed under PD to 100°",
        [
            Panel(SIGNAL["strain"], [Curve(made.time, made.strain, "stand-in for the rig: six elements, gears, noise")]),
            Panel(SIGNAL["speed"], [Curve(made.time, made.speed, "stand-in for the rig: six elements, gears, noise")]),
        ],
    )


def coulomb() -> Sheet:
    """Fig. 3.5."""
    return _three("3.5", "Coulomb friction only", "coulomb", "printed")


def adjusted() -> Sheet:
    """Fig. 3.6."""
    return _three("3.6", "Coulomb friction only, J_m less 0.0003 kg m²", "lighter", "printed, lighter")


def _three(number: str, title: str, model: str, misprinted: str) -> Sheet:
    runs = [
        (after_pulse("stand-in"), STAND_IN, BEHIND),
        (after_pulse(misprinted), "M_T as printed", OTHER),
        (after_pulse(model), "consistent", MAIN),
    ]
    strain, speed = panels(runs, "strain", "speed")
    return Sheet(number, title, [strain, speed, _frequencies((runs[1], runs[2]), 10.0)], span=SPAN)


def clamped() -> Sheet:
    """Fig. 3.7."""
    printed, once = (clamped_pulse(hub) for hub in (chapter3.double_inertia(), chapter3.hub_inertia()))
    rig = after_pulse("combined")
    strain: list[Curve] = []
    speed: list[Curve] = []
    for signals, column in ((strain, 2), (speed, 1)):
        signals.append(Curve(rig.time, rig.strain if column == 2 else rig.speed, "combined model", BEHIND))
        signals.append(_column(once, column, "clamped model, arm counted once", OTHER))
        signals.append(_column(printed, column, "clamped model as printed", MAIN))
    return Sheet("3.7", "The clamped model alone", [Panel(SIGNAL["strain"], strain), Panel(SIGNAL["speed"], speed)], span=SPAN)


def combined() -> Sheet:
    """Fig. 3.8."""
    made = after_pulse("combined")
    runs = [(after_pulse("stand-in"), STAND_IN, BEHIND), (made, "combined model", MAIN)]
    strain, speed, angle = panels(runs, "strain", "speed", "angle")
    gage = Curve(made.time, printed.gage(made), "combined model, gage with +0.6 v as printed", OTHER)
    return Sheet(
        "3.8",
        "The combined model",
        [Panel(strain.label, [*strain.curves, gage]), speed, angle, _frequencies((runs[1],), 10.0)],
        span=SPAN,
    )


def damping() -> Sheet:
    """Fig. 3.9."""
    runs = [
        (after_pulse("combined"), "combined model", BEHIND),
        (after_pulse("damped"), "with 0.003 Nms in the beam", MAIN),
    ]
    return Sheet("3.9", "Damping in the beam", panels(runs, "strain", "speed"), span=SPAN)


def payload() -> Sheet:
    """Fig. 3.10."""
    runs = [
        (after_pulse("combined"), "without payload", BEHIND),
        (after_pulse("payload"), "300 g at the tip", MAIN),
    ]
    strain, speed = panels(runs, "strain", "speed")
    return Sheet("3.10", "A payload of 300 g", [strain, speed, _frequencies(runs, None)], span=(0.4, 5.0))


def _frequencies(runs: list[tuple[Run, str, str]] | tuple[tuple[Run, str, str], ...], rig: float | None) -> Panel:
    """Build the panel of the strain's frequency over time."""
    curves = []
    for made, label, role in runs:
        middle, found = over_time(made.time, made.strain, WINDOW, EVERY, (1.0, 13.0))
        curves.append(Curve(middle, found, label, POINTS if role == MAIN else role))
    lines = ((rig, "rig, moving"), (2.0, "rig, stuck")) if rig else ()
    return Panel("strain's frequency\n[Hz]", curves, (0.0, 12.0), lines=lines)


def _column(out: Floats, column: int, label: str, role: str) -> Curve:
    return Curve(clock(len(out)), out[:, column], label, role)
