"""An effect that a machine has beyond its model: on the rig, with ranges that follow the machine's size."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from benchmarks.machines.model import Model, Rng
from benchmarks.machines.translate import Settings

Details = Mapping[str, float]
Ranges = Mapping[str, tuple[float, float]]


def _none(model: Model, *others: object) -> dict[str, Any]:
    return {}


def _always(model: Model) -> bool:
    return True


@dataclass(frozen=True)
class Hidden:
    """One effect on the rig. The model in its functions is that of the machine, which has the machine's true constants.

    Attributes:
        largest: largest plausible size on a machine.
        settings: of the rig, from machine, size and details.
        details: other numbers and their ranges on a machine, each drawn uniformly.
        truth: true parameters in an arm file, as far as they correspond to one number, from machine, size and details.
        signed: whether its size may have either sign.
        possible: whether a machine can have it, beyond the needs that the catalogue of effects states.
        part: of the machine in which it lies, where one effect at most is drawn of that part; "" for none.
        sensor: whether it lies in the readings alone.
    """

    largest: Callable[[Model], float]
    settings: Callable[[Model, float, Details], Settings]
    details: Callable[[Model], Ranges] = _none
    truth: Callable[[Model, float, Details], dict[str, float]] = _none
    signed: bool = False
    possible: Callable[[Model], bool] = _always
    part: str = ""
    sensor: bool = False


@dataclass(frozen=True)
class Sized:
    """An effect of a size on a machine, and the excess error that it causes over the noise."""

    name: str
    hidden: Hidden
    size: float
    details: Details = field(default_factory=dict)
    strength: float = 0.0

    @property
    def is_sensor(self) -> bool:
        """Whether the motion itself is not changed."""
        return self.hidden.sensor

    def settings(self, machine: Model) -> Settings:
        """Compute the rig's settings."""
        return self.hidden.settings(machine, self.size, self.details)

    def truth(self, machine: Model) -> dict[str, float]:
        """Compute the true parameters, by their names in an arm file."""
        return self.hidden.truth(machine, self.size, self.details)


def draw_details(draw: Rng, hidden: Hidden, machine: Model) -> dict[str, float]:
    """Draw the details of an effect."""
    return {key: float(draw.uniform(*limits)) for key, limits in sorted(hidden.details(machine).items())}


def plain(setting: str, parameter: str, largest: Callable[[Model], float], inverse: bool = False, **others: Any) -> Hidden:
    """Describe an effect with one setting and one parameter, whose size is either number or its inverse."""

    def value(machine: Model, size: float, details: Details) -> float:
        return 1.0 / size if inverse else size

    return Hidden(
        largest,
        lambda *given: {setting: value(*given)},
        truth=lambda *given: {parameter: value(*given)} if parameter else {},
        **others,
    )


def detailed(
    setting: str, parameter: str, largest: Callable[[Model], float], details: Callable[[Model], Ranges], **others: Any
) -> Hidden:
    """Describe an effect whose details are settings of the rig; `names` gives the parameter of each that corresponds to one."""
    names: Mapping[str, str] = others.pop("names", {})
    return Hidden(
        largest,
        lambda machine, size, given: {setting: size, **given},
        details,
        lambda machine, size, given: {parameter: size} | {key: given[name] for name, key in names.items()} if parameter else {},
        **others,
    )
