"""Intervals of calibrated values: scatter of the fit, common scale of forces, and bias by what is unexplained."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.calibration import Calibration
from flexarm_env.identify.calibrate.common_scale import AlongScale, along_scale, force_powers, scale_deviation
from flexarm_env.identify.calibrate.estimate import Estimate
from flexarm_env.identify.calibrate.least_squares import covariance, slopes
from flexarm_env.identify.calibrate.parameters import FitParameter

Floats = NDArray[np.float64]


def estimates(calibration: Calibration, nominal: Arm) -> list[Estimate]:
    """Estimate every fitted value with its 90 % interval.

    The standard deviation holds the scatter of the fit (sandwich), the common scale of forces, and, by the share of the errors
    that is unexplained, how far the value moved when the held-out part came in and the exactness of a wrong model; besides, the
    exactness that no model exceeds.

    Args:
        calibration: of the arm.
        nominal: the arm before it.
    """
    parameters, x = calibration.parameters, calibration.solution.x
    objective = calibration.objective
    numbers = objective.dataset.settings.intervals
    objective = replace(objective, weights=replace(objective.weights, sigma=calibration.rms_errors, prior=parameters.priors))
    along = along_scale(objective, x, force_powers(calibration.arm, parameters))
    spreads = _spreads(calibration, along)
    scatter = np.max([np.diag(along.beside @ spread @ along.beside.T) for spread in spreads], axis=0)
    common = max(scale_deviation(along, parameters, x, spread) for spread in spreads)
    bias = np.hypot(numbers.best_model, np.sqrt(calibration.unexplained) * numbers.wrong_model)
    sizes = [abs(p.value(v)) / p.scale if p.scale else 1.0 for p, v in parameters.pairs(x)]
    moved = 0.0 if calibration.moved is None else calibration.moved
    sigma = np.sqrt(scatter + np.square(moved) + np.square(bias * np.array(sizes)) + np.square(common * along.x))
    triples = zip(parameters, x, sigma, strict=True)
    return [_estimate(p, float(v), float(numbers.quantile * s), nominal) for p, v, s in triples]


def _estimate(parameter: FitParameter, x: float, half_width: float, nominal: Arm) -> Estimate:
    low, high = sorted((parameter.value(x - half_width), parameter.value(x + half_width)))
    section, *rest = parameter.path.split(".")
    known = section != "effects" or rest[0] in nominal.effects
    before = nominal.value(parameter.path) if known else float(nominal.known[rest[0]].parameters[rest[1]].null or 0.0)
    unit = nominal.parameter(parameter.path).under(nominal.input).unit
    return Estimate(parameter.path, parameter.value(x), low, high, unit, before)


def _spreads(calibration: Calibration, along: AlongScale) -> list[Floats]:
    """Estimate the covariance of x (x, x) from the residual, weighed by what is left, by wide differences and by narrow ones.

    Those as wide as the fit's show motion where values that change together leave none. Narrow ones show changes that sticking
    covers. Of both, the one that gives more counts.
    """
    objective, solution = calibration.objective, calibration.solution
    settings, x, prior = objective.dataset.settings, solution.x, objective.parameters.priors
    block = max(int(settings.intervals.block / objective.dataset.interval), 1) * len(objective.dataset.signals)
    narrow = calibration.narrow
    if narrow is None:
        narrow = slopes(objective.residuals, x, solution.residual, np.full(len(x), settings.refining.difference))
    by_left = objective.rows_of(objective.weights.sigma / calibration.rms_errors)
    slopes_by_left = [along.correct(changes * by_left[:, None]) for changes in (solution.jacobian, narrow)]
    return [covariance(changes, solution.residual * by_left, prior, block) for changes in slopes_by_left]
