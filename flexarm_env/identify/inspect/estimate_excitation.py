"""Estimate the excitation of an arm by recordings, before anything is fitted.

The measure is the innovations of the arm as given, weighed by the noise. The limits hold for an arm near the truth: its present
error is no part of them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.common_scale import AlongScale, along_scale, force_powers
from flexarm_env.identify.calibrate.least_squares import jacobian
from flexarm_env.identify.calibrate.objective import Objective, Weights
from flexarm_env.identify.calibrate.parameters import FitParameter, free_parameters
from flexarm_env.identify.inspect.excitation import (
    DETECTABLE,
    NOT_EXCITED,
    NOT_SHOWN,
    SHOWN,
    TOO_SMALL,
    ConstantExcitation,
    EffectExcitation,
    Excitation,
)
from flexarm_env.identify.progress import Progress, ProgressCallback
from flexarm_env.identify.replay.dataset import Dataset, prepare
from flexarm_env.identify.replay.error_measure import error_measure
from flexarm_env.identify.replay.observer import innovation_sigma
from flexarm_env.identify.replay.scales import torque_scale
from flexarm_env.identify.select.effect_size import Rise, sizeable, smallest_detectable
from flexarm_env.identify.select.signatures import Baseline, baseline_of
from flexarm_env.identify.settings import FAILED_ERROR, SETTINGS, Settings
from flexarm_env.recordings.recording import Recording

Floats = NDArray[np.float64]


def estimate_excitation(
    arm: Arm, recordings: Sequence[Recording], progress: ProgressCallback | None = None, settings: Settings = SETTINGS
) -> Excitation:
    """Estimate how exactly recordings would show an arm's constants, and the smallest effects that they would show.

    Args:
        arm: as given; it counts as near the truth.
        recordings: of the machine.
        progress: called with the share done and a text.
        settings: numbers of the method.

    Raises:
        InputError: for recordings that do not fit the arm.

    Example:
        >>> from flexarm_env import Arm, simulate
        >>> arm = Arm.load("cu-rigid")
        >>> found = estimate_excitation(arm, [simulate(arm, "pulse", duration=2.0, rate=200.0)])
        >>> [one.state for one in found.effects if one.effect == "coulomb"]
        ['detectable']
    """
    return excitation_of(*prepare(arm, recordings, settings), Progress.to(progress))


def excitation_of(arm: Arm, dataset: Dataset, progress: Progress) -> Excitation:
    """Estimate the excitation of an arm by a dataset.

    Args:
        arm: as given, with the sensors of the dataset.
        dataset: the recordings.
        progress: of the work.
    """
    constants, effects = progress.split(1, 9)
    constants.at(0.0, "constants")
    base = _baseline(arm, dataset)
    rise_of = _rise_against(arm, dataset)
    names = sizeable(arm, dataset)
    found = []
    for number, name in enumerate(names):
        effects.at(number / len(names), name)
        found.append(_effect(base, name, rise_of))
    along = along_scale(base.objective, base.x, force_powers(base.arm, base.objective.parameters))
    return Excitation(tuple(_constants(base, along)), tuple(found), _common_scale(base, along))


def _baseline(arm: Arm, dataset: Dataset) -> Baseline:
    """Build the baseline of the arm as given, over steps that change each reading by about its noise."""
    settings = dataset.settings
    parameters = free_parameters(arm, arm, dataset)
    own = arm.constants["drive"]["torque_noise"]
    plants = dataset.plants(arm)
    sigma = np.array([innovation_sigma(plants[run.stated], dataset, own) for run in dataset.runs])
    level = max(settings.process_noise.detection * torque_scale(arm, dataset.runs), own)
    objective = Objective(arm, dataset, parameters, level, Weights(sigma, parameters.priors, sigma))
    steps = parameters.step_sizes(parameters.position(arm), settings.parameters)
    wide = baseline_of(objective, steps.now)
    return baseline_of(objective, steps.adapted(np.ones(len(wide.residual)), wide.jacobian, grow=True).now)


def _constants(base: Baseline, along: AlongScale) -> list[ConstantExcitation]:
    """Estimate the interval of each constant, over wide differences and over narrow ones, whichever gives more."""
    objective, settings = base.objective, base.objective.dataset.settings
    parameters = objective.parameters
    narrow = jacobian(objective.residuals, base.x, np.full(len(base.x), settings.refining.difference))
    posterior = np.maximum(_deviations(base.jacobian, along), _deviations(narrow, along))
    triples = zip(parameters, parameters.priors, posterior, strict=True)
    return [_constant(base.arm, parameter, float(prior), float(after), settings) for parameter, prior, after in triples]


def _deviations(slopes: Floats, along: AlongScale) -> Floats:
    """Estimate the standard deviations (x,) that slopes of the innovations (rows, x) and the priors leave."""
    return np.asarray(np.sqrt(np.diag(_posterior(slopes, along))), dtype=np.float64)


def _posterior(slopes: Floats, along: AlongScale) -> Floats:
    """Estimate the covariance of x (x, x) that slopes of the innovations (rows, x) and the priors leave."""
    exact = along.correct(slopes)
    return np.asarray(np.linalg.inv(exact.T @ exact + np.diag(along.prior**-2.0)), dtype=np.float64)


def _constant(arm: Arm, parameter: FitParameter, prior: float, posterior: float, settings: Settings) -> ConstantExcitation:
    value = arm.value(parameter.path)
    per_x = parameter.scale or abs(value)
    best = settings.intervals.best_model * abs(value) / per_x
    width = settings.intervals.quantile * per_x
    state = SHOWN if posterior <= settings.excitation.shown * prior else NOT_SHOWN
    half_width = width * min(math.hypot(posterior, best), prior)
    return ConstantExcitation(parameter.path, value, half_width, width * prior, arm.parameter(parameter.path).unit, state)


def _common_scale(base: Baseline, along: AlongScale) -> str:
    """Judge whether the innovations give the common scale better than the priors together."""
    if not along.is_open:
        return ""
    variance = float(along.share @ _posterior(base.jacobian, along) @ along.share)
    shown = base.objective.dataset.settings.excitation.shown
    return SHOWN if along.of_priors * variance <= shown**2 else NOT_SHOWN


def _rise_against(arm: Arm, dataset: Dataset) -> Rise:
    """Measure how far an effect drives the readings in windows from those of the arm without it, where they were measured."""
    without = error_measure(arm).brief_readings(arm, dataset)
    measured = np.concatenate([np.isfinite(run.measured[~run.train]) for run in dataset.runs])

    def rise_of(changed: Arm) -> tuple[float, float]:
        pairs = zip(error_measure(changed).brief_readings(changed, dataset), without, strict=True)
        change = np.concatenate([one - other for one, other in pairs])[measured]
        return 0.0, float(np.mean(np.nan_to_num(change, nan=FAILED_ERROR, posinf=FAILED_ERROR, neginf=FAILED_ERROR) ** 2))

    return rise_of


def _effect(base: Baseline, name: str, rise_of: Rise) -> EffectExcitation:
    """Estimate the smallest size of an effect that would be accepted, and compare it with its typical size."""
    dataset = base.objective.dataset
    known = base.arm.known[name].parameters
    found = smallest_detectable(base, name, rise_of)
    key = found.key if found else next(key for key, p in known.items() if p.null is not None)
    parameter = known[key]
    typical = parameter.typical * parameter.scaled_by(dataset.scales)
    unit = parameter.under(base.arm.input).unit
    falls = parameter.null == math.inf
    sizes = math.inf if found is None else typical / found.value if falls else found.value / typical
    if found is None or sizes > dataset.settings.excitation.most_sizes:
        return EffectExcitation(name, key, None, typical, unit, math.inf, falls, NOT_EXCITED)
    return EffectExcitation(name, key, found.value, typical, unit, sizes, falls, DETECTABLE if sizes <= 1 else TOO_SMALL)
