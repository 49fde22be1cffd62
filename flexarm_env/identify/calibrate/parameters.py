"""The values that a calibration moves: of which quantities, on which scale, under which prior."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.least_squares import StepSizes
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.settings import LARGEST_LOG, Parameters

Floats = NDArray[np.float64]

#: Constants that split friction between motor and hub, which are one body unless the gears give way.
SHARES = ("drive.motor_coulomb_share", "drive.motor_stiction_share")


@dataclass(frozen=True)
class FitParameter:
    """One fitted value: origin · exp(x) where it keeps its sign, else origin + scale · x.

    Attributes:
        path: in the arm, as "beam.length".
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
        """Whether the value is known but for a spread, unlike that of an added effect."""
        return not self.scale and self.prior < 1.0

    def value(self, x: float) -> float:
        """Compute the physical value at x, within the bounds."""
        raw = self.origin + self.scale * x if self.scale else self.origin * math.exp(min(max(x, -LARGEST_LOG), LARGEST_LOG))
        return min(max(raw, self.low), self.high)

    def x_of(self, value: float) -> float:
        """Compute x for a physical value."""
        return (value - self.origin) / self.scale if self.scale else math.log(value / self.origin)

    def narrowest_step(self, x: float, numbers: Parameters) -> float:
        """Compute the narrowest difference that a replay resolves: stick-slip turns narrower ones of an effect into noise."""
        if not self.scale:
            return numbers.least_step_constant if self.is_constant else numbers.least_step_effect
        return numbers.least_step_effect * self._size(x, numbers.smallest_size)

    def widest_step(self, x: float, numbers: Parameters) -> float:
        """Compute the difference beyond which the value is implausible, or the effect no longer the same."""
        if self.is_constant:
            return numbers.widest_step * self.prior
        return numbers.widest_step * (self._size(x, numbers.least_size) if self.scale else 1.0)

    def _size(self, x: float, least: float) -> float:
        """Compute the size of an effect in typical ones, at least a given one."""
        return max(abs(self.value(x)) / self.scale, least)


@dataclass(frozen=True)
class FitParameters:
    """The values that one calibration moves, in the order of x."""

    items: tuple[FitParameter, ...] = ()

    def __len__(self) -> int:
        return len(self.items)

    def __iter__(self) -> Iterator[FitParameter]:
        return iter(self.items)

    def __add__(self, other: FitParameters) -> FitParameters:
        return FitParameters(self.items + other.items)

    @property
    def priors(self) -> Floats:
        """Standard deviations of x (x,)."""
        return np.array([parameter.prior for parameter in self.items])

    @property
    def constant(self) -> NDArray[np.bool_]:
        """Which are known but for a spread (x,)."""
        return np.array([parameter.is_constant for parameter in self.items], dtype=np.bool_)

    def pairs(self, x: Floats) -> Iterator[tuple[FitParameter, float]]:
        """Pair each parameter with its x."""
        return zip(self.items, (float(v) for v in x), strict=True)

    def apply(self, arm: Arm, x: Floats) -> Arm:
        """Give an arm the values at x."""
        return arm.with_values({parameter.path: parameter.value(v) for parameter, v in self.pairs(x)})

    def position(self, arm: Arm) -> Floats:
        """Compute x of an arm's present values."""
        return np.array([parameter.x_of(arm.value(parameter.path)) for parameter in self.items])

    def within(self, x: Floats) -> Floats:
        """Move x (x,) to the nearest bound where a value has none beyond, and no difference would show a slope."""
        ranges = [
            sorted(map(parameter.x_of, (parameter.low, parameter.high))) if parameter.scale else (-np.inf, np.inf)
            for parameter in self.items
        ]
        return np.array([min(max(v, low), high) for (low, high), v in zip(ranges, x, strict=True)])

    def step_sizes(self, x: Floats, numbers: Parameters) -> StepSizes:
        """Compute the difference steps at x, the widest to begin with."""
        most = np.array([parameter.widest_step(v, numbers) for parameter, v in self.pairs(x)])
        return StepSizes(np.array([parameter.narrowest_step(v, numbers) for parameter, v in self.pairs(x)]), most, most)


def free_parameters(arm: Arm, nominal: Arm, dataset: Dataset) -> FitParameters:
    """List everything that a calibration of the arm moves: constants first, then effects that the nominal arm lacks."""
    found = FitParameters(tuple(_constants(arm, nominal, stated_throughout(dataset))))
    for name in arm.effects:
        if name in nominal.effects:
            found += known_effect_parameters(arm, name, nominal, dataset)
    for name in arm.effects:
        if name not in nominal.effects:
            found += effect_parameters(arm, name, dataset)
    return found


def _constants(arm: Arm, nominal: Arm, stated: Collection[str]) -> Iterator[FitParameter]:
    """List constants and sensor gains with a spread, around their values in the nominal arm, unless every run states them."""
    one_body = not arm.structure().separate_motor
    paths = [f"{section}.{key}" for section, table in arm.constants.items() for key in table]
    for path in paths:
        if path not in stated and not (one_body and path in SHARES):
            yield from _with_prior(path, nominal.value(path), arm.parameter(path).spread, arm)
    for signal in arm.sensors:
        path = f"sensors.{signal}.gain"
        yield from _with_prior(path, nominal.value(path), arm.parameter(path).spread, arm)


def stated_throughout(dataset: Dataset) -> set[str]:
    """Collect the paths of values that every recording states, so that none depends on the arm's own."""
    return set.intersection(*({path for path, _ in run.stated} for run in dataset.runs))


def _with_prior(path: str, value: float, spread: float, arm: Arm) -> Sequence[FitParameter]:
    if not 0.0 < spread < math.inf or value == 0.0 or path in arm.fixed:
        return []
    parameter = arm.parameter(path)
    return [FitParameter(path, value, 0.0, spread, parameter.low, parameter.high)]


def effect_parameters(arm: Arm, name: str, dataset: Dataset) -> FitParameters:
    """List the parameters of an added effect around their present values.

    Args:
        arm: the arm with the effect.
        name: of the effect.
        dataset: for the scales of its recordings.
    """
    return _effect_parameters(arm, name, dataset, None)


def known_effect_parameters(arm: Arm, name: str, nominal: Arm, dataset: Dataset) -> FitParameters:
    """List the parameters of an effect that the nominal arm has as well; its values there are the centres of the priors."""
    return _effect_parameters(arm, name, dataset, nominal)


def _effect_parameters(arm: Arm, name: str, dataset: Dataset, nominal: Arm | None) -> FitParameters:
    effect, numbers = arm.known[name], dataset.settings.parameters
    found = []
    for key, parameter in effect.parameters.items() if effect.fitted else ():
        if effect.per_sensor and key not in arm.sensors:
            continue
        if parameter.spread == 0.0:
            continue
        path = f"effects.{name}.{key}"
        value = (arm if nominal is None else nominal).value(path)
        if nominal is not None and value > 0.0 and parameter.spread < math.inf:
            found.append(FitParameter(path, value, 0.0, parameter.spread, parameter.low, parameter.high))
        elif parameter.null == math.inf or (parameter.low > 0.0 and parameter.null is None):
            found.append(FitParameter(path, value, 0.0, numbers.positive, parameter.low, parameter.high))
        else:
            scale = (parameter.typical if parameter.typical > 0.0 else 1.0) * parameter.scaled_by(dataset.scales)
            found.append(FitParameter(path, value, scale, numbers.widest, parameter.low, parameter.high))
    return FitParameters(tuple(found))
