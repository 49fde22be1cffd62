"""The numbers that a fit moves: which values of an arm, on which scale, with which prior."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.least_squares import Reach

Floats = NDArray[np.float64]

#: A fit sees an unbounded prior as this many typical sizes wide, so that a direction without information stays put.
WIDEST = 30.0
#: Differences are taken over no less than this, of constants and of effects; nor over more than this share of a prior or a size.
BASE_STEP, EFFECT_STEP, WIDEST_STEP = 1e-3, 1e-2, 0.3
#: What splits friction between motor and hub, which are one body unless the gears give way.
SHARES = ("drive.motor_coulomb_share", "drive.motor_stiction_share")


@dataclass(frozen=True)
class Coordinate:
    """One fitted value, as origin · exp(x) where it keeps its sign, else as origin + scale · x.

    Attributes:
        path: in the arm.
        origin: value at x = 0.
        scale: of the linear form; 0 for the exponential one.
        prior: standard deviation of x.
        low: smallest value.
        high: largest value.
    """

    path: str
    origin: float
    scale: float
    prior: float
    low: float
    high: float

    @property
    def is_constant(self) -> bool:
        """Whether the value is known but for a spread, unlike that of an effect that is added."""
        return not self.scale and self.prior < 1.0

    def step(self, x: float) -> float:
        """Return a step of x that a replay resolves: stick-slip makes smaller ones of an effect look like noise."""
        if not self.scale:
            return BASE_STEP if self.is_constant else EFFECT_STEP
        return EFFECT_STEP * max(abs(self.value(x)) / self.scale, 0.3)

    def widest_step(self, x: float) -> float:
        """Return the step of x beyond which the value is hardly to be believed, or an effect another than it was."""
        return WIDEST_STEP * self.prior if self.is_constant else WIDEST_STEP * self.step(x) / EFFECT_STEP

    def value(self, x: float) -> float:
        """Return the physical value at x, within the bounds."""
        raw = self.origin + self.scale * x if self.scale else self.origin * math.exp(min(max(x, -20.0), 20.0))
        return min(max(raw, self.low), self.high)

    def x_of(self, value: float) -> float:
        """Return x for a physical value."""
        return (value - self.origin) / self.scale if self.scale else math.log(value / self.origin)

    def slope(self, x: float) -> float:
        """Return d value / d x."""
        return self.scale or self.value(x)


def base_coordinates(arm: Arm, nominal: Arm, scales: Mapping[str, float]) -> list[Coordinate]:
    """Return what a refit of the constants moves: all with a spread, around their values in the nominal arm."""
    found = []
    one_body = not arm.structure().separate_motor
    for section, table in arm.constants.items():
        for key in table:
            path = f"{section}.{key}"
            if one_body and path in SHARES:
                continue
            found += _with_prior(path, nominal.value(path), arm.parameter(path).spread, arm)
    for signal in arm.sensors:
        path = f"sensors.{signal}.gain"
        found += _with_prior(path, nominal.value(path), arm.parameter(path).spread, arm)
    for name in arm.effects:
        if name in nominal.effects:
            found += effect_coordinates(arm, name, scales, nominal)
    return found


def _with_prior(path: str, value: float, spread: float, arm: Arm) -> list[Coordinate]:
    if not 0.0 < spread < math.inf or value == 0.0 or path in arm.fixed:
        return []
    parameter = arm.parameter(path)
    return [Coordinate(path, value, 0.0, spread, parameter.low, parameter.high)]


def effect_coordinates(arm: Arm, name: str, scales: Mapping[str, float], nominal: Arm | None = None) -> list[Coordinate]:
    """Return the coordinates of an effect's parameters around their present values.

    Args:
        arm: which has the effect.
        name: of the effect.
        scales: by unit and for "command", how much larger than typical sizes are here.
        nominal: if it has the effect as well, its values are the prior's centre.
    """
    effect = arm.known[name]
    if not effect.fitted:
        return []
    found = []
    for key, parameter in effect.parameters.items():
        if effect.per_sensor and key not in arm.sensors:
            continue
        if parameter.spread == 0.0:
            continue
        known = nominal is not None and name in nominal.effects
        value = nominal.value(f"effects.{name}.{key}") if known and nominal else arm.value(f"effects.{name}.{key}")
        path = f"effects.{name}.{key}"
        if known and value > 0.0 and parameter.spread < math.inf:
            found.append(Coordinate(path, value, 0.0, parameter.spread, parameter.low, parameter.high))
        elif parameter.null == math.inf or (parameter.low > 0.0 and parameter.null is None):
            found.append(Coordinate(path, value, 0.0, 3.0, parameter.low, parameter.high))
        else:
            scale = (parameter.typical if parameter.typical > 0.0 else 1.0) * parameter.scaled_by(scales)
            found.append(Coordinate(path, value, scale, WIDEST, parameter.low, parameter.high))
    return found


def place_values(arm: Arm, coordinates: Sequence[Coordinate], x: Floats) -> Arm:
    """Return the arm with the values at x."""
    return arm.with_values({c.path: c.value(float(v)) for c, v in zip(coordinates, x, strict=True)})


def reach_at(coordinates: Sequence[Coordinate], x: Floats) -> Reach:
    """Return how far differences go at x, at the widest to begin with."""
    pairs = list(zip(coordinates, (float(v) for v in x), strict=True))
    most = np.array([c.widest_step(v) for c, v in pairs])
    return Reach(np.array([c.step(v) for c, v in pairs]), most, most)


def position(arm: Arm, coordinates: Sequence[Coordinate]) -> Floats:
    """Return x of the arm's present values."""
    return np.array([c.x_of(arm.value(c.path)) for c in coordinates])
