"""An effect's own curve: torque estimated from the recordings against its driver, beside the fitted law."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.identify.explain.hub_torque import HubMotion, acts_on_hub, arguments, changes, hub_torque_of, law_torque
from flexarm_env.identify.replay.build_run import with_sensors
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.settings import Explaining

Floats = NDArray[np.float64]

UNITS = {"speed": "rad/s", "angle": "rad", "time": "s"}


@dataclass(frozen=True)
class EffectCurve:
    """Torque against its driver.

    Attributes:
        effect: the catalogue's name; "" for a torque that no effect explains.
        driver: "speed" [rad/s], "angle" [rad] or "time" [s] of the hub.
        quantity: the torque's name in words.
        x: (points,) the driver at single samples.
        y: (points,) the data's estimate there [Nm].
        bins: (bins,) the driver.
        middle: (bins,) median of the data's estimate [Nm].
        low: (bins,) its lower quartile.
        high: (bins,) its upper quartile.
        line: (points,) the driver.
        fitted: (points,) the law of the corrected arm [Nm].
        given: (points,) that of the arm as it came [Nm].
    """

    effect: str
    driver: str
    quantity: str
    x: Floats
    y: Floats
    bins: Floats
    middle: Floats
    low: Floats
    high: Floats
    line: Floats
    fitted: Floats
    given: Floats


def effect_curve(nominal: Arm, corrected: Arm, effect: str, dataset: Dataset) -> EffectCurve | None:
    """Estimate the curve of an effect that acts on the hub; None for others, and where too little moves.

    An effect that depends on speed is shown as the whole friction. Any other is shown as its own share, without the other effects
    of the corrected arm.

    Args:
        nominal: the arm as it came.
        corrected: the arm with the effect.
        effect: its name.
        dataset: the recordings, at the samples that were kept of them.
    """
    if effect not in corrected.effects or not acts_on_hub(corrected, effect):
        return None
    driver = driver_of(corrected, effect)
    names = [name for name in corrected.effects if acts_on_hub(corrected, name)]
    shown = [name for name in names if driver_of(corrected, name) == "speed"] if driver == "speed" else [effect]
    rest = [name for name in names if name not in shown]
    return _curve(nominal, corrected, effect, driver, shown, rest, dataset)


def unexplained_curve(arm: Arm, driver: str, dataset: Dataset) -> EffectCurve | None:
    """Estimate the torque on the hub that an arm does not explain, against a driver; None where too little moves."""
    names = [name for name in arm.effects if acts_on_hub(arm, name)]
    return _curve(arm, arm, "", driver, [], names, dataset)


def driver_of(arm: Arm, name: str) -> str:
    """Find the driver of an effect on the hub: "speed", "angle" or "time"."""
    effect = arm.known[name]
    if effect.port("structure") is not None:
        return "speed" if "viscous" in changes(arm, name) else "angle"
    law = next(law for port in ("friction", "factor", "torque", "weight") if (law := effect.port(port)))
    return next((driver for driver in ("time", "angle") if driver in arguments(law)), "speed")


def _curve(
    nominal: Arm,
    corrected: Arm,
    effect: str,
    driver: str,
    shown: Sequence[str],
    rest: Sequence[str],
    dataset: Dataset,
) -> EffectCurve | None:
    numbers = dataset.settings.explaining
    try:
        motion = _moving(hub_torque_of(with_sensors(corrected, dataset.signals), dataset), numbers)
    except np.linalg.LinAlgError:  # no steady filter: the sensors do not see the hub
        return None
    if motion is None:
        return None
    own = motion.torque - law_torque(corrected, rest, motion.angle, motion.speed, motion.time)
    resists = bool(effect) and any(corrected.known[effect].port(port) for port in ("friction", "factor"))
    against = bool(effect) and (driver == "speed" or resists)
    sign = (-1.0 if driver == "speed" else -np.sign(motion.speed)) if against else 1.0
    x, y = getattr(motion, driver), sign * own
    line = _line(x, driver, numbers)
    at = {name: np.zeros(len(line)) for name in UNITS} | {"speed": np.ones(len(line))} | {driver: line}
    before = [name for name in shown if name in nominal.effects and acts_on_hub(nominal, name)]
    laws = [
        (-1.0 if against else 1.0) * law_torque(arm, names, at["angle"], at["speed"], at["time"])
        for arm, names in ((corrected, shown), (nominal, before))
    ]
    some = slice(None, None, max(len(x) // numbers.most_points, 1))
    words = "torque on the hub" if not against else "friction" if driver == "speed" else "friction added"
    return EffectCurve(effect, driver, words, x[some], y[some], *_binned(x, y, numbers), line, *laws)


def _moving(motions: Sequence[HubMotion], numbers: Explaining) -> HubMotion | None:
    """Join the samples of all recordings at which the hub moves; None where they are too few."""
    if not motions:
        return None
    fields = ("time", "angle", "speed", "torque")
    joined = [np.concatenate([getattr(one, field) for one in motions]) for field in fields]
    moves = np.abs(joined[2]) > numbers.moving * np.abs(joined[2]).max()
    if moves.sum() < 2 * numbers.fewest_in_bin:
        return None
    return HubMotion("", *(values[moves] for values in joined))


def _line(x: Floats, driver: str, numbers: Explaining) -> Floats:
    """Choose the points of a law's line: on both sides of zero speed, not across it."""
    if driver != "speed":
        return np.linspace(x.min(), x.max(), numbers.line_points)
    slow = max(np.abs(x).min(), numbers.slowest)
    half = numbers.line_points // 2
    return np.concatenate([-np.geomspace(max(-x.min(), 2 * slow), slow, half), np.geomspace(slow, max(x.max(), 2 * slow), half)])


def _binned(x: Floats, y: Floats, numbers: Explaining) -> tuple[Floats, Floats, Floats, Floats]:
    """Compute centre, median and quartiles of bins of equally many samples."""
    order = np.argsort(x)
    parts = [part for part in np.array_split(order, min(numbers.bins, max(len(x) // numbers.fewest_in_bin, 1))) if len(part)]
    low, high = (np.array([np.percentile(y[part], q) for part in parts]) for q in numbers.quartiles)
    return np.array([np.median(x[p]) for p in parts]), np.array([np.median(y[p]) for p in parts]), low, high
