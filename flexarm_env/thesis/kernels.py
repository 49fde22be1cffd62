"""Compiled loops of the reproduction.

They share no file with other code: numba's cache detects edits of this file only, and so is never out of date.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numba import float64, int64, njit, types

#: Duration of the pulse [s], thesis sections 3.4 and 4.
PULSE_LENGTH = 0.5
# places in the numbers of a law
_PULSE_START, _PULSE, _TARGET, _P, _D, _HIGH, _LOW, _LOW_SPEED, _EXTRA, _LIMIT, _KPHI = range(11)

_NUMBERS, _PLACES, _ROWS = types.Array(float64, 1, "C"), types.Array(int64, 1, "C"), types.Array(float64, 2, "C")
# The plant's kernels are passed as addresses: none is compiled in, so numba's cache of the loop is never stale.
_MEASURE = types.FunctionType(types.none(_NUMBERS, _PLACES, _NUMBERS, _NUMBERS, int64))
_LET_THROUGH = types.FunctionType(float64(_NUMBERS, _PLACES, _NUMBERS, float64))
_CONTROL_STEP = types.FunctionType(types.none(_NUMBERS, _PLACES, _NUMBERS, float64, float64, _NUMBERS))


class LawArrays(NamedTuple):
    """A law of the current: its numbers, and stored values of M_o [Nm]."""

    numbers: Any
    past: Any


class PlantArrays(NamedTuple):
    """A plant's constants, offsets in its arrays, state and scratch space."""

    constants: Any
    offsets: Any
    state: Any
    scratch: Any


class Beam(NamedTuple):
    """A one-element beam on a hub: inverses of its whole and clamped mass, and the forces on it.

    `inverse`, `clamped_inverse`, `damping` and `stiffness` are (3, 3), in hub angle and tip motion. `hub_row` (the hub's row of
    the mass), `moment` [Nm] and `strain` [V] are (3,).
    """

    inverse: Any
    clamped_inverse: Any
    hub_row: Any
    damping: Any
    stiffness: Any
    moment: Any
    strain: Any


_LAW = types.NamedUniTuple(_NUMBERS, 2, LawArrays)
_PLANT = types.NamedTuple((_NUMBERS, _PLACES, _NUMBERS, _NUMBERS), PlantArrays)
_PLAY = int64(_MEASURE, _LET_THROUGH, _CONTROL_STEP, _PLANT, _LAW, _NUMBERS, int64, _ROWS)


@njit(cache=True, error_model="numpy")
def current(numbers, past, k, time, angle, speed, torque):  # type: ignore[no-untyped-def]
    """Compute the current [A] at step k from arm angle [rad], motor speed [rad/s] and M_o [Nm]; past stores M_o."""
    start = numbers[_PULSE_START]
    amps = numbers[_PULSE] if start - 1e-9 <= time < start + PULSE_LENGTH - 1e-9 else 0.0
    amps += numbers[_P] * (numbers[_TARGET] - angle) - numbers[_D] * speed
    slow = abs(speed) < numbers[_LOW_SPEED]
    if numbers[_HIGH] != 0.0 or numbers[_LOW] != 0.0:
        past[k % past.shape[0]] = torque
        late = past[(k + 1) % past.shape[0]]
        amps += (numbers[_LOW] if slow else numbers[_HIGH]) * late / numbers[_KPHI]
    if slow and speed != 0.0:
        amps += numbers[_EXTRA] if speed > 0.0 else -numbers[_EXTRA]
    return min(max(amps, -numbers[_LIMIT]), numbers[_LIMIT])


@njit(cache=True, error_model="numpy")
def march(beam, friction, law, step, stride, out):  # type: ignore[no-untyped-def]
    """Fill out (samples, 5) by a semi-implicit Euler step: speeds first, then angles with the new speeds."""
    gears, kphi, coulomb, static = friction
    inverse, clamped, hub_row = beam.inverse, beam.clamped_inverse, beam.hub_row
    damping, stiffness, moment, strain = beam.damping, beam.stiffness, beam.moment, beam.strain
    q, u, a, force = np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)
    stuck, side = True, 1.0
    for k in range(out.shape[0] * stride):
        torque = moment[0] * q[0] + moment[1] * q[1] + moment[2] * q[2]
        amps = current(law.numbers, law.past, k, k * step, q[0], gears * u[0], torque)
        if k % stride == 0:
            row = k // stride
            out[row, 0], out[row, 1], out[row, 3], out[row, 4] = q[0], gears * u[0], amps, 1.0 if stuck else 0.0
            out[row, 2] = strain[0] * q[0] + strain[1] * q[1] + strain[2] * q[2]
        for i in range(3):
            pull = stiffness[i, 0] * q[0] + stiffness[i, 1] * q[1] + stiffness[i, 2] * q[2]
            force[i] = -pull - damping[i, 0] * u[0]
        force[0] += gears * kphi * amps
        if stuck:
            a[1] = clamped[1, 1] * force[1] + clamped[1, 2] * force[2]
            a[2] = clamped[2, 1] * force[1] + clamped[2, 2] * force[2]
            hold = force[0] - hub_row[1] * a[1] - hub_row[2] * a[2]
            if abs(hold) > static:
                stuck, side = False, 1.0 if hold > 0.0 else -1.0
        if stuck:
            a[0] = 0.0
        else:
            force[0] -= side * coulomb
            for i in range(3):
                a[i] = inverse[i, 0] * force[0] + inverse[i, 1] * force[1] + inverse[i, 2] * force[2]
        for i in range(3):
            u[i] += step * a[i]
        if not stuck and u[0] * side < 0.0:
            u[0], stuck = 0.0, True
        for i in range(3):
            q[i] += step * u[i]


@functools.cache
def player() -> Callable[..., int]:
    """Compile `play`."""
    compiled: Callable[..., int] = njit([_PLAY], error_model="numpy", cache=True)(play)
    return compiled


def play(
    measure: Any, drive_output: Any, control_step: Any, plant: Any, law: Any, settings: Any, stride: Any, out: Any
) -> Any:  # fmt: skip
    """Fill out (samples, signals + 2) with readings, current and stuck flag; return the number of samples filled.

    Args:
        measure: of the plant's kernel, as are drive_output and control_step.
        drive_output: see above.
        control_step: see above.
        plant: its arrays.
        law: of the current.
        settings: M_o per volt of the base gage [Nm/V], step [s], motor speed at which the run counts as diverged [rad/s],
            offsets of the last command and of the mode in the state.
        stride: steps from one sample to the next.
        out: array to fill.
    """
    d, n, s, w = plant.constants, plant.offsets, plant.state, plant.scratch
    last = out.shape[1] - 2
    shown = np.zeros(last)
    per_strain, step, run_away = settings[0], settings[1], settings[2]
    command, mode = int(settings[3]), int(settings[4])
    for k in range(out.shape[0] * stride):
        measure(d, n, s, shown, 0)
        if not abs(shown[1]) < run_away:
            return k // stride
        amps = current(law.numbers, law.past, k, k * step, shown[0], shown[1], per_strain * shown[3])
        if k % stride == 0:
            out[k // stride, :last] = shown
            out[k // stride, last] = amps
            out[k // stride, last + 1] = int(s[mode]) & 1
        before = s[command]
        control_step(d, n, s, before, drive_output(d, n, s, amps), w)
    return out.shape[0]
