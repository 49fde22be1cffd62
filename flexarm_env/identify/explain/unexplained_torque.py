"""The torque on a moving hub that an arm leaves unexplained, as one number in Nm."""

from __future__ import annotations

import math

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.explain.hub_torque import acts_on_hub, hub_torque_of, law_torque
from flexarm_env.identify.replay.dataset import Dataset


def unexplained_torque(arm: Arm, dataset: Dataset) -> float:
    """Compute the rms torque [Nm] on the hub, estimated from the recordings, less that of the arm's effects.

    It is that of fast motion, where the direction of friction is certain, and a moving mean, which holds less of the noise of
    the sensors. It is NaN where no torque can be estimated: nothing moves, sampling is uneven, or the sensors do not show the
    hub.

    Args:
        arm: with its effects, and the sensors of the dataset.
        dataset: the recordings, at the samples that were kept of them.
    """
    try:
        motions = hub_torque_of(arm, dataset)
    except np.linalg.LinAlgError:  # no steady filter: the sensors do not see the hub
        return math.nan
    names = [name for name in arm.effects if acts_on_hub(arm, name)]
    numbers = dataset.settings.explaining
    fastest = max((float(np.abs(one.speed).max(initial=0.0)) for one in motions), default=0.0)
    window = np.ones(2 * int(numbers.smoothing / dataset.interval) + 1)
    left = []
    for one in motions:
        moves = np.abs(one.speed) > numbers.fast * fastest
        rest = np.zeros(len(moves))
        rest[moves] = one.torque[moves] - law_torque(arm, names, one.angle[moves], one.speed[moves], one.time[moves])
        sums, counts = (np.convolve(values, window)[len(window) // 2 :][: len(moves)] for values in (rest, moves))
        left.append(sums[moves] / counts[moves])
    every = np.concatenate([np.zeros(0), *left])
    return float(np.sqrt(np.mean(every**2))) if len(every) else math.nan
