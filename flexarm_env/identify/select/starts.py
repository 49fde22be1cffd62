"""Which effects an arm could lack, and the values from which each of them is tried."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.effects.base import Effect
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.select.followed import follows_sine

#: Values of an effect, and the change (rows,) of the errors that they make and no constant could.
Change = tuple[dict[str, float], NDArray[np.float64]]


def candidates(arm: Arm, dataset: Dataset) -> list[str]:
    """List the effects that an arm could lack, and that readings can follow from some start."""
    elements = arm.constants.get("beam", {}).get("elements", 0.0)
    lacking = [n for n, e in arm.known.items() if n not in arm.effects and arm.can_have(n) and elements <= e.most_elements]
    whole = [n for n in lacking if not arm.known[n].modifies or arm.known[n].modifies in arm.effects]
    return [n for n in whole if starts_of(arm, n, dataset)]


def rivals_of(effect: str, without: Arm, dataset: Dataset) -> list[str]:
    """List the effects that an effect is confused with, of those that an arm without it lacks.

    There are none for one that another effect of the arm modifies, which could not stand without it.
    """
    known = without.known
    if any(known[n].modifies == effect for n in without.effects):
        return []
    return [n for n in candidates(without, dataset) if n in known[effect].confused_with or effect in known[n].confused_with]


def simpler_beyond(effect: str, without: Arm, dataset: Dataset) -> list[str]:
    """List the effects of fewer numbers with which the rivals of an effect are confused, and it is not."""
    known, near = without.known, rivals_of(effect, without, dataset)
    beyond = {n for r in near for n in rivals_of(r, without, dataset)} - {effect, *near}
    return [n for n in candidates(without, dataset) if n in beyond and len(known[n].parameters) < len(known[effect].parameters)]


def shows_part_of_period(arm: Arm, effect: str, dataset: Dataset) -> bool:
    """Whether an effect of an arm is a sine of the angle of which the motion shows less than one period.

    Such a part of a sine is as smooth as other torques of the angle are.
    """
    if "arm_angle" not in dataset.signals:
        return False
    column = dataset.signals.index("arm_angle")
    widest = max(float(run.extent[column]) for run in dataset.runs)
    return arm.known[effect].cycles_per_turn(arm.effects[effect]) * widest < 2.0 * math.pi


def starts_of(arm: Arm, effect: str, dataset: Dataset) -> list[dict[str, float]]:
    """List the values from which an effect is tried, in the scales of the data; for offsets, one start for each sensor.

    A sine of the angle that the readings outrun is tried from none: what they show of it is an alias.
    """
    known = arm.known[effect]
    if known.per_sensor:
        noise = dict(zip(dataset.signals, dataset.noise, strict=True))
        sizes = {signal: min(float(deviation), known.parameters[signal].high) for signal, deviation in noise.items()}
        sensors = [{key: (sizes[key] if key == signal else 0.0) for key in known.parameters} for signal in sizes]
        return [start for _ in known.starts() for start in sensors]
    every = [_scaled(arm, effect, start, dataset) for start in known.starts()]
    return [start for start in every if follows_sine(arm, known.cycles_per_turn(start), dataset)]


def some_starts_of(arm: Arm, effect: str, dataset: Dataset) -> list[dict[str, float]]:
    """List few of these, where no more than noise is left to tell them apart: of a periodic effect, slow to fast."""
    starts = starts_of(arm, effect, dataset)
    return starts[:: -(-len(starts) // dataset.settings.detection.most_starts)]


def first_start(arm: Arm, effect: str, dataset: Dataset) -> dict[str, float]:
    """Choose the values from which an effect is tried first."""
    return _scaled(arm, effect, arm.known[effect].starts()[0], dataset)


def changes_in_proportion(
    arm: Arm,
    effect: str,
    start: dict[str, float],
    change: Callable[[dict[str, float]], NDArray[np.float64]],
    left: NDArray[np.float64],
    dataset: Dataset,
) -> list[Change]:
    """Try a start, and smaller sizes as long as the change that it makes is out of proportion to the errors.

    Where friction holds an arm that moves freely, or a delay exceeds a period, the change says nothing of small sizes. Nor does
    it where it is larger than the errors and enlarges them: a vibration that became slower by too much is as wrong as before.

    Args:
        arm: without the effect.
        effect: its name.
        start: its values.
        change: computes the change (rows,) of the errors by the effect's values.
        left: (rows,) the errors.
        dataset: the recordings.
    """
    found: list[Change] = []
    numbers = dataset.settings.screening
    known, errors = arm.known[effect], float(np.linalg.norm(left))
    one_way = not (has_two_signs(known) or known.scan_phase)
    for _ in range(numbers.shrinks):
        found.append((start, change(start)))
        size = float(np.linalg.norm(found[-1][1]))
        far = errors < numbers.in_proportion * size
        worse = one_way and size > errors and float(found[-1][1] @ left) > 0.0
        if not (far or worse) or not known.fitted:
            break
        start = sized(arm, effect, start, errors / size if far else numbers.in_proportion, dataset)
    return found


def has_two_signs(effect: type[Effect]) -> bool:
    """Whether the size of a fitted effect may be negative."""
    return effect.fitted and effect.parameters[effect.size_parameter()].low < 0.0


def sized(arm: Arm, effect: str, start: Mapping[str, float], factor: float, dataset: Dataset) -> dict[str, float]:
    """Multiply the size of an effect, within bounds."""
    sizes = {key: p for key, p in arm.known[effect].parameters.items() if p.null is not None}
    return {**start, **{key: p.times(start[key], factor, dataset.scales) for key, p in sizes.items()}}


def _scaled(arm: Arm, effect: str, start: Mapping[str, float], dataset: Dataset) -> dict[str, float]:
    """Convert a start to the scales of the data, and places to its travel, within the bounds."""
    parameters = arm.known[effect].parameters
    values = {key: p.typical for key, p in parameters.items()}
    values |= {key: value * parameters[key].scaled_by(dataset.scales) for key, value in start.items()}
    values |= {key: value + dataset.middle_of_travel for key, value in values.items() if parameters[key].of_travel}
    return {key: min(max(v, parameters[key].low), parameters[key].high) for key, v in values.items()}
