"""SINDy on residuals: the torque that the refitted arm does not explain, as a sparse sum of the effects' laws.

Sparse identification of nonlinear dynamics (Brunton, Proctor and Kutz, PNAS 113 (2016) 3932), by pysindy's sequentially
thresholded least squares, on the hub's torque as estimated by a smoother. It detects effects on the hub only.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pysindy import STLSQ

from benchmarks.hidden_effects.baselines import answer
from flexarm_env import Arm, Recording
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.explain.hub_torque import acts_on_hub, hub_torque, law_torque
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.select.starts import first_start

Floats = NDArray[np.float64]

#: Smallest coefficient of a term, for columns and a residual of unit length; smallest share of an effect in its power.
THRESHOLD, LEAST_SHARE = 0.1, 0.05
#: Share of the largest speed above which the hub counts as moving; every so many samples are taken.
MOVING, EVERY = 0.05, 5
CYCLES, FALLOFFS, WARMING = range(1, 13), (0.1, 0.2, 0.4), (2.0, 5.0)
#: Terms that a fit of the constants can absorb.
CONSTANTS = ("viscous", "coulomb")


def terms(angle: Floats, speed: Floats, time: Floats) -> Iterator[tuple[str, Floats]]:
    """Yield the name of an effect and one candidate shape of its torque (samples,)."""
    against = -np.sign(speed)
    yield "viscous", -speed
    yield "coulomb", against
    yield "constant_torque", np.ones_like(speed)
    yield "asymmetric_viscous", -np.abs(speed)
    yield "cable_stiffness", -angle
    yield "air_drag", -np.abs(speed) * speed
    for shape in (np.sin(angle), np.cos(angle)):
        yield "base_tilt", shape
    for cycles in CYCLES:
        for shape in (np.sin(cycles * angle), np.cos(cycles * angle)):
            yield "cogging", shape
            yield "position_friction", against * shape
    for falloff in FALLOFFS:
        yield "stribeck", against * np.exp(-((speed / falloff) ** 2))
    for time_constant in WARMING:
        yield "friction_warmup", -against * (1.0 - np.exp(-time / time_constant))


def sparse_effects(arm: Arm, recordings: Sequence[Recording]) -> list[str]:
    """Select the effects with remaining terms, sorted by the share of the residual torque that they explain."""
    motions = hub_torque(arm, recordings)
    time, angle, speed, torque = (np.concatenate([getattr(m, k) for m in motions]) for k in ("time", "angle", "speed", "torque"))
    moves = np.flatnonzero(np.abs(speed) > MOVING * np.abs(speed).max())[::EVERY]
    time, angle, speed, torque = time[moves], angle[moves], speed[moves], torque[moves]
    own = [name for name in arm.effects if acts_on_hub(arm, name)]
    left = torque - law_torque(arm, own, angle, speed, time)
    names, columns = zip(*terms(angle, speed, time), strict=True)
    library = np.stack([column / np.linalg.norm(column) for column in columns], axis=1)
    with warnings.catch_warnings():  # an empty set of terms is a valid answer
        warnings.filterwarnings("ignore", "Sparsity parameter is too big", UserWarning)
        found = STLSQ(threshold=THRESHOLD).fit(library, (left / np.linalg.norm(left))[:, None]).coef_[0]
    shares = {name: 0.0 for name in names if name not in CONSTANTS}
    for name in shares:
        part = library @ (found * np.array([name == other for other in names]))
        shares[name] = float(part @ part)
    kept = [name for name, share in shares.items() if share > LEAST_SHARE]
    return sorted(kept, key=lambda name: -shares[name])


def sindy_on_residuals(arm: Arm, recordings: Sequence[Recording]) -> dict[str, Any]:
    """Name the effects that SINDy finds in the refitted arm's residual torque, and refit the arm with the first three."""
    calibrator = Calibrator(*prepare(arm, recordings))
    base = found = calibrator.calibrate_constants()
    effects = sparse_effects(base.arm, recordings)[:3]
    if effects:
        with_them = base.arm
        for name in effects:
            with_them = with_them.with_effect(name, **first_start(with_them, name, calibrator.dataset))
        found = calibrator.calibrate(with_them)
    return answer(effects, calibrator, base, found)
