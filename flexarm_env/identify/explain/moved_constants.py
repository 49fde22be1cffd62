"""Constants that a fit moved far from their priors."""

from __future__ import annotations

from flexarm_env.identify.calibrate.calibration import Calibration
from flexarm_env.identify.settings import Explaining


def moved_notes(found: Calibration, numbers: Explaining) -> list[str]:
    """Describe each constant that a calibration moved by more than some standard deviations of its prior.

    Such a value makes up for something: a datum that is wrong, a constant that is not fitted, or an effect that is missing.

    Args:
        found: the calibrated arm.
        numbers: how many.
    """
    notes = []
    for parameter, x in found.parameters.pairs(found.solution.x):
        deviations = abs(x) / parameter.prior
        if parameter.is_constant and deviations > numbers.moved_far:
            unit = found.arm.parameter(parameter.path).unit
            ends = f"{parameter.origin:.3g} → {parameter.value(x):.3g} {unit}".rstrip()
            moved = f"{parameter.path} moved by {deviations:.1f} standard deviations of its prior ({ends})"
            notes.append(f"{moved}: check its value, and those of the constants that a fit leaves alone")
    return notes
