"""The readings of the sensors."""

from __future__ import annotations

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Numbers, Places, Segment
from flexarm_env.plant.forces import angle_of
from flexarm_env.plant.inner_product import inner_product
from flexarm_env.plant.laws import sensor_law
from flexarm_env.plant.modes import record


@njit
def apply_sensor_laws(d: Numbers, n: Places, s: Numbers, out: Numbers, first: int) -> None:
    """Apply the sensors' laws to readings."""
    mode, place = int(s[at.MODE]), n[at.SENSOR_LAWS]
    angle = angle_of(d, n, s, mode, n[at.HUB_BODY], Segment(s, at.Z_START))
    motor_angle = d[at.GEAR_RATIO] * angle_of(d, n, s, mode, n[at.BODIES] - 1, Segment(s, at.Z_START))
    for j in range(n[place]):
        law = place + 1 + 3 * j
        i = first + n[law + 2]
        out[i] = sensor_law(n[law], out[i], angle, motor_angle, s[at.TIME], d, n[law + 1])


@njit(forceinline=True)
def measure(d: Numbers, n: Places, s: Numbers, out: Numbers, first: int) -> None:
    """Write the readings, without noise, to out from `first` on."""
    here = record(n, int(s[at.MODE]))
    size = 2 * n[at.BLOCKS]
    for i in range(n[at.SIGNALS]):
        row = here + n[at.OUTPUT_DRIVERS] + i * n[at.DRIVERS]
        total = inner_product(d, here + n[at.OUTPUT] + i * size, s, at.Z_START, size) + d[row + at.W_ONE]
        out[first + i] = total + d[row + at.W_HELD_HUB] * s[at.HELD_HUB] + d[row + at.W_HELD_MOTOR] * s[at.HELD_MOTOR]
    if n[n[at.SENSOR_LAWS]] > 0:
        apply_sensor_laws(d, n, s, out, first)
