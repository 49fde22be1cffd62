"""One number of an episode: the mean logarithm of settling time, steady error and residual strain."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

#: Least values in a logarithm, far below the sensors' resolution: [s], [deg], [V].
LEAST = {"settling_time": 0.005, "steady_error": 1e-3, "residual_strain": 1e-4}
#: Share of the arms that counts as the worst ones.
WORST = 0.1


def cost(values: Mapping[str, Floats]) -> Floats:
    """Compute the mean logarithm (…, episodes) of settling time, steady error and residual strain.

    Of an arm without a beam, or without a gage at its base, the strain is 0 throughout: the other two count.

    Examples:
        >>> rigid = {"settling_time": np.array([2.0]), "steady_error": np.array([0.5]), "residual_strain": np.zeros(1)}
        >>> round(float(np.exp(cost(rigid)[0])), 9)
        1.0
    """
    counted = [name for name in LEAST if name != "residual_strain" or np.any(values[name])]
    found: Floats = np.mean([np.log(np.maximum(values[name], LEAST[name])) for name in counted], axis=0)
    return found


def worst_tenth(values: Floats) -> Floats:
    """Compute the mean of the largest tenth of values (…, episodes): a part of an episode counts by its share.

    Examples:
        >>> float(worst_tenth(np.arange(20.0)))
        18.5
        >>> float(worst_tenth(np.array([1.0, 2.0, 3.0])))
        3.0
    """
    ordered = np.sort(values, axis=-1)[..., ::-1]
    count = max(WORST * ordered.shape[-1], 1.0)
    weights = np.clip(count - np.arange(ordered.shape[-1]), 0.0, 1.0) / count
    found: Floats = np.asarray((ordered * weights).sum(axis=-1))
    return found
