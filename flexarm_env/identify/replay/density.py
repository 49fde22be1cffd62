"""Predictive density of recordings: the disturbances under which an arm's forecasts are likeliest, and how likely those are.

The density of each reading is that of its forecast alone, a composite likelihood (Varin, Reid and Firth, Statistica Sinica 21
(2011) 5). A larger disturbance allows larger errors, and pays for it with its logarithm.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.forecast import Disturbances, Observer, forecast_errors
from flexarm_env.identify.replay.forecast_spread import Leads, Spread, lead_times, spread_of
from flexarm_env.identify.replay.scales import torque_scale
from flexarm_env.identify.settings import LEAST_COUNT

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Prediction:
    """Forecasts of the fitted part by an arm under the disturbances that make them likeliest.

    Attributes:
        arm: the model.
        dataset: the recordings.
        disturbances: under which they are forecast.
        observer: the filter that the disturbances give.
        errors: (rows, signals) of the fitted part over the noise.
        leads: groups of their lead times.
        spread: variance of the forecasts under disturbances.
    """

    arm: Arm
    dataset: Dataset
    disturbances: Disturbances
    observer: Observer
    errors: Floats
    leads: Leads
    spread: Spread

    @functools.cached_property
    def variance(self) -> Floats:
        """Variance (groups, signals) of the errors that the disturbances predict, over that of the noise."""
        return self.spread.growth(self.disturbances) + np.array(self.disturbances.readings)

    @property
    def cost(self) -> float:
        """Negative log density of the fitted part, 0 for a perfect model's expectation."""
        return _cost(self.leads.mean_squares(self.errors), self.variance, self.leads.counts)

    @property
    def sigma(self) -> Floats:
        """Standard deviation (rows, signals) of each error, over the noise."""
        return np.asarray(np.sqrt(self.variance)[self.leads.group])

    @property
    def common_share(self) -> float:
        """Share of the variance that comes from disturbances, which readings of a window have in common."""
        own = np.minimum(np.array(self.disturbances.readings) / self.variance, 1.0)
        return float(np.average(1.0 - own, weights=np.maximum(self.leads.counts, LEAST_COUNT)))

    def errors_of(self, arm: Arm) -> Floats:
        """Compute the errors (rows, signals) of another arm under the same observer."""
        return forecast_errors(arm, self.dataset, self.dataset.fitted, self.observer)


def predict(arm: Arm, dataset: Dataset, disturbances: Disturbances) -> Prediction:
    """Forecast the fitted part under given disturbances."""
    plants, leads = dataset.plants(arm), lead_times(dataset, dataset.fitted)
    observer = _observer(arm, dataset, disturbances)
    errors = forecast_errors(arm, dataset, dataset.fitted, observer)
    return Prediction(arm, dataset, disturbances, observer, errors, leads, spread_of(plants, dataset, leads))


def suited(arm: Arm, dataset: Dataset, start: Disturbances, least_torque: float = 0.0) -> Prediction:
    """Forecast the fitted part under disturbances that suit the errors under given ones, if those make it likelier.

    Args:
        arm: the model.
        dataset: the recordings.
        start: disturbances to begin with.
        least_torque: the smallest process noise [Nm] that is considered.
    """
    given = _with_readings(predict(arm, dataset, start))
    torque = max(_suitable_torque(given), least_torque)
    if torque == given.disturbances.torque:
        return given
    return min(given, at_torque(given, torque), key=lambda prediction: prediction.cost)


def likeliest(arm: Arm, dataset: Dataset, start: Disturbances) -> Prediction:
    """Find the disturbances under which an arm's forecasts of the fitted part are likeliest.

    Errors depend on the observer, and the observer on the disturbances. Where the torque falls, the observer smooths less and the
    errors change, so smaller and larger ones than suit the present errors are tried by replays of their own.

    Args:
        arm: the model.
        dataset: the recordings.
        start: disturbances to begin with.
    """
    best = suited(arm, dataset, start)
    for factor in (1.0 / dataset.settings.forecasts.torque_step, dataset.settings.forecasts.torque_step):
        better = False
        while (other := at_torque(best, factor * best.disturbances.torque)).cost < best.cost:
            best, better = other, True
        if better:
            break
    return best


def first_disturbances(arm: Arm, dataset: Dataset) -> Disturbances:
    """Assume the disturbances with which a first calibration begins."""
    torque = dataset.settings.forecasts.first_torque * torque_scale(arm, dataset.runs)
    return Disturbances(torque, (1.0,) * len(dataset.signals))


def _observer(arm: Arm, dataset: Dataset, disturbances: Disturbances) -> Observer:
    """Design the filter for an arm."""
    observer = Observer(dataset, disturbances)
    for stated, plant in dataset.plants(arm).items():
        observer.gains(arm, plant, stated)
    return observer


def _cost(squares: Floats, variance: Floats, counts: Floats) -> float:
    return 0.5 * float(np.sum(counts * (squares / variance + np.log(variance) - 1.0)))


def at_torque(prediction: Prediction, torque: float) -> Prediction:
    """Forecast under another torque [Nm], within bounds, and under the errors of readings that suit it."""
    scale, numbers = torque_scale(prediction.arm, prediction.dataset.runs), prediction.dataset.settings.forecasts
    torque = min(max(torque, numbers.least_torque * scale), numbers.largest_torque * scale)
    disturbances = replace(prediction.disturbances, torque=torque)
    observer = _observer(prediction.arm, prediction.dataset, disturbances)
    found = replace(prediction, disturbances=disturbances, observer=observer)
    return _with_readings(replace(found, errors=found.errors_of(found.arm)))


def _with_readings(prediction: Prediction) -> Prediction:
    """Set the errors of readings to those under which the present errors are likeliest."""
    readings = _suitable_readings(prediction, prediction.spread.growth(prediction.disturbances))
    return replace(prediction, disturbances=replace(prediction.disturbances, readings=readings))


def _suitable_readings(prediction: Prediction, growth: Floats) -> tuple[float, ...]:
    """Find the variances (signals,) of readings, over that of the noise, beside the growth (groups, signals) of errors."""
    found, _ = best_readings(
        prediction.leads.mean_squares(prediction.errors), growth, prediction.leads.counts, prediction.dataset
    )
    return found


def best_readings(squares: Floats, growth: Floats, counts: Floats, dataset: Dataset) -> tuple[tuple[float, ...], float]:
    """Find, by a scan, the variances of readings under which mean squares of errors are likeliest.

    Args:
        squares: (groups, signals) over the variance of the noise.
        growth: (groups, signals) that the torque gives, over the same.
        counts: (groups, signals).
        dataset: the recordings.

    Returns:
        (signals,) over the variance of the noise; the cost under them.
    """
    numbers = dataset.settings.forecasts
    tried = np.geomspace(numbers.least_readings, numbers.largest_readings, numbers.readings_tried)[:, None, None]
    variance = growth + tried
    costs = 0.5 * np.sum(counts * (squares / variance + np.log(variance) - 1.0), axis=1)
    return tuple(float(value) for value in tried[np.argmin(costs, axis=0), 0, 0]), float(costs.min(axis=0).sum())


def torque_levels(prediction: Prediction) -> list[float]:
    """List the torques [Nm] in steps around the present one, within bounds."""
    numbers, now = prediction.dataset.settings.forecasts, prediction.disturbances.torque
    scale = torque_scale(prediction.arm, prediction.dataset.runs)
    powers = range(-numbers.torques_tried, numbers.torques_tried + 1)
    levels = [now * numbers.torque_step**power for power in powers]
    return [level for level in levels if numbers.least_torque * scale <= level <= numbers.largest_torque * scale] or [now]


def _suitable_torque(prediction: Prediction) -> float:
    """Find the torque under which the present errors are likeliest, by a scan in steps."""
    squares, leads = prediction.leads.mean_squares(prediction.errors), prediction.leads

    def cost(torque: float) -> float:
        growth = prediction.spread.growth(replace(prediction.disturbances, torque=torque))
        return best_readings(squares, growth, leads.counts, prediction.dataset)[1]

    return min(torque_levels(prediction), key=cost)
