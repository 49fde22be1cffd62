"""The evidence of a recording's first samples on its initial state, without a model."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.identify.replay.readings import errors_of, rms_of
from flexarm_env.identify.settings import InitialStates
from flexarm_env.sensors import known_sensors

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Start:
    """Evidence of the first samples on the initial state.

    Attributes:
        angle: of the hub [rad].
        speed: of the hub [rad/s].
        moving: true if the hub moves, so that angle and speed are fitted as well.
        vibrating: true if the beam vibrates.
        samples: length of the stretch to which the state is fitted.
        rest: angle of the hub [rad] if it was at rest after all.
    """

    angle: float
    speed: float
    moving: bool
    vibrating: bool
    samples: int
    rest: float


def find_start(
    time: Floats, command: Floats, measured: Floats, signals: list[str], noise: Floats, settings: InitialStates
) -> Start:
    """Read the evidence on the initial state from the first samples: at rest at zero wherever they allow it.

    Args:
        time: (samples,) [s], from 0.
        command: (samples,) [A or V].
        measured: (samples, signals), SI units; NaN where nothing was measured.
        signals: names of the columns.
        noise: (signals,) standard deviations.
        settings: thresholds.
    """
    undriven = int(np.flatnonzero(np.append(command, 1.0))[0]) + 1  # a sample is taken before its command acts
    begins = np.argmax(~np.isnan(measured), axis=0)
    early = time[begins] <= settings.held_time
    if early.all():
        found = _start(time, undriven, measured, signals, noise, settings)
    else:
        known = [signal for signal, is_early in zip(signals, early, strict=True) if is_early]
        found = _start(time, undriven, measured[:, early], known, noise[early], settings)
    if found.moving:  # it may have left since the first sample
        found = replace(found, rest=_angle_at_rest(measured[:1], signals, noise, settings))
    if "arm_angle" in signals and not early[signals.index("arm_angle")]:
        samples = int(np.searchsorted(time, time[begins[signals.index("arm_angle")]] + settings.longest_moving))
        return replace(found, moving=True, samples=max(found.samples, samples))
    return found


def _angle_at_rest(measured: Floats, signals: list[str], noise: Floats, settings: InitialStates) -> float:
    """Estimate the angle of a hub at rest from the first sample (1, signals): 0 where it allows it."""
    column = signals.index("arm_angle") if "arm_angle" in signals else 0
    angle = float(measured[0, column])
    return angle if "arm_angle" in signals and abs(angle) >= settings.at_zero * noise[column] else 0.0


def _start(time: Floats, undriven: int, measured: Floats, signals: list[str], noise: Floats, settings: InitialStates) -> Start:
    """Read the evidence on the initial state from signals that were measured at the start.

    Of a held hub, the samples before the first command alone count where these are enough: the rest is no motion at the start.
    """
    interval = time[1] - time[0]
    beam = np.array(["beam" in known_sensors()[s].needs for s in signals], dtype=bool)
    angle, speed, still = _hub(time, measured, signals, noise, settings)
    moving = speed != 0.0
    still = min(still, undriven) if undriven * interval >= settings.held_time else still
    held = still * interval >= settings.held_time
    if held:
        vibrating = bool(np.any((_scatter(measured[:still]) > settings.vibrates * noise)[beam]))
    else:
        first = _means(measured[: max(2, int(settings.first_time / interval))])
        vibrating = bool(np.any((np.abs(first) > settings.significant * noise)[beam]))
    longest = max(int((settings.longest_held if held else settings.longest_moving) / interval), settings.fewest)
    samples = min(longest, still) if held else min(longest, len(time))
    return Start(angle, speed, moving, vibrating, samples, angle)


def _hub(time: Floats, measured: Floats, signals: list[str], noise: Floats, settings: InitialStates) -> tuple[float, float, int]:
    """Estimate angle and speed of the hub at the start, and count the samples for which it is still."""
    if "arm_angle" not in signals:
        return 0.0, _speed_alone(measured, signals, noise, settings), 0
    column = signals.index("arm_angle")
    angle, sigma = measured[:, column], noise[column]
    leaves = np.abs(angle - _first(angle).mean()) > settings.still * sigma
    turns = rests = False
    there = ~np.isnan(angle)
    if "motor_speed" in signals:
        tach = signals.index("motor_speed")
        leaves |= np.abs(measured[:, tach]) > settings.significant * noise[tach]
        turns = abs(_first(measured[:, tach]).mean()) > settings.significant * noise[tach]
        rests = bool(abs(_first(measured[:, tach])[0]) < settings.at_rest * noise[tach])
        there |= ~np.isnan(measured[:, tach])
    still = _samples_before(leaves, there)
    rows = np.flatnonzero(~np.isnan(angle))[: settings.first_samples]
    if still <= rows[-1] and not rests:  # curved, since an arm that is driven at once moves too
        fit, spread = np.polyfit(time[rows], angle[rows], 2, cov="unscaled")
        if turns or abs(fit[1]) > settings.significant * sigma * np.sqrt(spread[1, 1]):
            return float(fit[2]), float(fit[1]), 0
    before = max(still // 2, 1)
    at_zero = abs(_first(angle, min(before, 3)).mean()) < settings.at_zero * sigma
    return 0.0 if at_zero else float(_first(angle, before).mean()), 0.0, still


def _first(values: Floats, rows: int = 3) -> Floats:
    """Select the readings of a signal (samples,) in its first rows; where there are none yet, the first one."""
    there = np.flatnonzero(~np.isnan(values))
    return values[there[: max(int(np.searchsorted(there, rows)), 1)]]


def _samples_before(leaves: NDArray[np.bool_], there: NDArray[np.bool_]) -> int:
    """Count the samples up to the last reading before the first one that leaves; all of them where none does."""
    if not leaves.any():
        return len(leaves)
    before = np.flatnonzero(there[: np.argmax(leaves)])
    return int(before[-1]) + 1 if before.size else 0


def _means(measured: Floats) -> Floats:
    """Compute the mean (signals,) of the readings; 0 for a signal without any."""
    there = ~np.isnan(measured)
    return np.sum(measured, axis=0, where=there) / np.maximum(there.sum(axis=0), 1)


def _scatter(measured: Floats) -> Floats:
    """Compute the standard deviation (signals,) of the readings; 0 for a signal without any."""
    return rms_of(errors_of(measured, _means(measured)), measured)


def _speed_alone(measured: Floats, signals: list[str], noise: Floats, settings: InitialStates) -> float:
    """Estimate the initial speed without an angle sensor: the motor's, until the state is fitted."""
    if "motor_speed" not in signals:
        return 0.0
    tach = signals.index("motor_speed")
    first = _first(measured[:, tach])
    mean = float(first.mean())
    rests = abs(first[0]) < settings.at_rest * noise[tach] or abs(mean) < settings.significant * noise[tach]
    return 0.0 if rests else mean
