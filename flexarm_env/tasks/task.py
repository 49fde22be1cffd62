"""What a task is."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from flexarm_env.errors import InputError, did_you_mean

#: Terms of the reward, in the order in which they are computed, each at most 0 where it costs.
REWARD_TERMS = ("distance", "closeness", "vibration", "effort", "rate", "failure")

#: What a term is multiplied by, where a task does not say otherwise.
WEIGHTS = {"distance": 1.0, "closeness": 0.5, "vibration": 2.0, "effort": 0.02, "rate": 0.02, "failure": 100.0}

#: Smallest value of each number of a task, and the largest of all but the range.
LARGEST = 1e6
LEAST = {
    "duration": 1e-6,
    "half_period": 0.0,
    "pulse_time": 0.0,
    "coast": 0.0,
    "range": 1e-6,
    "target": -LARGEST,
    "angle": -LARGEST,
    "pulse": -LARGEST,
}


@dataclass(frozen=True)
class Task:
    """Start, target, reward and end of an episode.

    The reward of a sample is the sum of its terms, each times its weight: `distance` −|target − angle| [rad], `closeness`
    exp(−|target − angle| / 0.05 rad), `vibration` −|tip deflection| / length, `effort` −(command / limit)², `rate`
    −(change of the command / limit)², `failure` −1 once, when the episode ends because the arm left its range.

    Attributes:
        name: for a person.
        duration: of an episode [s].
        target: angle asked for at the start [rad].
        half_period: after so long the target changes its sign, again and again [s]; 0: it stays.
        angle: of the hub at the start [rad].
        pulse: current before the episode starts [A] (or V), as a share of the drive's limit.
        pulse_time: how long it acts [s].
        coast: how long the arm then runs on before the episode starts [s].
        hold: whether the target is the angle where the episode starts.
        range: the episode ends where the angle is further from its start than this [rad]; infinity: never.
        weights: of the reward's terms.
    """

    name: str
    duration: float
    target: float = 0.0
    half_period: float = 0.0
    angle: float = 0.0
    pulse: float = 0.0
    pulse_time: float = 0.0
    coast: float = 0.0
    hold: bool = False
    range: float = math.pi
    weights: Mapping[str, float] = field(default_factory=lambda: dict(WEIGHTS))

    def __post_init__(self) -> None:
        for name in self.weights:
            if name not in REWARD_TERMS:
                raise InputError(f"task '{self.name}': unknown reward term '{name}'{did_you_mean(name, REWARD_TERMS)}")
        for name, lowest in LEAST.items():
            value, highest = getattr(self, name), math.inf if name == "range" else LARGEST
            if not lowest <= value <= highest:
                raise InputError(f"task '{self.name}': {name} = {value!r}; give a number from {lowest:g} to {highest:g}")
        for name, weight in self.weights.items():
            if not math.isfinite(weight):
                raise InputError(f"task '{self.name}': the weight of {name} is {weight!r}; give a finite number")
