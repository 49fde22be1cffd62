"""Calibration by forecasts: Gauss–Newton steps of the values, and between them the disturbances that the errors then call for.

Disturbances fall as the model improves. So the cost is smooth while the model is far off, and sharp once it is right, without a
schedule. Where a step gains nothing more, slopes are taken over wider differences, since a sharp cost is rough.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.least_squares import descend, one_by_one
from flexarm_env.identify.calibrate.parameters import FitParameters
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.density import Prediction, likeliest, suited
from flexarm_env.identify.replay.forecast import Disturbances, window_samples
from flexarm_env.identify.settings import LEAST_NORM
from flexarm_env.identify.threads import in_threads

Floats = NDArray[np.float64]


def fit_forecasts(arm: Arm, parameters: FitParameters, dataset: Dataset, start: Disturbances) -> Prediction:
    """Calibrate values of an arm, from those that it has, by the density of its forecasts.

    Args:
        arm: the model.
        parameters: of the fitted values, and their priors.
        dataset: the recordings.
        start: disturbances to begin with.

    Returns:
        The forecasts of the calibrated arm.
    """
    numbers = dataset.settings.forecast_fit
    best = suited(arm, dataset, start)
    if not len(parameters):
        return likeliest(arm, dataset, best.disturbances)
    slopes, is_fresh, is_wide = error_slopes(best, parameters), True, False
    for _ in range(numbers.iterations):
        now, slopes = _step(best, parameters, slopes)
        is_idle, best = _is_idle(best, now), min(best, now, key=lambda prediction: prediction.cost)
        if not is_idle:
            is_fresh = False
            continue
        if is_fresh and is_wide:
            break
        is_wide = is_wide or is_fresh
        slopes = wide_error_slopes(best, parameters, slopes) if is_wide else error_slopes(best, parameters)
        is_fresh = True
    return likeliest(best.arm, dataset, best.disturbances)


def fit_briefly(
    arm: Arm, parameters: FitParameters, dataset: Dataset, start: Disturbances, slopes: Mapping[str, Floats]
) -> Prediction:
    """Calibrate values as `fit_forecasts` does, along slopes that are known of a similar arm, until a step gains little.

    Args:
        arm: the model.
        parameters: of the fitted values, and their priors.
        dataset: the recordings.
        start: disturbances to begin with.
        slopes: (readings,) of forecast errors over the noise, by the path of a value. Others are computed.
    """
    best = suited(arm, dataset, start)
    own = FitParameters(tuple(parameter for parameter in parameters if parameter.path not in slopes))
    known = dict(zip([parameter.path for parameter in own], error_slopes(best, own).T, strict=True)) | dict(slopes)
    matrix = np.stack([known[parameter.path] for parameter in parameters], axis=1)
    for _ in range(dataset.settings.forecast_fit.brief_iterations):
        now, matrix = _step(best, parameters, matrix)
        is_idle, best = _is_idle(best, now), min(best, now, key=lambda prediction: prediction.cost)
        if is_idle:
            break
    return best


def _step(best: Prediction, parameters: FitParameters, slopes: Floats) -> tuple[Prediction, Floats]:
    """Take steps under one observer, and forecast under the one that then suits; also give the slopes that they corrected."""
    x, slopes = _descend(best, parameters, slopes)
    least = best.disturbances.torque / best.dataset.settings.forecast_fit.cooling
    return suited(parameters.apply(best.arm, x), best.dataset, best.disturbances, least), slopes


def _is_idle(before: Prediction, after: Prediction) -> bool:
    """Whether a step gains so little that another along the same slopes is in vain."""
    numbers = before.dataset.settings.forecast_fit
    return before.cost - after.cost <= max(numbers.settled * len(before.errors), numbers.settled_share * before.cost)


def _descend(prediction: Prediction, parameters: FitParameters, slopes: Floats) -> tuple[Floats, Floats]:
    """Take damped steps under one observer: the values (values,) where they end, and the slopes that they corrected."""
    sigma = prediction.sigma.ravel()[:, None]
    numbers, prior = prediction.dataset.settings.least_squares, narrowed(parameters, prediction)
    x = parameters.position(prediction.arm)
    x, whitened = descend(one_by_one(Residual(prediction, parameters)), x, slopes / sigma, prior, numbers)
    return x, whitened * sigma


@dataclass(frozen=True)
class Residual:
    """Errors (readings,) of forecasts over their deviation, as a function of the values, under one observer."""

    prediction: Prediction
    parameters: FitParameters

    def __call__(self, x: Floats) -> Floats:
        """Compute the residual at values x."""
        errors = self.prediction.errors_of(self.parameters.apply(self.prediction.arm, x))
        return np.asarray((errors / self.prediction.sigma).ravel())


def narrowed(parameters: FitParameters, prediction: Prediction) -> Floats:
    """Narrow the priors (values,) of constants as if readings with errors in common counted once.

    Errors that a model cannot explain are correlated within a window. Without that a fit strays to constants that no machine has.
    """
    together = 1.0 + prediction.common_share * (window_samples(prediction.dataset) - 1)
    return parameters.priors / np.where(parameters.constant, np.sqrt(together), 1.0)


def error_slopes(prediction: Prediction, parameters: FitParameters) -> Floats:
    """Compute the slopes (readings, values) of forecast errors over the noise, by forward differences."""
    x = parameters.position(prediction.arm)
    widths = parameters.step_sizes(x, prediction.dataset.settings.parameters).least

    def slope(k: int) -> Floats:
        there = x.copy()
        there[k] += widths[k]
        change = prediction.errors_of(parameters.apply(prediction.arm, there)) - prediction.errors
        return np.asarray(change.ravel() / widths[k])

    columns = in_threads(slope, [(k,) for k in range(len(x))])
    return np.stack(columns, axis=1) if columns else np.zeros((prediction.errors.size, 0))


def wide_error_slopes(prediction: Prediction, parameters: FitParameters, slopes: Floats) -> Floats:
    """Compute the slopes (readings, values) by central differences at which each value changes as much as is left.

    A hub that stops a moment later rests elsewhere, so that errors are rough in the values near the noise. A difference over a
    step as wide as the model is off says more than a derivative (statistical linearisation: Chada, Chen and Sanz-Alonso, Found.
    Data Sci. 3 (2021) 331).

    Args:
        prediction: of the arm.
        parameters: of its values.
        slopes: (readings, values) known so far, from which the widths are taken.
    """
    x = parameters.position(prediction.arm)
    steps = parameters.step_sizes(x, prediction.dataset.settings.parameters)
    sigma = prediction.sigma.ravel()
    left = np.linalg.norm(prediction.errors.ravel() / sigma)
    sizes = left / np.maximum(np.linalg.norm(slopes / sigma[:, None], axis=0), LEAST_NORM)
    widths = np.clip(sizes, steps.least, steps.most)

    def slope(k: int) -> Floats:
        above, below = x.copy(), x.copy()
        above[k] += widths[k]
        below[k] -= widths[k]
        change = prediction.errors_of(parameters.apply(prediction.arm, above)) - prediction.errors_of(
            parameters.apply(prediction.arm, below)
        )
        return np.asarray(change.ravel() / (2.0 * widths[k]))

    return np.stack(in_threads(slope, [(k,) for k in range(len(x))]), axis=1)
