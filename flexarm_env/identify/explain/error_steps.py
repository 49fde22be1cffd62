"""The error after each step of a diagnosis: as given, constants calibrated, and with each accepted effect."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.replay.error_measure import Score
from flexarm_env.identify.select.trace import Trace

CONSTANTS = "constants"


@dataclass(frozen=True)
class ErrorStep:
    """One step of a diagnosis.

    Attributes:
        name: "constants", or an effect.
        before: held-out errors without it.
        after: those with it.
    """

    name: str
    before: Score
    after: Score


def error_steps(nominal: Score, trace: Trace, effects: Sequence[str], calibrator: Calibrator) -> list[ErrorStep]:
    """List the steps of a diagnosis, each with the errors of the model that has it and all before it, and nothing more.

    Effects that were accepted together share one model in the trace. The models between are those that the search tried, or
    calibrated briefly here; the search itself is over.

    Args:
        nominal: errors of the arm as given.
        trace: of the search.
        effects: those that the verdict names, in their order.
        calibrator: of the recordings.
    """
    scores = [nominal, trace.steps[0].model.score]
    scores += [_score_with(effects[: count + 1], trace, calibrator) for count in range(len(effects))]
    names = [CONSTANTS, *effects]
    return [ErrorStep(name, *pair) for name, *pair in zip(names, scores[:-1], scores[1:], strict=True)]


def _score_with(effects: Sequence[str], trace: Trace, calibrator: Calibrator) -> Score:
    """Find the errors of the best model that has exactly these effects beside those of the arm as given."""
    if set(effects) == set(trace.effects):
        return trace.model.score
    wanted = _present(calibrator.nominal) | set(effects)
    models = [*(step.model for step in trace.steps), *trace.chain]
    scores = [model.score for model in models if _present(model.arm) == wanted]
    tried = [one.calibration.arm for step in trace.steps for one in step.tried if one.calibration is not None]
    scores += [calibrator.score(arm) for arm in tried if not scores and _present(arm) == wanted]
    return min(scores or [_brief_score(wanted, trace, calibrator)], key=lambda score: score.windows)


def _brief_score(effects: set[str], trace: Trace, calibrator: Calibrator) -> Score:
    """Calibrate the final model briefly without its other effects."""
    arm = trace.model.arm
    kept = {name: values for name, values in arm.effects.items() if name in effects}
    with calibrator.workers.threads():
        _, calibration = calibrator.calibrate_briefly(replace(arm, effects=kept))
    return calibrator.score(calibration.arm)


def _present(arm: Arm) -> set[str]:
    """Select the effects of an arm that are not at zero."""
    return {name for name, values in arm.effects.items() if not arm.known[name].absent(values)}
