"""Rows T1 and T2: the constants of Appendix A."""

from __future__ import annotations

import numpy as np

from flexarm_env.thesis import appendix
from flexarm_env.thesis.claims.claim import Claim, Part
from flexarm_env.thesis.constants import (
    EXPERIMENT_3,
    MOTOR_COULOMB,
    MOTOR_VISCOUS,
    STATIC_WHOLE,
    TABLE,
    WHOLE_COULOMB,
    WHOLE_VISCOUS,
)


def constants() -> Claim:
    """T1."""
    return Claim(
        "T1",
        "Appendix A",
        "kφ ≈ 0.33 Vs/rad; b = 0.0011 Nms and T_f = 0.1152 Nm from P/ω; J = 0.00177, 0.001745, 0.001848 kg m² from the "
        "times to stop; b, T_f and T_s split between motor and arm.",
        [_motor_constant(), _power(), _stopping(), _slope(), _split()],
        "the printed measurements give the printed constants, but for the inertia by the initial slope: its equation "
        "lacks the Coulomb torque, and with it the method that the thesis gives up agrees with the other. Two residuals "
        "show what the motor's model lacks: E has a constant drop, and P/ω bends.",
        ("A.1", "A.2", "A.3"),
    )


def _motor_constant() -> Part:
    speed, emf = appendix.back_emf()
    whole, line = appendix.proportional(speed, emf), appendix.Line.through(speed, emf)
    mean = float(np.mean(emf / speed))
    numbers = {
        "kφ mean [Vs/rad]": mean,
        "kφ with drop [Vs/rad]": line.slope,
        "drop [V]": line.intercept,
        "residual without drop [mV]": 1e3 * whole.rms,
        "residual with drop [mV]": 1e3 * line.rms,
    }
    words = (
        f"kφ = {mean:.4f} Vs/rad; with a constant drop of {line.intercept:.3f} V it is {line.slope:.4f}, and the residual "
        f"falls from {1e3 * whole.rms:.0f} to {1e3 * line.rms:.0f} mV rms"
    )
    return Part(words, abs(mean - 0.33) < 0.002, numbers)


def _power() -> Part:
    line = appendix.power_balance()
    ends, middle = line.residual[[0, -1]], line.residual[2:-2].mean()
    numbers = {"b [Nms]": line.slope, "T_f [Nm]": line.intercept, "residual first [Nm]": ends[0], "residual last [Nm]": ends[1]}
    words = (
        f"b = {line.slope:.5f} Nms, T_f = {line.intercept:.4f} Nm; the residual is negative at both ends "
        f"({1e3 * ends[0]:.1f} and {1e3 * ends[1]:.1f} mNm) and {1e3 * middle:.1f} mNm on average between"
    )
    return Part(words, abs(line.slope - 0.0011) < 5e-5 and abs(line.intercept - 0.1152) < 5e-5, numbers)


def _stopping() -> Part:
    found = np.array([row["stopping"] for row in appendix.rows_of_experiment_3()])
    numbers = {f"J by stopping {i + 1} [kg m²]": value for i, value in enumerate(found)}
    words = f"J = {', '.join(f'{value:.6f}' for value in found)} kg m² from the times to stop"
    return Part(words, bool(np.all(np.abs(found / EXPERIMENT_3[:, 5] - 1.0) < 1e-3)), numbers)


def _slope() -> Part:
    rows = appendix.rows_of_experiment_3()
    printed, mended = (np.array([row[key] for row in rows]) for key in ("slope", "slope_mended"))
    made = appendix.inertias(float(EXPERIMENT_3[0, 0]), TABLE["J_m"])
    numbers = {f"J by slope {i + 1} [kg m²]": value for i, value in enumerate(printed)}
    numbers |= {f"J by slope with T_f {i + 1} [kg m²]": value for i, value in enumerate(mended)}
    numbers |= {f"simulated J by {key} [kg m²]": value for key, value in made.items()}
    words = (
        f"the slopes give {', '.join(f'{v:.6f}' for v in printed)} kg m² as printed and "
        f"{', '.join(f'{v:.6f}' for v in mended)} with T_f in the equation; on a simulated run-down of J = {TABLE['J_m']} "
        f"the three methods give {made['stopping time']:.6f}, {made['slope as printed']:.6f} "
        f"({made['slope with Coulomb torque']:.6f} mended) and {made['whole curve']:.6f}"
    )
    return Part(words, bool(np.all(np.abs(printed / TABLE["J_m"] - 1.0) < 0.1)), numbers)


def _split() -> Part:
    found = appendix.split()
    numbers = {f"{key} [{'Nms' if key.startswith('b') else 'Nm'}]": value for key, value in found.items()}
    words = (
        f"motor {found['T_mf']:.3f} Nm, {found['b_m']:.5f} Nms, {found['T_ms']:.5f} Nm at rest; arm {found['T_af']:.3f} "
        f"Nm, {found['b_s']:.4f} Nms, {found['T_as']:.5f} Nm at rest"
    )
    close = {key: abs(value / TABLE[key] - 1.0) < (0.05 if key == "b_m" else 2e-3) for key, value in found.items()}
    return Part(words, all(close.values()), numbers)


def whole_arm() -> Claim:
    """T2."""
    line, noisy, static = appendix.energy_balance(), appendix.energy_balance(noise=0.03), appendix.static_torque()
    balance = Part(
        f"the energy balance over a period of four simulated square waves gives b = {line.intercept:.5f} Nms and T_f = "
        f"{line.slope:.5f} Nm; with a tachometer's noise of 0.03 rad/s, {noisy.intercept:.4f} and {noisy.slope:.4f}",
        abs(line.intercept - WHOLE_VISCOUS) < 1e-4 and abs(line.slope - WHOLE_COULOMB) < 1e-4,
        {
            "b [Nms]": line.intercept,
            "T_f [Nm]": line.slope,
            "b, noisy [Nms]": noisy.intercept,
            "T_f, noisy [Nm]": noisy.slope,
        },
    )
    ramp = Part(
        f"on a ramp of 0.05 A/s the hub breaks away at {static:.4f} Nm",
        abs(static - STATIC_WHOLE) < 3e-4,
        {"static [Nm]": static},
    )
    return Claim(
        "T2",
        "Appendix A, experiments 4 and 5",
        "A periodic energy balance gives b = 0.0452 Nms and T_f = 0.188 Nm of the whole arm; a slow ramp of current gives "
        "the static 0.2387 Nm (motor side).",
        [balance, ramp],
        "over a period hub and beam give back what they took, so the vibration does not disturb the balance; noise does, "
        f"since |ω| and ω² of a resting hub then are not zero (motor alone: b = {MOTOR_VISCOUS}, T_f = {MOTOR_COULOMB}).",
        ("A.4", "A.5"),
    )
