"""Infos of many arms, each a dictionary that is filled when it is read: to fill a thousand takes longer than to move the arms."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False, slots=True)
class Step:
    """What the infos of a step have in common.

    Attributes:
        given: part of each info that stands in it from the start; not nothing, since some readers of dicts skip an empty one.
        outcome: of the step (rows, arms), see layout; it must not change any more.
        known: names of the numbers in an info.
        make: makes the numbers of an arm's column of the outcome.
    """

    given: Mapping[str, Any]
    outcome: NDArray[np.float64]
    known: Mapping[str, int]
    make: Callable[[list[float]], dict[str, Any]]


class Info(dict[str, Any]):
    """Info of one arm, with the keys of a single environment's info: as a dict, but its numbers are written at first need.

    Attributes:
        step: that of the numbers; None once they are written.
        arm: number of the arm.
    """

    __slots__ = ("arm", "step")

    step: Step | None
    arm: int

    def fill(self) -> None:
        """Write the numbers, unless that has been done; keep what has been written before."""
        if self.step is not None:
            step, self.step = self.step, None
            before = dict(dict.items(self))
            dict.update(self, step.make(step.outcome[:, self.arm].tolist()))
            dict.update(self, before)

    def __missing__(self, key: str) -> Any:
        if self.step is not None and key in self.step.known:
            self.fill()
            return self[key]
        raise KeyError(key)

    def get(self, key: str, default: Any = None) -> Any:
        """Look up a value; only a number of the arm is a need to write all."""
        if self.step is not None and key in self.step.known:
            self.fill()
        return dict.get(self, key, default)

    def __contains__(self, key: object) -> bool:
        return dict.__contains__(self, key) or (self.step is not None and key in self.step.known)

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
    """Infos of the arms in a step."""

    def __init__(self, step: Step) -> None:
        self.step = step
        self.made: list[dict[str, Any] | None] = [None] * step.outcome.shape[1]

    def __len__(self) -> int:
        return len(self.made)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        # Learners go through all infos in every step; one by one, as a Sequence does it, takes twice as long.
        made, step = self.made, self.step
        for arm, info in enumerate(made):
            if info is None:
                made[arm] = new = Info(step.given)
                new.step, new.arm = step, arm
        return iter(made)  # type: ignore[arg-type]

    @overload
    def __getitem__(self, arm: int) -> dict[str, Any]: ...

    @overload
    def __getitem__(self, arm: slice) -> list[dict[str, Any]]: ...

    def __getitem__(self, arm: int | slice) -> dict[str, Any] | list[dict[str, Any]]:
        if isinstance(arm, slice):
            return list(self)[arm]
        info = self.made[arm]
        if info is None:
            self.made[arm] = info = new = Info(self.step.given)
            new.step, new.arm = self.step, range(len(self))[arm]
        return info

    def __setitem__(self, arm: int, info: dict[str, Any]) -> None:
        self.made[arm] = info

    def __reduce__(self) -> tuple[Any, ...]:
        return list, (list(self),)
