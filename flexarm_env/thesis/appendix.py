"""Appendix A: constants from the thesis's printed measurements, or from the model's recordings where none are printed."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from flexarm_env.controllers import make_controller
from flexarm_env.thesis import arms
from flexarm_env.thesis.constants import (
    EXPERIMENT_1,
    EXPERIMENT_2,
    EXPERIMENT_3,
    MOTOR_COULOMB,
    MOTOR_VISCOUS,
    STATIC_MOTOR,
    STATIC_WHOLE,
    TABLE,
    WHOLE_COULOMB,
    WHOLE_VISCOUS,
)
from flexarm_env.thesis.runs import Floats, Run, clock, run, square_wave


@dataclass(frozen=True, eq=False)
class Line:
    """y = slope x + intercept, fitted by least squares, and its residual (samples,)."""

    slope: float
    intercept: float
    residual: Floats

    @classmethod
    def through(cls, x: Floats, y: Floats) -> Line:
        """Fit a line to points (samples,)."""
        slope, intercept = np.polyfit(x, y, 1)
        return cls(float(slope), float(intercept), y - slope * x - intercept)

    @property
    def rms(self) -> float:
        """Of the residual."""
        return float(np.sqrt(np.mean(self.residual**2)))


def proportional(x: Floats, y: Floats) -> Line:
    """Fit a line through the origin."""
    slope = float(x @ y / (x @ x))
    return Line(slope, 0.0, y - slope * x)


# Experiment 1: E over ω, the thesis's kφ


def back_emf() -> tuple[Floats, Floats]:
    """Read motor speed [rad/s] and E [V] of experiment 1 as printed."""
    return EXPERIMENT_1[:, 5], EXPERIMENT_1[:, 4]


def resistance_of_column() -> Floats:
    """Compute the armature resistance [ohm] implied by each row's E, V_a and I_a (erratum 9)."""
    return np.asarray((EXPERIMENT_1[:, 0] - EXPERIMENT_1[:, 4]) / (EXPERIMENT_1[:, 1] / 1000.0))


def motor_constants(resistance: float) -> Floats:
    """Compute kφ = E/ω [Vs/rad] of each row, with E = V_a − I_a R_a."""
    return np.asarray((EXPERIMENT_1[:, 0] - EXPERIMENT_1[:, 1] / 1000.0 * resistance) / EXPERIMENT_1[:, 5])


# Experiment 2: P/ω over ω


def power_balance() -> Line:
    """Fit P/ω = b ω + T_f [Nm] to experiment 2."""
    return Line.through(EXPERIMENT_2[:, 5], EXPERIMENT_2[:, 6])


# Experiment 3: the run-down


def inertia_from_stopping(speed: float, stop: float, viscous: float, coulomb: float) -> float:
    """Compute J [kg m²] from the time to stop [s] (Appendix A, eq. 1 with ω = 0)."""
    return viscous * stop / math.log1p(viscous * speed / coulomb)


def inertia_from_slope(speed: float, slope: float, viscous: float, coulomb: float) -> float:
    """Compute J [kg m²] from the initial slope [rad/s²], −(T_f + b ω_0)/J; the thesis omits T_f."""
    return -(coulomb + viscous * speed) / slope


def coulomb_from_stopping(speed: float, stop: float, viscous: float, inertia: float) -> float:
    """Compute T_f [Nm] from the time to stop [s] and J [kg m²] (Appendix A, eq. 1 with ω = 0)."""
    return viscous * speed / math.expm1(viscous * stop / inertia)


def run_down(speed: float, inertia: float, noise: float = 0.0, seed: int = 0) -> tuple[Floats, Floats]:
    """Simulate a run-down of the motor alone: time (samples,) [s] and speed (samples,) [rad/s].

    Args:
        speed: initial [rad/s].
        inertia: J [kg m²].
        noise: of the tachometer, standard deviation [rad/s].
        seed: of the noise.
    """
    made = run(arms.motor_alone(inertia), feed=np.zeros(1000), start=np.array([0.0, speed]))
    return made.time, made.speed + noise * np.random.default_rng(seed).standard_normal(len(made.time))


def fit_run_down(time: Floats, speed: Floats, coulomb: float) -> tuple[float, float]:
    """Fit b [Nms] and J [kg m²] to a whole run-down curve at a given T_f [Nm], the thesis's third method."""
    first = float(speed[0])

    def left(guess: Floats) -> Floats:
        viscous, inertia = guess
        curve = -coulomb / viscous + (first + coulomb / viscous) * np.exp(-viscous / inertia * time)
        return np.asarray(np.maximum(curve, 0.0) - speed)

    found = least_squares(left, [0.0005, 0.003], bounds=(1e-6, 1.0), x_scale=[1e-3, 1e-3], ftol=1e-12, xtol=1e-12)
    return float(found.x[0]), float(found.x[1])


def inertias(speed: float, inertia: float) -> dict[str, float]:
    """Compute J [kg m²] of a simulated run-down by the thesis's three methods, and by the slope with Coulomb torque."""
    time, curve = run_down(speed, inertia)
    stop = float(np.interp(0.0, -curve[: int(np.argmin(curve > 0.0)) + 1], time[: int(np.argmin(curve > 0.0)) + 1]))
    slope = float(np.polyfit(time[:20], curve[:20], 1)[0])
    b, T_f = MOTOR_VISCOUS, MOTOR_COULOMB
    return {
        "stopping time": inertia_from_stopping(speed, stop, b, T_f),
        "slope as printed": inertia_from_slope(speed, slope, b, 0.0),
        "slope with Coulomb torque": inertia_from_slope(speed, slope, b, T_f),
        "whole curve": fit_run_down(time, curve, T_f)[1],
    }


# Experiments 4 and 5, on recordings of the model


@functools.cache
def periodic(degrees: float) -> Run:
    """Run two periods of the combined model under the thesis's PD on a square wave of ± degrees [°]."""
    arm = arms.combined()
    return run(arm, make_controller("pd", arm, 0.001), target=square_wave(15.0) * degrees / 50.0)


def energy_point(made: Run, noise: float = 0.0, seed: int = 0) -> tuple[float, float]:
    """Compute ∫|ω|dt/∫ω²dt [s/rad] and ∫P dt/∫ω²dt [Nms] over the last period of 5 s, on the motor's side.

    Args:
        made: a periodic recording.
        noise: of the tachometer, standard deviation [rad/s].
        seed: of the noise.
    """
    last = made.between(made.time[-1] - 5.0, made.time[-1])
    speed = made.speed[last] + noise * np.random.default_rng(seed).standard_normal(len(made.speed[last]))
    # the current is held from each sample to the next, so the work is current times the angle over that interval
    way = np.diff(made.signals["arm_angle"][last], append=made.signals["arm_angle"][last.stop]) * TABLE["N"]
    power = TABLE["kphi"] * np.sum(made.command[last] * way) / 0.001
    square = np.sum(speed**2)
    return float(np.sum(np.abs(speed)) / square), float(power / square)


def energy_balance(noise: float = 0.0) -> Line:
    """Fit experiment 4's line to four simulated recordings: its slope is T_f [Nm], its intercept b [Nms], motor side."""
    points = np.array([energy_point(periodic(degrees), noise, int(degrees)) for degrees in (35.0, 50.0, 70.0, 90.0)])
    return Line.through(points[:, 0], points[:, 1])


def static_torque(rate: float = 0.05, threshold: float = 0.0, noise: float = 0.0) -> float:
    """Measure kφ times the current [Nm, motor side] at which the model's hub breaks away on a slow ramp (experiment 5).

    Args:
        rate: of the current [A/s].
        threshold: motor speed that counts as motion [rad/s].
        noise: of the tachometer [rad/s].
    """
    arm, interval = arms.combined(), 0.005
    feed = rate * clock(round(1.0 / rate / interval), interval)
    made = run(arm, feed=feed, interval=interval)
    shown = made.speed + noise * np.random.default_rng(0).standard_normal(len(made.speed))
    return float(TABLE["kphi"] * made.command[np.flatnonzero(np.abs(shown) > threshold)[0]])


# The split between motor and arm


def split() -> dict[str, float]:
    """Split friction between motor and arm (Appendix A, last section): Nm and Nms, each on its own side."""
    N = TABLE["N"]
    coulomb, viscous = MOTOR_COULOMB / (1.0 + 1.0 / N), MOTOR_VISCOUS / (1.0 + 1.0 / N**2)
    return {
        "T_mf": coulomb,
        "T_af": N * (WHOLE_COULOMB - round(coulomb, 3)),
        "b_m": viscous,
        "b_s": N**2 * (WHOLE_VISCOUS - round(viscous, 4)),
        "T_ms": STATIC_MOTOR,
        "T_as": N * (STATIC_WHOLE - STATIC_MOTOR),
    }


def rows_of_experiment_3() -> list[dict[str, float]]:
    """Evaluate each run-down of experiment 3: J by slope as printed and with T_f, T_f implied by that J, J by t_c."""
    b, T_f = MOTOR_VISCOUS, MOTOR_COULOMB
    found = []
    for speed, stop, slope, *_ in EXPERIMENT_3:
        printed = inertia_from_slope(speed, slope, b, 0.0)
        found.append(
            {
                "slope": printed,
                "coulomb": coulomb_from_stopping(speed, stop, b, printed),
                "slope_mended": inertia_from_slope(speed, slope, b, T_f),
                "stopping": inertia_from_stopping(speed, stop, b, T_f),
            }
        )
    return found
