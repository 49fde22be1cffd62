"""How much of the forecasts' errors each effect promises to explain, before any is fitted.

An effect's change of the errors, less what the constants could do, is subtracted from them at the size that suits best. The
density of what then remains, under the disturbances that it would need, is the promise.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.forecast_fit import error_slopes, narrowed
from flexarm_env.identify.calibrate.parameters import FitParameters
from flexarm_env.identify.replay.density import Prediction, at_torque, best_readings, torque_levels
from flexarm_env.identify.replay.forecast import FilteredStates, filtered_states
from flexarm_env.identify.replay.forecast_spread import Leads
from flexarm_env.identify.select.starts import changes_in_proportion, has_two_signs, sized, starts_of
from flexarm_env.identify.settings import LEAST_NORM
from flexarm_env.identify.threads import in_threads

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Promise:
    """An effect at the values from which it promises most.

    Attributes:
        effect: its name.
        values: from which its calibration starts.
        cost: negative log density of the fitted part that it would leave.
        gain: by which that is less than without it.
        torque: process noise [Nm] of the observer under which it promises that.
        slopes: (readings,) of the errors over the noise there without it, by the path of each value.
    """

    effect: str
    values: dict[str, float]
    cost: float
    gain: float
    torque: float
    slopes: Mapping[str, Floats] = field(repr=False, compare=False)


@dataclass(frozen=True)
class Background:
    """Forecasts of a calibrated arm under one observer, and all that its constants could change of them.

    Attributes:
        prediction: of the arm.
        states: from which the arm and others are forecast.
        errors: (rows, signals) over the noise.
        sigma: (rows, signals) deviation of the errors, at least that which they have.
        slopes: (readings,) of all errors over the noise, by the path of each value.
        orthonormal: (readings, values) basis of the changes that the values can make under their priors.
    """

    prediction: Prediction
    states: FilteredStates
    errors: Floats
    sigma: Floats
    slopes: Mapping[str, Floats]
    orthonormal: Floats

    @functools.cached_property
    def leads(self) -> Leads:
        """Lead times of the forecasts' rows."""
        return self.prediction.leads.of(self.states.rows)

    @functools.cached_property
    def growth(self) -> Floats:
        """Variance (levels, groups, signals) of forecasts under levels of torque, over that of the noise."""
        levels = torque_levels(self.prediction)[:: self.prediction.dataset.settings.promising.every]
        disturbances = [replace(self.prediction.disturbances, torque=torque) for torque in levels]
        return np.array([self.prediction.spread.growth(one) for one in disturbances])

    @functools.cached_property
    def left(self) -> Floats:
        """Errors over sigma (readings,) that no change of the values explains."""
        return self._unexplained(self.errors)

    def cost(self, left: Floats) -> float:
        """Compute the cost of errors over sigma (readings,) under the disturbances that suit them."""
        squares = self.leads.mean_squares(left.reshape(self.sigma.shape) * self.sigma)
        return min(best_readings(squares, one, self.leads.counts, self.prediction.dataset)[1] for one in self.growth)

    def change(self, arm: Arm) -> Floats:
        """Compute the change of the errors over sigma (readings,) by an arm, less that which the values could make."""
        return self._unexplained(self.states.errors(arm) - self.errors)

    def _unexplained(self, errors: Floats) -> Floats:
        whitened = (errors / self.sigma).ravel()
        return np.asarray(whitened - self.orthonormal @ (self.orthonormal.T @ whitened))


def promises(now: Prediction, parameters: FitParameters, effects: Sequence[str]) -> list[Promise]:
    """Estimate the promise of each effect beside an arm, most promising first, without those that promise nothing.

    Args:
        now: forecasts by the arm.
        parameters: of its values.
        effects: names.
    """
    torques = [share * now.disturbances.torque for share in now.dataset.settings.promising.torques]
    backgrounds = [_background(parameters, at_torque(now, torque)) for torque in torques]
    base = min(background.cost(background.left) for background in backgrounds)
    tasks = [(name, start) for name in effects for start in starts_of(now.arm, name, now.dataset)]
    tried = in_threads(_promise, [(backgrounds, base, name, start) for name, start in tasks])
    best: dict[str, Promise] = {}
    for one in tried:
        if one.gain > 0.0 and (one.effect not in best or one.cost < best[one.effect].cost):
            best[one.effect] = one
    return sorted(best.values(), key=lambda promise: promise.cost)


def _background(parameters: FitParameters, prediction: Prediction) -> Background:
    dataset, numbers = prediction.dataset, prediction.dataset.settings.promising
    states = filtered_states(prediction.arm, dataset, prediction.observer, numbers.windows)
    rows = states.rows
    leads = prediction.leads.of(rows)
    errors = states.errors(prediction.arm)
    sigma = np.sqrt(np.maximum(prediction.variance, leads.mean_squares(errors)))[leads.group]
    slopes = error_slopes(prediction, parameters)
    whitened = slopes[np.repeat(rows, errors.shape[1])] / sigma.ravel()[:, None]
    stacked = np.vstack([whitened, np.diag(1.0 / narrowed(parameters, prediction))])
    orthonormal = np.linalg.qr(stacked)[0][: errors.size]
    by_path = dict(zip([parameter.path for parameter in parameters], slopes.T, strict=True))
    return Background(prediction, states, errors, sigma, by_path, orthonormal)


def _promise(backgrounds: Sequence[Background], base: float, effect: str, start: dict[str, float]) -> Promise:
    """Estimate the promise of an effect from one of its starts."""
    arm, dataset = backgrounds[0].prediction.arm, backgrounds[0].prediction.dataset
    numbers = dataset.settings.promising
    best = Promise(effect, start, base, 0.0, backgrounds[0].prediction.disturbances.torque, backgrounds[0].slopes)
    for background in backgrounds:
        left = float(np.linalg.norm(background.left))

        def change_by(values: dict[str, float], background: Background = background) -> Floats:
            return background.change(arm.with_effect(effect, **values))

        for begin, change in changes_in_proportion(arm, effect, start, change_by, background.left, dataset):
            power = float(change @ change)
            if power <= numbers.least_change * left**2 + LEAST_NORM:
                continue
            suits = -float(change @ background.left) / power
            turned = _turned(arm, effect, begin) if suits < 0.0 else None
            for factor in _factors(arm, effect, suits if turned is None else -suits, numbers.largest_factor):
                cost = background.cost(background.left + (factor if turned is None else -factor) * change)
                if cost < best.cost:
                    values = sized(arm, effect, turned or begin, factor, dataset) if factor != 1.0 else turned or begin
                    torque = background.prediction.disturbances.torque
                    best = Promise(effect, values, cost, base - cost, torque, background.slopes)
    return best


def _factors(arm: Arm, effect: str, suits: float, largest: float) -> list[float]:
    """List the factors of an effect's size to consider: as it starts, and that which suits the errors best."""
    known = arm.known[effect]
    if not known.fitted:
        return [1.0]
    factor = float(np.clip(suits, -largest, largest))
    return [1.0, factor] if has_two_signs(known) or factor > 1.0 / largest else [1.0]


def _turned(arm: Arm, effect: str, start: dict[str, float]) -> dict[str, float] | None:
    """Turn a sine round by half a period; None for an effect without a phase."""
    phase = arm.known[effect].scan_phase
    return {**start, phase: start[phase] - float(np.copysign(np.pi, start[phase]))} if phase else None
