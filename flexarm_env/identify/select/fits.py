"""Full calibrations of candidate models, in parallel."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.calibration import Calibration
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.progress import Progress
from flexarm_env.identify.replay.error_measure import excess
from flexarm_env.identify.select.model import Model, judge
from flexarm_env.identify.select.screen import Trial, control_of
from flexarm_env.identify.select.signatures import baseline, signatures
from flexarm_env.identify.select.starts import candidates, first_start, sized
from flexarm_env.identify.workers import Task

#: The error of a brief calibration on the fitted part, and the calibration.
Brief = tuple[float, Calibration]


def fit_models(
    calibrator: Calibrator, effects: Sequence[tuple[str, ...]], arms: Sequence[Arm], progress: Progress, thorough: bool = False
) -> list[Model]:
    """Calibrate arms with the effects that they were given, as long as there is time.

    Args:
        calibrator: of the recordings.
        effects: of each arm.
        arms: where to start.
        progress: of these calibrations.
        thorough: whether each is started from the nominal constants as well.
    """
    tasks = [(fit_model, (calibrator, names, arm, thorough)) for names, arm in zip(effects, arms, strict=True)]
    return [m for m in _in_time(calibrator, tasks, [" and ".join(names) for names in effects], progress) if m]


def fit_rivals(
    calibrator: Calibrator, effects: Sequence[tuple[str, ...]], arms: Sequence[Arm], progress: Progress
) -> list[Model]:
    """Calibrate arms as rivals of a model that leaves only noise; those that cannot be any are left out.

    Args:
        calibrator: of the recordings.
        effects: of each arm.
        arms: where to start.
        progress: of these calibrations.
    """
    tasks = [(fit_rival, (calibrator, names, arm)) for names, arm in zip(effects, arms, strict=True)]
    return [m for m in _in_time(calibrator, tasks, [" and ".join(names) for names in effects], progress) if m]


def fit_rival(calibrator: Calibrator, effects: tuple[str, ...], arm: Arm, thorough: bool = False) -> Model | None:
    """Calibrate an arm with effects as a rival of a model that leaves only noise; None where it cannot be one."""
    found = calibrator.calibrate_rival(arm, thorough)
    return None if found is None else _judged(calibrator, effects, found)


def fit_model(calibrator: Calibrator, effects: tuple[str, ...], arm: Arm, thorough: bool = False) -> Model:
    """Calibrate an arm with effects; if thorough, from the nominal constants as well."""
    found = calibrator.calibrate(arm)
    if thorough:
        found = calibrator.restart_from_nominal(found)
    return _judged(calibrator, effects, found)


def _in_time(calibrator: Calibrator, tasks: Sequence[Task], added: Sequence[str], progress: Progress) -> list[Model | None]:
    """Calibrate as long as there is time, and say what was added."""
    models = []
    for model, what in zip(calibrator.workers.map_in_time(tasks), added, strict=False):
        models.append(model)
        progress.at(len(models) / len(tasks), f"refitting with {what}")
    return models


def _judged(calibrator: Calibrator, effects: tuple[str, ...], found: Calibration) -> Model:
    """Judge a calibration, settled on all of the data where it does not come close; one that does is polished if it is chosen."""
    model = judge(effects, found, calibrator.dataset)
    if model.score.windows <= calibrator.settings.errors.close:
        return model
    settled = calibrator.settle(found)
    return model if settled is found else judge(effects, settled, calibrator.dataset)


def fit_with_all_constants(
    calibrator: Calibrator, found: Calibration, trials: Sequence[Trial], tried: Sequence[str], progress: Progress
) -> list[Model]:
    """Calibrate every effect together with all constants, biased ones reset, and choose the best.

    Constants that compensate for the missing effect leave nothing for its signature to explain.

    Args:
        calibrator: of the recordings.
        found: the model that lacks something.
        trials: of the screening.
        tried: effects that were calibrated in full already.
        progress: of these calibrations.
    """
    numbers = calibrator.settings.proposing
    briefly, smaller, full = progress.split(5, 1, 4)
    names = [n for n in candidates(found.arm, calibrator.dataset) if found.arm.known[n].fitted and n not in tried]
    reset = calibrator.reset_biased_constants(found, numbers.biased)
    starts = [(n, start) for n in names for start in _starts(calibrator, n, reset, trials)]
    fits = _fit_briefly(calibrator, [("", reset), *((n, reset.with_effect(n, **start)) for n, start in starts)], briefly)
    if not fits:
        return []
    control, _ = fits.pop("")
    fits = _start_smaller(calibrator, reset, fits, control, smaller)
    enough = numbers.briefly_better * excess(control)
    better = [(error, name, fitted.arm) for name, (error, fitted) in fits.items() if excess(error) < enough]
    best = sorted(better, key=lambda fit: fit[0])[: numbers.most_brief]
    far = bool(best) and best[0][0] > calibrator.settings.errors.far_off
    return fit_models(calibrator, [(n,) for _, n, _ in best], [arm for _, _, arm in best], full, thorough=far)


def fit_in_place(
    calibrator: Calibrator,
    without: Arm,
    effects: Sequence[str],
    progress: Progress,
    replaced: Mapping[str, float] | None = None,
    thorough: bool = False,
    rivals_of_noise: bool = False,
) -> list[Model | None]:
    """Calibrate an arm with each of some effects, started where it explains most of its residual, as long as there is time.

    Args:
        calibrator: of the recordings.
        without: the arm without any of the effects.
        effects: names.
        progress: of these calibrations.
        replaced: the values of an effect in whose place they come: one of their own names may be as large.
        thorough: whether each is started from the nominal constants as well.
        rivals_of_noise: whether each is a rival of a model that leaves only noise.

    Returns:
        A model of each of the first effects; None for one that cannot be a rival.
    """
    starts = (without, replaced or {})
    tasks = [(_fit_in_place, (calibrator, effect, *starts, thorough, rivals_of_noise)) for effect in effects]
    return _in_time(calibrator, tasks, [f"{effect} instead" for effect in effects], progress)


def fit_with_companion(calibrator: Calibrator, models: Sequence[Model], progress: Progress) -> list[Model]:
    """Calibrate models with the catalogue's companion beside each: alone, either masks the other's share."""
    known, companion = calibrator.nominal.known, calibrator.nominal.known.pairing
    others = [m for m in models if m.effects != (companion,)]
    shares = calibrator.workers.map([(_share_of_companion, (calibrator, m.calibration)) for m in others])
    least = calibrator.settings.proposing.least_offset
    pairs = [m for m, share in zip(others, shares, strict=True) if share > least]
    arms = [m.arm.with_effect(companion, **known[companion].null_values()) for m in pairs]
    far = min(m.score.windows for m in models) > calibrator.settings.errors.far_off
    return fit_models(calibrator, [(*m.effects, companion) for m in pairs], arms, progress, thorough=far)


def _start_smaller(
    calibrator: Calibrator, reset: Arm, fits: dict[str, Brief], control: float, progress: Progress
) -> dict[str, Brief]:
    """Start effects anew from a smaller size where they began too large: at zero they would leave the control's error."""
    dataset = calibrator.dataset
    most = calibrator.settings.proposing.too_large * control
    names = list(fits)
    for share in calibrator.settings.screening.small:
        worse = [n for n in names if fits[n][0] > most]
        small = [(n, sized(reset, n, first_start(reset, n, dataset), share, dataset)) for n in worse]
        again = _fit_briefly(calibrator, [(n, reset.with_effect(n, **start)) for n, start in small], progress)
        fits = fits | {n: min(fit, fits[n], key=lambda f: f[0]) for n, fit in again.items()}
    return fits


def _fit_briefly(calibrator: Calibrator, arms: Sequence[tuple[str, Arm]], progress: Progress) -> dict[str, Brief]:
    """Calibrate arms briefly, as long as there is time; keep the best of each effect."""
    fits: dict[str, Brief] = {}
    results = calibrator.workers.map_in_time([(calibrator.calibrate_briefly, (arm,)) for _, arm in arms])
    for number, ((name, _), fit) in enumerate(zip(arms, results, strict=False), start=1):
        fits[name] = min(fit, fits.get(name, fit), key=lambda f: f[0])
        progress.at(number / len(arms), f"fitting {name or 'nothing'} and all constants")
    return fits


def _starts(calibrator: Calibrator, effect: str, arm: Arm, trials: Sequence[Trial]) -> list[dict[str, float]]:
    """List the starts of an effect: where its trial ended, and its own first start if that did not help."""
    control = control_of(trials).cost
    own = [(t.arm.effects[effect], t.cost < control) for t in trials if t.effect == effect]
    first = [] if any(helped for _, helped in own) else [first_start(arm, effect, calibrator.dataset)]
    return [dict(start) for start, _ in own] + first


def _fit_in_place(
    calibrator: Calibrator, effect: str, without: Arm, replaced: Mapping[str, float], thorough: bool, rivals_of_noise: bool
) -> Model | None:
    """Calibrate an arm with an effect from its signature, or from numbers of the one that it replaces where these fit better."""
    dataset = calibrator.dataset
    found = signatures(baseline(calibrator.uncalibrated(without), dataset), effect)
    start = found[0].start if found else first_start(without, effect, dataset)
    arms = [without.with_effect(effect, **start)]
    own = calibrator.nominal.known[effect].parameters
    shared = {key: value for key, value in replaced.items() if key in start and own[key].low <= value <= own[key].high}
    if shared:
        arms.append(without.with_effect(effect, **start | shared))
        arms.sort(key=lambda arm: calibrator.score(arm, held_out=False).windows)
    fit = fit_rival if rivals_of_noise else fit_model
    return fit(calibrator, (effect,), arms[0], thorough)


def _share_of_companion(calibrator: Calibrator, found: Calibration) -> float:
    """Compute the share of a calibration's residual that looks like the companion."""
    companion = found.arm.known.pairing
    return sum(signature.explained for signature in signatures(baseline(found, calibrator.dataset), companion))
