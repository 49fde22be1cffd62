"""Numbers of a control law as one checked value, given whole or by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any, TypeVar

from flexarm_env import units
from flexarm_env.errors import InputError, did_you_mean

D = TypeVar("D", bound="Design")

#: Most samples of a time of a design: 20 s at 200 Hz, far beyond any dead time or horizon.
MOST_SAMPLES = 4000


class Design:
    """Base of the numbers of a law: frozen dataclasses of finite numbers, none of them negative."""

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            number = isinstance(value, int | float) and not isinstance(value, bool)
            if not (number and units.is_finite(value) and value >= 0.0):
                raise InputError(f"design: {name} = {value!r}; give a finite number from 0 up")
            if value == 0.0 and name not in self.may_vanish():
                raise InputError(f"design: {name} = 0; give a positive number")

    @classmethod
    def may_vanish(cls) -> tuple[str, ...]:
        """List the numbers that may be 0."""
        return ()

    @classmethod
    def of(cls: type[D], given: D | Mapping[str, Any] | None) -> D:
        """Make a design of some of its numbers by name, or pass one on.

        Raises:
            InputError: for a name that does not exist or a value that is none.
        """
        if isinstance(given, cls):
            return given
        if not isinstance(given, Mapping | None):
            raise InputError(f"design = {given!r}; give a table of {', '.join(field.name for field in fields(cls))}")  # type: ignore[arg-type]
        names = [field.name for field in fields(cls)]  # type: ignore[arg-type]
        for name in given or {}:
            if name not in names:
                raise InputError(f"design has no '{name}'{did_you_mean(str(name), names)}")
        return cls(**(given or {}))

    def samples(self, name: str, interval: float) -> int:
        """Count the samples of a time of the design, by its name, rounded.

        Args:
            name: of the time.
            interval: control period [s].

        Raises:
            InputError: for more samples than a loop could use.
        """
        time = getattr(self, name)
        if time > MOST_SAMPLES * interval:
            raise InputError(f"design: {name} = {time:g} s; give at most {MOST_SAMPLES * interval:g} s, {MOST_SAMPLES} samples")
        return round(time / interval)
