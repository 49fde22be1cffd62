"""Steady-state Kalman gains of the observer-corrected replay (innovations form), one for each mode of the plant."""

from __future__ import annotations

import math
from collections.abc import Hashable
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.run import Run
from flexarm_env.plant.plant import Plant

Floats = NDArray[np.float64]


def observer_gains(arm: Arm, plant: Plant, dataset: Dataset, torque_noise: float) -> Floats:
    """Compute physical gains (modes, states, signals) for an assumed torque noise [Nm].

    A held hub drifts slowly, so that its angle stays open to correction. The drift follows the arm's size in coarse steps, and
    not how hard it is driven.
    """
    numbers = dataset.settings.observers
    size = arm.constants["drive"]["torque_noise"] or numbers.size_steps ** round(
        math.log(dataset.scales["N*m"], numbers.size_steps)
    )
    held_drift = numbers.held_drift * min(torque_noise / size, 1.0)
    return physical_gains(plant, dataset, torque_noise, held_drift)


def physical_gains(plant: Plant, dataset: Dataset, torque_noise: float, held_drift: float) -> Floats:
    """Compute gains (modes, states, signals) from errors of the readings to the state [q, q̇, extra].

    Args:
        plant: a compiled arm.
        dataset: for the noise of the readings and the sampling time.
        torque_noise: standard deviation of a torque on the hub, new in each sample [Nm].
        held_drift: of a held angle in one sample, over the noise of its sensor.
    """
    of_data = (dataset.noise.tobytes(), dataset.shares.tobytes(), dataset.settings.observers)
    key = (plant.structure.key, plant.modes, plant.interval, *of_data)
    return _designed(key, torque_noise, held_drift, _Design(plant, dataset)).copy()


@dataclass(frozen=True)
class _Design:
    """What the gains of one linear arm are computed with, equal to any other: the key alone tells them apart."""

    plant: Plant = field(compare=False)
    dataset: Dataset = field(compare=False)


@lru_cache(maxsize=64)
def _designed(key: Hashable, torque_noise: float, held_drift: float, design: _Design) -> Floats:
    """Compute gains, cached: arms of which the laws alone differ share them."""
    plant, dataset = design.plant, design.dataset
    gains = np.zeros((plant.modes, plant.states, len(dataset.noise)))
    for mode in range(plant.modes):
        gains[mode] = _gain(plant, mode, dataset, torque_noise, held_drift)
    return gains


def innovation_sigma(plant: Plant, dataset: Dataset, torque_noise: float) -> Floats:
    """Compute the standard deviation (signals,) of a moving arm's innovations under the stated noises, if nothing is absent."""
    transition, process = _process(plant, 0, dataset, torque_noise)
    output, noise = plant.model.output, dataset.noise
    covariance = riccati(transition, output, process, noise, dataset.settings.observers.doublings)
    return np.asarray(np.sqrt(np.diag(output @ covariance @ output.T) + noise**2), dtype=np.float64)


def innovation_noise(plant: Plant, dataset: Dataset, gains: Floats) -> Floats:
    """Compute the standard deviation (signals,) of a moving arm's innovations under the noise of its readings alone.

    An observer that trusts its readings more than they deserve passes their noise on, and predicts the worse.

    Args:
        plant: a compiled arm.
        dataset: the recordings.
        gains: physical ones (modes, states, signals) of the observer.
    """
    transition, _ = _process(plant, 0, dataset, 0.0)
    ahead, output, noise = transition @ gains[0], plant.model.output, dataset.noise
    covariance = gathered((ahead * noise**2) @ ahead.T, transition - ahead @ output, dataset.settings.observers.doublings)
    passed_on = np.diag(output @ covariance @ output.T)
    return np.asarray(np.sqrt(np.maximum(passed_on, 0.0) + noise**2), dtype=np.float64)


def innovation_sigmas(plant: Plant, run: Run, dataset: Dataset, torque_noise: float, gains: Floats) -> Floats:
    """Compute those (samples, signals) of a run with absent readings, between which the uncertainty of the state grows.

    The covariance of the state's error is carried along in Joseph's form, which holds for any gains.

    Args:
        plant: a compiled arm.
        run: the recording.
        dataset: to which the run belongs.
        torque_noise: standard deviation of a torque on the hub, new in each sample [Nm].
        gains: physical ones (modes, states, signals) of the observer.
    """
    transition, process = _process(plant, 0, dataset, torque_noise)
    output, noise = plant.model.output, dataset.noise
    covariance = riccati(transition, output, process, noise, dataset.settings.observers.doublings)
    steps = {}
    variances = np.empty_like(run.measured)
    for k, there in enumerate(~np.isnan(run.measured)):
        variances[k] = np.diag(output @ covariance @ output.T) + noise**2
        key = there.tobytes()
        if key not in steps:
            gain = transition @ (gains[0] * there)
            steps[key] = transition - gain @ output, (gain * noise**2) @ gain.T + process
        ahead, added = steps[key]
        covariance = ahead @ covariance @ ahead.T + added
    return np.sqrt(variances)


def process_of_moving(plant: Plant, dataset: Dataset) -> tuple[Floats, Floats, Floats]:
    """Compute the transition of one sample of a moving arm, and its process covariance: that of 1 Nm on the hub, and the rest.

    Returns:
        Three matrices (states, states).
    """
    transition, rest = _process(plant, 0, dataset, 0.0)
    return transition, _process(plant, 0, dataset, 1.0)[1] - rest, rest


def steady_covariance(plant: Plant, dataset: Dataset, torque_noise: float, noise: Floats) -> Floats:
    """Compute the covariance (states, states) with which a steady-state filter predicts the state of a moving arm.

    Args:
        plant: a compiled arm.
        dataset: the recordings.
        torque_noise: standard deviation of a torque on the hub, new in each sample [Nm].
        noise: (signals,) standard deviations of the readings.
    """
    transition, process = _process(plant, 0, dataset, torque_noise)
    shared = noise / np.sqrt(dataset.shares)
    return riccati(transition, plant.model.output, process, shared, dataset.settings.observers.doublings)


def forecast_gains(plant: Plant, dataset: Dataset, torque_noise: float, noise: Floats) -> Floats:
    """Compute physical gains (modes, states, signals) of the filter that gives forecasts their states.

    A held angle follows its readings as fast as a moving one: it drifts in one sample by as much as that is corrected.
    """
    moving = steady_covariance(plant, dataset, torque_noise, noise)
    seen = plant.model.output @ moving @ plant.model.output.T + np.diag(noise**2)
    corrected = np.linalg.solve(seen, plant.model.output @ moving)
    drift = np.sqrt(np.maximum(np.diag(corrected.T @ seen @ corrected), 0.0))
    gains = np.zeros((plant.modes, plant.states, len(noise)))
    for mode in range(plant.modes):
        transition, process = _process(plant, mode, dataset, torque_noise)
        for body in _held(plant, mode):
            process[body, body] += drift[body] ** 2
        gains[mode] = _gain_of(transition, process, plant.model.output, noise, dataset)
    return gains


def gathered(added: Floats, transition: Floats, doublings: int) -> Floats:
    """Compute the covariance (states, states) that a disturbance leaves, by doubling.

    It exists for an arm that no reading corrects, too, where a Lyapunov equation has no solution.

    Args:
        added: covariance of the disturbance in one sample (states, states).
        transition: of one sample (states, states).
        doublings: most doublings of the time that is covered.
    """
    total, ahead = added, transition
    for _ in range(doublings):
        further = total + ahead @ total @ ahead.T
        if np.array_equal(further, total):
            break
        total, ahead = further, ahead @ ahead
    return total


def modal_gains(plant: Plant, physical: Floats) -> Floats:
    """Convert physical gains to those of the kernel (modes, 2 blocks + bodies, signals)."""
    size = 2 * plant.blocks
    gains = np.zeros((plant.modes, size + plant.bodies, physical.shape[2]))
    for mode in range(plant.modes):
        gains[mode, :size] = plant.to_modal(mode) @ physical[mode]
        for body in range(plant.bodies):
            if (mode >> body) & 1:
                gains[mode, size + body] = physical[mode, body]
    return gains


def _process(plant: Plant, mode: int, dataset: Dataset, torque_noise: float, held_drift: float = 0.0) -> tuple[Floats, Floats]:
    """Compute transition and process covariance of one sample, both (states, states)."""
    numbers, interval = dataset.settings.observers, dataset.interval
    transition, push = plant.transition(mode, interval)
    model = plant.model
    size = len(model.names)
    held = _held(plant, mode)
    impulse = torque_noise * interval
    process = np.zeros((plant.states, plant.states))
    mobility = np.linalg.inv(model.mass)
    mobility[held] = 0.0
    mobility[:, held] = 0.0
    hub = np.linalg.inv(model.mass)[0, 0]
    process[size : 2 * size, size : 2 * size] = numbers.hub_share * impulse**2 * hub * mobility
    process += torque_noise**2 * np.outer(push, push)
    for body in held:
        transition[body, body] = 1.0
        process[body, body] += (held_drift * dataset.noise[0]) ** 2
    process[2 * size :, 2 * size :] += np.eye(plant.states - 2 * size) * numbers.least_process
    return transition, process


def _held(plant: Plant, mode: int) -> list[int]:
    """List the bodies that are held in a mode."""
    return [body for body in range(plant.bodies) if (mode >> body) & 1]


def _gain(plant: Plant, mode: int, dataset: Dataset, torque_noise: float, held_drift: float) -> Floats:
    transition, process = _process(plant, mode, dataset, torque_noise, held_drift)
    return _gain_of(transition, process, plant.model.output, dataset.noise, dataset)


def _gain_of(transition: Floats, process: Floats, output: Floats, noise: Floats, dataset: Dataset) -> Floats:
    """Compute the steady-state gain (states, signals); zero where it would not be stable."""
    numbers = dataset.settings.observers
    # A signal that comes in a share of the samples tells as much as one in all of them with the noise that averages to its own.
    covariance = riccati(transition, output, process, noise / np.sqrt(dataset.shares), numbers.doublings)
    seen = output @ covariance @ output.T + np.diag(noise**2)
    gain = np.asarray(np.linalg.solve(seen, output @ covariance).T, dtype=np.float64)
    if not np.isfinite(gain).all():
        return np.zeros_like(gain)
    closed = transition - transition @ gain @ output
    return gain if np.abs(np.linalg.eigvals(closed)).max() < numbers.unstable else np.zeros_like(gain)


def riccati(transition: Floats, output: Floats, process: Floats, noise: Floats, doublings: int) -> Floats:
    """Compute the covariance (states, states) of a steady-state filter's predicted state, by doubling.

    It holds for states of any scale, where an ordered Schur form fails (Chu, Fan, Lin, Wang, Int. J. Control 77 (2004) 767).

    Args:
        transition: of one sample (states, states).
        output: readings of the states (signals, states).
        process: covariance of the disturbance in one sample (states, states).
        noise: (signals,) standard deviations of the readings.
        doublings: most doublings of the time that is covered.
    """
    a, h = transition.T.copy(), process.copy()
    g = output.T @ (output / noise[:, None] ** 2)
    eye = np.eye(len(a))
    for _ in range(doublings):
        w = np.linalg.solve(eye + g @ h, np.hstack([a, g]))
        wa, wg = w[:, : len(a)], w[:, len(a) :]
        h_next = h + a.T @ h @ wa
        h_next = 0.5 * (h_next + h_next.T)
        if np.array_equal(h_next, h):
            break
        g = g + a @ wg @ a.T
        a, h = a @ wa, h_next
    return h
