"""A task: where an episode starts, which target it has, how it is rewarded and when it ends."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.tasks.common_terms import COMMON_TERMS
from flexarm_env.tasks.reward import RewardTerm

#: Control steps per second of an environment, where its arguments give no other rate [Hz].
CONTROL_RATE = 200.0
#: Lowest and highest payload of the "-Random" variants of the registered tasks [kg].
RANDOM_PAYLOAD = (0.0, 0.3)

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

    The reward of a sample is the sum of the terms, each times its weight.

    Attributes:
        name: lower-case words joined by underscores; `FlexArm/<Name>-v0` for a registered task.
        duration: of an episode [s].
        target: angle to reach [rad].
        half_period: time after which the target changes its sign, again and again [s]; 0: it stays.
        angle: of the hub at the start [rad].
        pulse: current before the episode starts [A] (or V), as a share of the drive's limit.
        pulse_time: duration of the pulse [s].
        coast: time from the end of the pulse to the start of the episode [s].
        hold: whether the target is the angle where the episode starts.
        range: the episode ends where the hub is further from its start than this [rad]; infinity: never.
        weights: of the reward's terms by name, in place of their own; a term that is left out weighs nothing.
        terms: of the reward, in the order in which they are added.
        summary: first line of the environment's page.
        description: paragraphs of the environment's page, in Markdown.

    Raises:
        InputError: for a number out of bounds, or terms and weights that do not go together.

    Examples:
        >>> import math
        >>> reach = Task("reach", duration=3.0, target=math.radians(30.0))
        >>> reach.steps(), [(term.name, reach.weight(term)) for term in reach.terms[:2]]
        (600, [('distance', 1.0), ('closeness', 0.5)])
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
    weights: Mapping[str, float] | None = None
    terms: tuple[RewardTerm, ...] = COMMON_TERMS
    summary: str = ""
    description: str = ""

    def __post_init__(self) -> None:
        names = [term.name for term in self.terms]
        for name in names:
            if names.count(name) > 1:
                raise InputError(f"task '{self.name}' has two reward terms '{name}'; rename one of them")
        for name, weight in (self.weights or {}).items():
            if name not in names:
                raise InputError(f"task '{self.name}': unknown reward term '{name}'{did_you_mean(name, names)}")
            if not math.isfinite(weight):
                raise InputError(f"task '{self.name}': the weight of {name} is {weight!r}; give a finite number")
        for name, lowest in LEAST.items():
            value, highest = getattr(self, name), math.inf if name == "range" else LARGEST
            if not lowest <= value <= highest:
                raise InputError(f"task '{self.name}': {name} = {value!r}; give a number from {lowest:g} to {highest:g}")

    @property
    def title(self) -> str:
        """Name of the task in the ids and classes of its environments, such as "Slew"."""
        return "".join(word.capitalize() for word in self.name.split("_"))

    def weight(self, term: RewardTerm) -> float:
        """Look up the weight of one of the task's terms."""
        return term.weight if self.weights is None else self.weights.get(term.name, 0.0)

    def steps(self, rate: float = CONTROL_RATE) -> int:
        """Count the control steps of an episode at `rate` steps per second [Hz]."""
        return max(round(self.duration * rate), 1)
