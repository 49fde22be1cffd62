"""Steady-state Kalman gains, one for each mode of the plant, that nudge a replay towards the measurements."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from flexarm_env.plant.plant import Plant

Floats = NDArray[np.float64]

#: Energy that process noise gives every coordinate, over what the torque noise gives the hub.
SHARE_OF_ALL = 0.05
DOUBLINGS = 14
#: A feedback that would let errors grow by more than this in a sample is dropped.
UNSTABLE = 1.0001


def physical_gains(plant: Plant, noise: Floats, torque_noise: float, interval: float, held_drift: float) -> Floats:
    """Return gains (modes, states, signals) from readings' errors to the state [q, q̇, extra].

    Args:
        plant: a compiled arm.
        noise: (signals,) standard deviation of the readings.
        torque_noise: standard deviation of a torque on the hub, new in each sample [Nm].
        interval: sampling time [s].
        held_drift: of a held angle in one sample, over the noise of its sensor.
    """
    gains = np.zeros((plant.modes, plant.states, len(noise)))
    for mode in range(plant.modes):
        gains[mode] = _gain(plant, mode, noise, torque_noise, interval, held_drift)
    return gains


def innovation_sigma(plant: Plant, noise: Floats, torque_noise: float, interval: float) -> Floats:
    """Return (signals,), the standard deviation that a moving arm's innovations have if the noises are as stated."""
    transition, process = _process(plant, 0, noise, torque_noise, interval)
    output = plant.model.output
    covariance = _riccati(transition, output, process, noise)
    return np.asarray(np.sqrt(np.diag(output @ covariance @ output.T) + noise**2), dtype=np.float64)


def modal_gains(plant: Plant, physical: Floats) -> Floats:
    """Return gains (modes, 2 blocks + bodies, signals) for the kernel, from physical ones."""
    size = 2 * plant.blocks
    gains = np.zeros((plant.modes, size + plant.bodies, physical.shape[2]))
    for mode in range(plant.modes):
        gains[mode, :size] = plant.to_modal(mode) @ physical[mode]
        for body in range(plant.bodies):
            if (mode >> body) & 1:
                gains[mode, size + body] = physical[mode, body]
    return gains


def _process(
    plant: Plant, mode: int, noise: Floats, torque_noise: float, interval: float, held_drift: float = 0.0
) -> tuple[Floats, Floats]:
    """Return (states, states), what a sample makes of the state, and the covariance that noise adds to it."""
    transition, push = plant.transition(mode, interval)
    model = plant.model
    size = len(model.names)
    held = [body for body in range(plant.bodies) if (mode >> body) & 1]
    impulse = torque_noise * interval
    process = np.zeros((plant.states, plant.states))
    mobility = np.linalg.inv(model.mass)
    mobility[held] = 0.0
    mobility[:, held] = 0.0
    hub = np.linalg.inv(model.mass)[0, 0]
    process[size : 2 * size, size : 2 * size] = SHARE_OF_ALL * impulse**2 * hub * mobility
    process += torque_noise**2 * np.outer(push, push)
    for body in held:
        transition[body, body] = 1.0
        process[body, body] += (held_drift * noise[0]) ** 2
    process[2 * size :, 2 * size :] += np.eye(plant.states - 2 * size) * 1e-12
    return transition, process


def _gain(plant: Plant, mode: int, noise: Floats, torque_noise: float, interval: float, held_drift: float) -> Floats:
    transition, process = _process(plant, mode, noise, torque_noise, interval, held_drift)
    output = plant.model.output
    covariance = _riccati(transition, output, process, noise)
    seen = output @ covariance @ output.T + np.diag(noise**2)
    gain = np.asarray(np.linalg.solve(seen, output @ covariance).T, dtype=np.float64)
    if not np.isfinite(gain).all():
        return np.zeros_like(gain)
    closed = transition - transition @ gain @ output
    return gain if np.abs(np.linalg.eigvals(closed)).max() < UNSTABLE else np.zeros_like(gain)


def _riccati(transition: Floats, output: Floats, process: Floats, noise: Floats) -> Floats:
    """Solve the filter's Riccati equation by doubling (Chu, Fan, Lin, Wang, Int. J. Control 77 (2004) 767)."""
    a, h = transition.T.copy(), process.copy()
    g = output.T @ (output / noise[:, None] ** 2)
    eye = np.eye(len(a))
    for _ in range(DOUBLINGS):
        w = np.linalg.solve(eye + g @ h, np.hstack([a, g]))
        wa, wg = w[:, : len(a)], w[:, len(a) :]
        h_next = h + a.T @ h @ wa
        g = g + a @ wg @ a.T
        a = a @ wa
        h = 0.5 * (h_next + h_next.T)
    return h
