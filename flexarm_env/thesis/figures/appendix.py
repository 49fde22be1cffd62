"""Figures A.1 to A.5: the experiments of Appendix A, printed in the thesis as tables, a line and three curves."""

from __future__ import annotations

import numpy as np

from flexarm_env.thesis import appendix, arms
from flexarm_env.thesis.constants import EXPERIMENT_2, EXPERIMENT_3, MOTOR_COULOMB, MOTOR_VISCOUS, TABLE
from flexarm_env.thesis.runs import clock, run
from flexarm_env.thesis.sheet import BEHIND, MAIN, OTHER, POINTS, SIGNAL, THIRD, Curve, Panel, Sheet

SPEED = "motor speed [rad/s]"


def sheets() -> list[Sheet]:
    """Build Figs. A.1 to A.5."""
    return [motor_constant(), power(), run_downs(), balance(), ramp()]


def motor_constant() -> Sheet:
    """Experiment 1."""
    speed, emf = appendix.back_emf()
    whole, line = appendix.proportional(speed, emf), appendix.Line.through(speed, emf)
    return Sheet(
        "A.1",
        "Experiment 1: kφ = E/ω falls with speed, since E has a constant drop",
        [
            Panel(
                "E/ω [Vs/rad]",
                [
                    Curve(speed, np.full(len(speed), whole.slope), "E = kφ ω", OTHER),
                    Curve(speed, line.slope + line.intercept / speed, "E = kφ ω + drop", MAIN),
                    Curve(speed, emf / speed, "measured, as printed", POINTS),
                ],
            ),
            Panel(
                "residual of E\n[mV]",
                [
                    Curve(speed, 1e3 * whole.residual, "E = kφ ω", OTHER),
                    Curve(speed, 1e3 * line.residual, "E = kφ ω + drop", MAIN),
                ],
                lines=((0.0, ""),),
            ),
        ],
        x=SPEED,
    )


def power() -> Sheet:
    """Experiment 2."""
    speed, ratio = EXPERIMENT_2[:, 5], EXPERIMENT_2[:, 6]
    line = appendix.power_balance()
    return Sheet(
        "A.2",
        "Experiment 2: P/ω = b ω + T_f, and how it bends",
        [
            Panel(
                "P/ω [Nm]",
                [
                    Curve(speed, line.slope * speed + line.intercept, "fitted line"),
                    Curve(speed, ratio, "measured, as printed", POINTS),
                ],
            ),
            Panel("residual\n[mNm]", [Curve(speed, 1e3 * line.residual, "measured, as printed", POINTS)], lines=((0.0, ""),)),
        ],
        x=SPEED,
    )


def run_downs() -> Sheet:
    """Experiment 3."""
    curves = []
    for speed, stop, slope, *_ in EXPERIMENT_3:
        time, curve = appendix.run_down(float(speed), TABLE["J_m"])
        shown = time < 0.9
        curves.append(Curve(time[shown], curve[shown], f"simulated, J = {TABLE['J_m']} kg m²", MAIN))
        early = np.array([0.0, 0.15])
        curves.append(Curve(early, speed + slope * early, "measured initial slope, as printed", THIRD))
        inertia = appendix.inertia_from_stopping(float(speed), float(stop), MOTOR_VISCOUS, MOTOR_COULOMB)
        time, curve = appendix.run_down(float(speed), inertia)
        curves.append(Curve(time[shown], curve[shown], "simulated, J from its time to stop", OTHER))
        curves.append(Curve(np.array([0.0, stop]), np.array([speed, 0.0]), "measured start and stop, as printed", POINTS))
    return Sheet("A.3", "Experiment 3: run-down of the motor alone", [Panel("speed [rad/s]", curves)])


def balance() -> Sheet:
    """Experiment 4."""
    points = np.array([appendix.energy_point(appendix.periodic(degrees)) for degrees in (35.0, 50.0, 70.0, 90.0)])
    line = appendix.energy_balance()
    ends = np.array([points[:, 0].min(), points[:, 0].max()])
    label = f"b = {line.intercept:.4f} Nms, T_f = {line.slope:.4f} Nm"
    panel = Panel(
        "∫P dt / ∫ω² dt\n[Nms]",
        [
            Curve(ends, line.intercept + line.slope * ends, label),
            Curve(points[:, 0], points[:, 1], "simulated square waves", POINTS),
        ],
    )
    return Sheet("A.4", "Experiment 4: energy balance over a period", [panel], x="∫|ω| dt / ∫ω² dt [s/rad]")


def ramp() -> Sheet:
    """Experiment 5."""
    arm = arms.combined()
    feed = 0.05 * clock(3000, 0.005)
    made = run(arm, feed=feed, interval=0.005)
    torque = TABLE["kphi"] * made.command
    static = appendix.static_torque()
    return Sheet(
        "A.5",
        "Experiment 5: the current rises until the hub breaks away",
        [
            Panel("kφ i [Nm]", [Curve(made.time, torque, "ramp of 0.05 A/s", BEHIND)], lines=((static, f"{static:.4f} Nm"),)),
            Panel(SIGNAL["speed"], [Curve(made.time, made.speed, "combined model", MAIN)]),
        ],
        span=(13.0, 15.0),
    )
