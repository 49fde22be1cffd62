"""Infos of many arms, each a dictionary that is made when it is read: to make a thousand takes longer than to move the arms."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

#: Makes the numbers of an info of an arm's column of the outcome.
Make = Callable[[list[float]], dict[str, Any]]


class Info(dict[str, Any]):
    """Info of one arm, with the keys of a single environment's info: as a dict, but its numbers are written at first need.

    Args:
        given: what is in it from the start; not nothing, since some readers of dicts skip one that looks empty.
        outcome: of a step (rows, arms), see layout.
        arm: number of the arm.
        known: names of the numbers.
        make: makes them.
    """

    __slots__ = ("arm", "known", "make", "outcome")

    def __init__(
        self, given: Mapping[str, Any], outcome: NDArray[np.float64], arm: int, known: Mapping[str, int], make: Make
    ) -> None:
        super().__init__(given)
        self.outcome: NDArray[np.float64] | None = outcome
        self.arm, self.known, self.make = arm, known, make

    def fill(self) -> None:
        """Write the numbers, unless that has been done; keep what has been written before."""
        if self.outcome is not None:
            column, self.outcome = self.outcome[:, self.arm].tolist(), None
            later = dict(dict.items(self))
            dict.update(self, self.make(column))
            dict.update(self, later)

    def __missing__(self, key: str) -> Any:
        if key in self.known and self.outcome is not None:
            self.fill()
            return self[key]
        raise KeyError(key)

    def get(self, key: str, default: Any = None) -> Any:
        """Look up a value; only a number of the arm is a need to write all."""
        if key in self.known:
            self.fill()
        return dict.get(self, key, default)

    def __contains__(self, key: object) -> bool:
        return dict.__contains__(self, key) or (key in self.known and self.outcome is not None)

    def __reduce_ex__(self, protocol: Any) -> tuple[Any, ...]:
        return dict, (dict(self),)


def _after_filling(name: str) -> Callable[..., Any]:
    method = getattr(dict, name)

    def filled(self: Info, *given: Any, **further: Any) -> Any:
        self.fill()
        return method(self, *given, **further)

    return filled


#: What reads or takes out all of a dictionary; a method of dict that is not here writes to one key.
for _name in (
    "__iter__", "__len__", "__reversed__", "__eq__", "__ne__", "__repr__", "__or__", "__ror__", "__delitem__",
    "keys", "values", "items", "copy", "pop", "popitem", "setdefault", "clear",
):  # fmt: skip
    setattr(Info, _name, _after_filling(_name))


class Infos(Sequence[dict[str, Any]]):
    """Infos of the arms in a step.

    Args:
        given: what is in each from the start.
        outcome: of the step (rows, arms), see layout; it must not change any more.
        known: names of the numbers in an info.
        make: makes them.
    """

    def __init__(self, given: Mapping[str, Any], outcome: NDArray[np.float64], known: Mapping[str, int], make: Make) -> None:
        self.given, self.outcome, self.known, self.make = given, outcome, known, make
        self.made: dict[int, dict[str, Any]] = {}

    def __len__(self) -> int:
        return self.outcome.shape[1]

    @overload
    def __getitem__(self, arm: int) -> dict[str, Any]: ...

    @overload
    def __getitem__(self, arm: slice) -> list[dict[str, Any]]: ...

    def __getitem__(self, arm: int | slice) -> dict[str, Any] | list[dict[str, Any]]:
        if isinstance(arm, slice):
            return [self[i] for i in range(*arm.indices(len(self)))]
        place = range(len(self))[arm]
        if place not in self.made:
            self.made[place] = Info(self.given, self.outcome, place, self.known, self.make)
        return self.made[place]

    def __setitem__(self, arm: int, info: dict[str, Any]) -> None:
        self.made[range(len(self))[arm]] = info

    def __reduce__(self) -> tuple[Any, ...]:
        return list, (list(self),)
