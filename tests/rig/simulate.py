"""Run one experiment on the rig."""

from __future__ import annotations

import numpy as np
from truth_rig.kernel import run

from .experiments import Plan, plan, stream
from .settings import CONVERTER, STEP, make_beam, make_modes, make_par, make_sense, resolve

SIGNALS = ("arm_angle", "motor_speed", "strain_mid", "strain_base")
READINGS = (*SIGNALS, "tip_deflection")
TRUTHS = ("arm_angle", "motor_speed", "hub_speed", "strain_mid", "strain_base", "current", "energy")
SIGMA = np.array([2e-3, 0.03, 0.01, 0.01])  # [rad, rad/s, V, V]


def simulate(
    settings: dict[str, float],
    experiment: str | np.ndarray,
    seed: int,
    duration: float = 10.0,
    rate: float = 500.0,
    *,
    vary: bool = True,
    step: float = STEP,
) -> dict[str, np.ndarray]:
    """Run one experiment from rest at angle 0.

    Args:
        settings: names of the table of settings; the rest is the thesis's arm.
        experiment: "pulse", "square" or "sweep", or commands [A], one a sample, each held to the next.
        seed: makes noise, phases and (if `vary`) the sizes and times of the experiment.
        duration: [s]; an array of commands brings its own.
        rate: samples per second [Hz]. step: of the integrator [s].
        vary: False takes the practice recordings' sizes and times exactly.

    Returns:
        Arrays (n,): `time` [s], `current` (commands) [A], `arm_angle` [rad], `motor_speed` [rad/s], `strain_mid`,
        `strain_base` [V] as measured; `true_*` without noise and sensor faults: those four, `true_hub_speed`
        [rad/s], `true_current` (in the motor) [A] and `true_energy` [J].
    """
    n = round(duration * rate) if isinstance(experiment, str) else len(experiment)
    t = np.arange(n) / rate
    made = plan(experiment, t, seed, vary)
    v = resolve(settings)
    key = experiment if isinstance(experiment, str) else "array"
    noise = np.zeros((n, len(READINGS)))
    noise[:, : len(SIGNALS)] = v["noise"] * SIGMA * stream(seed, key, "noise").standard_normal((n, len(SIGNALS)))
    command, shown, truth = perform(settings, made, noise, rate, step=step)
    out = {"time": t, "current": command}
    out |= dict(zip(SIGNALS, shown.T, strict=False))
    return out | {f"true_{name}": column for name, column in zip(TRUTHS, truth.T, strict=True)}


def perform(
    settings: dict[str, float],
    plan: Plan,
    noise: np.ndarray,
    rate: float,
    *,
    steps: dict[str, float] = CONVERTER,
    step: float = STEP,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Run a plan of n samples on a machine of any size, from rest at angle 0.

    Args:
        settings: names of the table of settings; the rest is the thesis's arm.
        plan: feed, target and gains.
        noise: (n, 5), of READINGS, added before rounding.
        rate: samples per second [Hz].
        steps: of the converters, of angle [rad], speed [rad/s], strain [V] and tip [m].
        step: of the integrator [s].

    Returns:
        Commands (n,) [A or V], measurements (n, 5) of READINGS, and truth (n, 7) of TRUTHS.
    """
    v = resolve(settings)
    beam = make_beam(v)
    par = make_par(v, beam, rate, step)
    feed, target, gains = plan
    gains = (v["pd"] * gains[0], v["pd"] * gains[1], gains[2])
    return run(par, make_sense(v, par, steps), make_modes(v, beam, par["h"]), feed, target, gains, noise)
