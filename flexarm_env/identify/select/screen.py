"""Screen every effect that an arm could lack: each fitted alone from its most promising start, with the constants following."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.calibration import Calibration
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.calibrate.least_squares import Ending, minimise
from flexarm_env.identify.calibrate.objective import Objective
from flexarm_env.identify.calibrate.parameters import FitParameters, effect_parameters
from flexarm_env.identify.progress import Progress
from flexarm_env.identify.select.signatures import Baseline, Signature, baselines, promising
from flexarm_env.identify.select.starts import candidates


@dataclass(frozen=True)
class Trial:
    """An effect fitted with the constants following along their known slopes.

    Attributes:
        effect: its name; "" for none.
        arm: with the fitted values.
        cost: on the fitted part.
        held_out: sum of squares on the held-out part.
    """

    effect: str
    arm: Arm
    cost: float
    held_out: float


@dataclass(frozen=True)
class Screening:
    """Trials of a screening.

    Attributes:
        trials: that of each effect which explains anything, and that of none; the best first, by the cost on the held-out part.
        untried: effects for which no time was left.
    """

    trials: list[Trial]
    untried: tuple[str, ...] = ()


def screen(calibrator: Calibrator, starts: Sequence[Calibration], progress: Progress, briefly: bool = False) -> Screening:
    """Try every effect from some calibrations, and none, as long as there is time; briefly where only noise is left."""
    names, number = candidates(starts[0].arm, calibrator.dataset), 0
    with calibrator.workers.threads():
        bases = baselines(starts, calibrator.dataset)
        trials = [attempt(bases[0], None)]
    tasks = [(try_effect, (bases, name, briefly)) for name in names]
    for number, found in enumerate(calibrator.workers.map_in_time(tasks), start=1):
        trials += found
        progress.at(number / len(tasks), f"trying {len(names)} effects")
    return Screening(sorted(trials, key=lambda trial: trial.held_out), tuple(names[number:]))


def try_effect(bases: Sequence[Baseline], name: str, briefly: bool = False) -> list[Trial]:
    """Fit an effect from the calibration and the start from which it promises to leave least, if it explains anything."""
    return [attempt(base, signature) for base, signature in promising(bases, name, briefly)]


def attempt(base: Baseline, signature: Signature | None) -> Trial:
    """Fit an effect from a start, or none, with the constants following along their known slopes."""
    arm, dataset, screening = base.arm, base.objective.dataset, base.numbers
    name = "" if signature is None else signature.effect
    if signature is not None:
        arm = arm.with_effect(name, **signature.start)
    added = effect_parameters(arm, name, dataset) if name else FitParameters()
    prior = np.concatenate([base.objective.weights.prior, added.priors])
    weights = replace(base.objective.weights, prior=prior)
    objective = Objective(
        arm, dataset, base.objective.parameters + added, base.objective.torque_noise, weights, base.objective.reduced
    )
    start = added.position(arm)
    steps, x = added.step_sizes(start, dataset.settings.parameters), np.concatenate([base.x, start])
    ending = Ending(screening.iterations, screening.tolerance)
    solution = minimise(objective.residuals, x, prior, steps, dataset.settings.least_squares, ending, base.jacobian)
    best = objective.parameters.apply(arm, solution.x)
    held_out = objective.held_out_residual_of(best)
    return Trial(name, best, solution.cost, float(held_out @ held_out))


def control_of(trials: Sequence[Trial]) -> Trial:
    """Find the trial of no effect."""
    return next(trial for trial in trials if not trial.effect)
