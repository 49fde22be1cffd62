"""The linear part of a sensor: rows on an arm's coordinates, and their gain, offset and filter on the way to a reading."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from flexarm_env.errors import InputError
from flexarm_env.plant.beam import Beam, Matrix

#: Time constant [s] of an accelerometer with no filter given: as fast as one is.
FASTEST_ACCELEROMETER = 1e-4


@dataclass(frozen=True)
class Current:
    """The motor's current [A]: its parts by the command, by the coordinates q, by their rates and by the lagged current.

    Attributes:
        command: [A per command], (arms,) of stacked arms.
        position: (coordinates,), of stacked arms (arms, coordinates).
        speed: the same of the rates.
        lagged: 1 where the current lags behind the command and is a state of its own, else 0.
    """

    command: float | Matrix
    position: Matrix
    speed: Matrix
    lagged: float = 0.0


@dataclass(frozen=True)
class Reading:
    """The quantity position · q + speed · q̇ + acceleration · q̈ + current in SI units, before gain, offset and filter.

    Each row is (coordinates,), of stacked arms (arms, coordinates), or None for zero.
    """

    position: Matrix | None = None
    speed: Matrix | None = None
    acceleration: Matrix | None = None
    current: Current | None = None

    @property
    def jumps(self) -> bool:
        """Whether the quantity jumps with the command, and so passes a filter."""
        return self.acceleration is not None or self.current is not None


@dataclass(frozen=True)
class Coordinates:
    """Rows (coordinates,) that give an arm's angles, deflections and moments from its coordinates q.

    The same row gives the rate from q̇ and the acceleration from q̈. Rows of stacked arms are (arms, coordinates).

    Attributes:
        size: number of coordinates.
        body: of the motor, the same as the hub's where both are one body.
        gear_ratio: motor turns per arm turn, (arms,) of stacked arms.
        beam: or None for a rigid arm.
        spread: takes rows of the beam to rows of the arm.
        position: of the sensor along the beam, from the hub's axis [m]; (arms,) of stacked arms.
        drive: the motor's current, or None where the arm's drive gives none.
        hub_body: of the hub: 0, or the motor's where a joint's spring lies behind the hub.
    """

    size: int
    body: int
    gear_ratio: float | Matrix
    beam: Beam | None
    spread: Callable[[Matrix], Matrix]
    position: ArrayLike = 0.0
    hub_body: int = 0
    drive: Current | None = None

    @property
    def hub(self) -> Matrix:
        """Angle of the hub [rad], in front of a joint's spring."""
        return self._angle(self.hub_body, 1.0)

    @property
    def link(self) -> Matrix:
        """Angle of the link or of the beam's root line [rad], behind the spring of joint or gears."""
        return self._angle(0, 1.0)

    @property
    def motor(self) -> Matrix:
        """Angle of the motor's shaft [rad], gear ratio times that of the hub where the gears are stiff."""
        return self._angle(self.body, self.gear_ratio)

    @property
    def current(self) -> Current:
        """Current of the motor [A]."""
        if self.drive is None:
            raise InputError(
                "measures the motor's current, which a torque drive, a servo with limits and a sagging supply do not give"
            )
        return self.drive

    def _angle(self, body: int, ratio: float | Matrix) -> Matrix:
        row = np.zeros((*np.shape(self.gear_ratio), self.size))
        row[..., body] = ratio
        return row

    def moment(self, position: ArrayLike) -> Matrix:
        """Bending moment [Nm] at a position [m] from the hub's axis."""
        return self.spread(self._beam().moment_rows(self._places(position)))[..., 0, :]

    def deflection(self, position: ArrayLike) -> Matrix:
        """Deflection [m] from the hub's line at a position [m] from the hub's axis."""
        return self.spread(self._beam().deflection_rows(self._places(position), absolute=False))[..., 0, :]

    def displacement(self, position: ArrayLike) -> Matrix:
        """Displacement [m] across the beam from the fixed line at a position [m] from the hub's axis."""
        return self.spread(self._beam().deflection_rows(self._places(position), absolute=True))[..., 0, :]

    @property
    def length(self) -> Matrix:
        """Length of the beam [m]: the position of the tip."""
        return self._beam().length

    def _beam(self) -> Beam:
        if self.beam is None:
            raise InputError("measures the beam, and the arm has none: add [beam] or leave it out")
        return self.beam

    def _places(self, position: ArrayLike) -> Matrix:
        return np.broadcast_to(np.asarray(position, dtype=float), np.shape(self.gear_ratio))[..., None]


@dataclass
class Channel:
    """One measured signal: gain × quantity + offset, through a first-order filter.

    Attributes:
        reading: the quantity, from the arm's coordinates.
        strain: whether it is a strain gage.
        gain: reading per quantity.
        offset: reading at zero.
        filter: time constant [s].
        position: along the beam [m].
    """

    reading: Callable[[Coordinates], Reading]
    strain: bool = False
    gain: float = 1.0
    offset: float = 0.0
    filter: float = 0.0
    position: float = 0.0


def time_constant(reading: Reading, channel: Channel) -> float | Matrix:
    """Compute the time constant [s] of a channel's filter; a reading that jumps always has one."""
    if not reading.jumps:
        return channel.filter
    least: float | Matrix = np.maximum(channel.filter, FASTEST_ACCELEROMETER)
    return least
