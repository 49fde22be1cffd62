"""Calibrate an arm's constants, and add one effect to it."""

from __future__ import annotations

import time
from collections.abc import Sequence

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.identify.calibrate.calibration import Calibration
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.calibrate.estimate import Estimate
from flexarm_env.identify.calibrate.intervals import estimates
from flexarm_env.identify.calibrate.parameters import free_parameters
from flexarm_env.identify.explain.moved_constants import moved_notes
from flexarm_env.identify.origin import with_origin
from flexarm_env.identify.progress import Progress, ProgressCallback
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.error_measure import closed_loop_errors
from flexarm_env.identify.replay.hold_out import hold_out_notes
from flexarm_env.identify.results import Addition, Fit
from flexarm_env.identify.select.screen import attempt
from flexarm_env.identify.select.signatures import baselines, signatures
from flexarm_env.identify.settings import SETTINGS, Settings
from flexarm_env.identify.workers import Workers
from flexarm_env.recordings.recording import Recording


def fit(
    arm: Arm,
    recordings: Sequence[Recording],
    progress: ProgressCallback | None = None,
    seed: int = 0,
    jobs: int = 2,
    settings: Settings = SETTINGS,
    rate: float | None = None,
) -> Fit:
    """Calibrate the constants of an arm.

    Args:
        arm: the model; its values are the centres of the priors.
        recordings: of the machine; the last part of each is held out.
        progress: called with the share done and a text.
        seed: recorded with the result.
        jobs: threads.
        settings: numbers of the method.
        rate: samples per second [Hz] that are kept; 0 keeps all. By default, as many as the arm needs.

    Raises:
        InputError: for recordings that do not fit the arm, and for an arm that leaves nothing to fit.

    Example:
        >>> from flexarm_env import Arm, fit, simulate
        >>> arm = Arm.load("cu-rigid")
        >>> machine = arm.with_values({"hub.inertia": 1.1 * arm.value("hub.inertia")})
        >>> found = fit(arm, [simulate(machine, "pulse", duration=2.0, rate=200.0)])
        >>> found.error["refitted"] < found.error["nominal"]
        True
    """
    began, say = time.perf_counter(), Progress.to(progress)
    nominal, dataset = prepare(arm, recordings, settings, rate)
    if not free_parameters(nominal, nominal, dataset):
        raise InputError(
            f"arm '{arm.name}' leaves nothing to fit: every constant is fixed, known exactly or 0; "
            "take names out of `fixed`, or add an effect with `flexarm add`"
        )
    workers = Workers(jobs)
    say.at(0.0, "refitting the constants")
    with workers.threads():
        calibrator, found = Calibrator(nominal, dataset, workers).choose_hold_out()
        before, after = calibrator.score(nominal), calibrator.score(found.arm)
        final = calibrator.calibrate_on_all_data(found)
        values = estimates(final, nominal)
    say.at(1.0, "done")
    return Fit(
        arm=with_origin(arm, final.arm, values, recordings, "fit", seed, settings),
        estimates=values,
        error={"nominal": before.windows, "refitted": after.windows},
        free_run={"nominal": before.free_run, "refitted": after.free_run},
        seconds=time.perf_counter() - began,
        settings=settings,
        closed_loop=closed_loop_errors({"nominal": nominal, "refitted": found.arm}, calibrator.dataset),
        notes=[*dataset.notes, *hold_out_notes(calibrator.dataset), *moved_notes(final, settings.explaining)],
    )


def add(
    effect: str,
    arm: Arm,
    recordings: Sequence[Recording],
    progress: ProgressCallback | None = None,
    seed: int = 0,
    jobs: int = 2,
    settings: Settings = SETTINGS,
    rate: float | None = None,
) -> Addition:
    """Add one effect to an arm and calibrate everything.

    Args:
        effect: name of the effect.
        arm: the model.
        recordings: of the machine; the last part of each is held out.
        progress: called with the share done and a text.
        seed: recorded with the result.
        jobs: threads.
        settings: numbers of the method.
        rate: samples per second [Hz] that are kept; 0 keeps all. By default, as many as the arm needs.

    Raises:
        InputError: for an unknown effect, one that the arm has already or cannot have, or recordings that do not fit.

    Example:
        >>> from flexarm_env import Arm, add, simulate
        >>> arm = Arm.load("cu-rigid")
        >>> machine = arm.with_effect("coulomb", torque=0.05)
        >>> found = add("coulomb", arm, [simulate(machine, "pulse", duration=2.0, rate=200.0)])
        >>> round(found.arm.value("effects.coulomb.torque"), 2)
        0.05
    """
    began, say = time.perf_counter(), Progress.to(progress)
    if effect in arm.effects and not arm.known[effect].absent(arm.effects[effect]):
        raise InputError(f"arm '{arm.name}' has effect '{effect}' already; `flexarm fit` refits it")
    arm.with_effect(effect)
    constants, adding = say.split(2, 3)
    nominal, dataset = prepare(arm.without_effect(effect), recordings, settings, rate)
    constants.at(0.0, "refitting the constants")
    workers = Workers(jobs)
    with workers.threads():
        calibrator, base = Calibrator(nominal, dataset, workers).choose_hold_out()
        adding.at(0.0, f"adding {effect}")
        found = calibrate_with_effect(calibrator, base, effect)
        arms = (nominal, base.arm, found.arm)
        scores = [calibrator.score(one) for one in arms]
        final = calibrator.calibrate_on_all_data(found)
        values = _effect_first(estimates(final, nominal), effect)
    adding.at(1.0, "done")
    names = ("nominal", "refitted", "final")
    return Addition(
        arm=with_origin(arm, final.arm, values, recordings, f"add {effect}", seed, settings),
        effect=effect,
        estimates=values,
        error={name: s.windows for name, s in zip(names, scores, strict=True)},
        free_run={name: s.free_run for name, s in zip(names, scores, strict=True)},
        seconds=time.perf_counter() - began,
        settings=settings,
        closed_loop=closed_loop_errors(dict(zip(names, arms, strict=True)), calibrator.dataset),
        notes=[*dataset.notes, *hold_out_notes(calibrator.dataset), *moved_notes(final, settings.explaining)],
    )


def calibrate_with_effect(calibrator: Calibrator, base: Calibration, effect: str) -> Calibration:
    """Calibrate an arm with one effect more, from its best start beside calibrated or nominal constants."""
    bases = baselines((base, calibrator.uncalibrated(calibrator.nominal)), calibrator.dataset)
    trials = [attempt(b, signature) for b in bases for signature in signatures(b, effect)]
    start = min(trials, key=lambda trial: trial.held_out).arm if trials else base.arm.with_effect(effect)
    return calibrator.polish(calibrator.calibrate(start))


def _effect_first(values: list[Estimate], effect: str) -> list[Estimate]:
    return sorted(values, key=lambda e: not e.path.startswith(f"effects.{effect}."))
