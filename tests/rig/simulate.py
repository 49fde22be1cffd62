"""Run one experiment on the rig."""

from __future__ import annotations

import numpy as np
from truth_rig.kernel import run

from .experiments import plan, stream
from .settings import STEP, make_beam, make_modes, make_par, make_sense, resolve

SIGNALS = ("arm_angle", "motor_speed", "strain_mid", "strain_base")
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
    feed, target, gains = plan(experiment, t, seed, vary)
    v = resolve(settings)
    beam = make_beam(v)
    par = make_par(v, beam, rate, step)
    key = experiment if isinstance(experiment, str) else "array"
    noise = v["noise"] * SIGMA * stream(seed, key, "noise").standard_normal((n, 4))
    modal = make_modes(v, beam, par["h"])
    gains = (v["pd"] * gains[0], v["pd"] * gains[1], gains[2])
    command, shown, truth = run(par, make_sense(v, par), modal, feed, target, gains, noise)
    out = {"time": t, "current": command}
    out |= dict(zip(SIGNALS, shown.T, strict=True))
    return out | {f"true_{name}": column for name, column in zip(TRUTHS, truth.T, strict=True)}
