"""Arrays of derivatives, one lane for each constant, and the scratch of a step of theirs."""

from __future__ import annotations

from typing import NamedTuple

from numba import njit

from flexarm_env.plant import layout as at
from flexarm_env.plant.bundles import Gains, Numbers, Places, Samples

#: Numbers of one block in a table: C, S and five integrals of S, then their derivatives by c₀ and by c₁.
PER_RESPONSE = 7
PER_TABLE = 3 * PER_RESPONSE
#: Largest order of a force's polynomial in time, and number of its nodes after the start.
MOST_ORDERS = 4
#: Keys in v of what is kept from step to step: mode, order and length of the tables at the nodes; what the constant part of the
#: force in each tabulated substep depends on; whether the delay has derivatives;
#: the time in a substep at which the search for its next event starts.
KEY_MODE, KEY_ORDER, KEY_LENGTH, KEY_DELAY, KEY_SEARCHED, KEY_STEADY = range(6)
KEYS = 7


class Tangent(NamedTuple):
    """Derivatives of an arm's arrays (see layout.py), (numbers, lanes): of constants, state and scratch; and numbers beside.

    Row i of `d` and of `s` holds the derivatives of the constant and the state at i. `steady` has the rows of StepRows.
    """

    d: Samples
    s: Samples
    w: Samples
    v: Numbers
    steady: Samples


class Run(NamedTuple):
    """Commands, intervals, gains and measured values of a replay, its readings (samples · signals,), and derivatives.

    `gain_lanes` (modes · 2 blocks · signals, lanes) has those of the gains, `derivatives` (samples · signals, lanes) those of the
    readings. `steps` (lanes,) are differences of constants on which laws depend, 0 for others.
    """

    commands: Numbers
    intervals: Numbers
    gains: Gains
    measured: Samples
    readings: Numbers
    gain_lanes: Samples
    steps: Numbers
    derivatives: Samples


class TangentPlaces(NamedTuple):
    """Places in v and, from `lanes_force` on, rows of w.

    In v: the state at the start; the force on the blocks and the laws' forces, by powers s^k/k!; tables at the nodes and at the
    end; the blocks' state at a node; arguments of the laws and the forces at two points beside; slopes of the forces by node;
    shifts of the arguments by coefficients of the forces, by node; a system of equations; the laws' constants; readings; keys of
    what is kept from step to step; tables of each mode's tabulated substeps.

    In w: the same of the derivatives, `lanes_node` the forces at the nodes, and single rows.
    """

    start: int
    phi: int
    coefficients: int
    tables: int
    z: int
    motion: int
    above: int
    below: int
    slopes: int
    shifts: int
    system: int
    laws: int
    readings: int
    keys: int
    steady_tables: int
    lanes_force: int
    lanes_coefficients: int
    lanes_node: int
    lanes_motion: int
    lanes_z: int
    lanes_physical: int
    lanes_reading: int
    lanes_command: int
    lanes_earlier: int
    lanes_before: int
    lanes_now: int
    lanes_length: int
    lanes_left: int
    lanes_event: int
    lanes_step: int
    lanes_zero: int


@njit
def mode_count(n: Places) -> int:
    """Count the modes."""
    return (n[at.PARAMETERS] - n[at.MODES]) // n[at.STRIDE]


@njit
def argument_count(n: Places) -> int:
    """Count the arguments of the laws: angles and speeds of bodies, velocities of the beam; time, command, memory of friction."""
    return 2 * n[at.BODIES] + n[at.POINTS] + 4


@njit
def tangent_places(d: Numbers, n: Places) -> TangentPlaces:
    """Lay out v and w."""
    size, count, arguments = 2 * n[at.BLOCKS], n[at.BODIES] + n[at.POINTS], argument_count(n)
    start = 0
    phi = start + at.Z_START + size
    coefficients = phi + (MOST_ORDERS + 1) * size
    tables = coefficients + (MOST_ORDERS + 1) * count
    z = tables + (MOST_ORDERS + 1) * n[at.BLOCKS] * PER_TABLE
    motion = z + size
    above = motion + arguments
    below = above + count
    slopes = below + count
    shifts = slopes + (MOST_ORDERS + 1) * count * arguments
    system = shifts + MOST_ORDERS * arguments * MOST_ORDERS * count
    laws = system + (MOST_ORDERS * count) ** 2
    readings = laws + at.CONSTANTS + d.shape[0] - n[at.PARAMETERS]
    keys = readings + n[at.SIGNALS]
    steady_tables = keys + KEYS
    force = 0
    lanes_coefficients = force + (MOST_ORDERS + 1) * size
    node = lanes_coefficients + (MOST_ORDERS + 1) * count
    lanes_motion = node + MOST_ORDERS * count
    lanes_z = lanes_motion + arguments
    physical = lanes_z + size
    reading = physical + n[at.STATES]
    command = reading + n[at.SIGNALS]
    return TangentPlaces(
        start, phi, coefficients, tables, z, motion, above, below, slopes, shifts, system, laws, readings, keys, steady_tables,
        force, lanes_coefficients, node, lanes_motion, lanes_z, physical, reading, command,
        command + 1, command + 2, command + 3, command + 4, command + 5, command + 6, command + 7, command + 8,
    )  # fmt: skip


@njit
def tangent_numbers(d: Numbers, n: Places) -> int:
    """Count the numbers of v."""
    return tangent_places(d, n).steady_tables + mode_count(n) * 2 * n[at.BLOCKS] * PER_TABLE


@njit
def steady_rows(n: Places) -> int:
    """Count the rows of `steady`: by mode and tabulated substep, three of each number of the blocks; then one by substep."""
    return (mode_count(n) * 3 + 1) * 2 * 2 * n[at.BLOCKS]


@njit
def tangent_rows(d: Numbers, n: Places) -> int:
    """Count the rows of w."""
    return tangent_places(d, n).lanes_zero + at.Z_START + 2 * n[at.BLOCKS]
