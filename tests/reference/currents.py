"""Currents that arms are tried with."""

from __future__ import annotations

import numpy as np

from reference.arm import Array


def pulse_current(seconds: float = 5.0, dt: float = 0.005, amperes: float = 3.0) -> Array:
    """The thesis's pulse [A]: on from 0.5 s to 1.0 s (section 3.1), one value per dt [s]."""
    time = dt * (np.arange(round(seconds / dt)) + 0.5)
    return np.where((time > 0.5) & (time < 1.0), amperes, 0.0)


def white_noise_current(seed: int, steps: int, sigma: float = 1.0) -> Array:
    """Gaussian current (steps,) [A] of standard deviation sigma [A], independent from step to step."""
    return np.random.default_rng(seed).normal(0.0, sigma, steps)
