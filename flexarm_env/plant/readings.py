"""What the sensors read."""

from __future__ import annotations

from numba import njit

from flexarm_env.plant.laws import sensor_law
from flexarm_env.plant.layout import (
    BLOCKS,
    BODIES,
    DRIVERS,
    GEAR_RATIO,
    HEADER,
    HELD_HUB,
    HELD_MOTOR,
    MODE,
    OUTPUT,
    OUTPUT_DRIVERS,
    SENSOR_LAWS,
    SIGNALS,
    TIME,
    W_HELD_HUB,
    W_HELD_MOTOR,
    W_ONE,
    Numbers,
    Places,
)
from flexarm_env.plant.propagate import inlined_dot
from flexarm_env.plant.stick_slip import angle_of, record


@njit
def show(d: Numbers, n: Places, s: Numbers, out: Numbers, at: int) -> None:
    """Turn readings into what the sensors' laws make of them."""
    mode, place = int(s[MODE]), n[SENSOR_LAWS]
    angle = angle_of(d, n, s, mode, 0, s, HEADER)
    motor_angle = d[GEAR_RATIO] * angle_of(d, n, s, mode, n[BODIES] - 1, s, HEADER)
    for j in range(n[place]):
        law = place + 1 + 3 * j
        i = at + n[law + 2]
        out[i] = sensor_law(n[law], out[i], angle, motor_angle, s[TIME], d, n[law + 1])


@njit(forceinline=True)
def measure(d: Numbers, n: Places, s: Numbers, out: Numbers, at: int) -> None:
    """Write the readings, without noise, to out from `at` on."""
    here = record(n, int(s[MODE]))
    size = 2 * n[BLOCKS]
    for i in range(n[SIGNALS]):
        row = here + n[OUTPUT_DRIVERS] + i * n[DRIVERS]
        total = inlined_dot(d, here + n[OUTPUT] + i * size, s, HEADER, size) + d[row + W_ONE]
        out[at + i] = total + d[row + W_HELD_HUB] * s[HELD_HUB] + d[row + W_HELD_MOTOR] * s[HELD_MOTOR]
    if n[n[SENSOR_LAWS]] > 0:
        show(d, n, s, out, at)
