"""Terms of a task's reward: a function of the present sample, its weight, and its formula for a person."""

from __future__ import annotations

import contextlib
import inspect
import math
from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType
from typing import Any, NamedTuple

from flexarm_env.errors import InputError, did_you_mean


class Sample(NamedTuple):
    """Quantities of one control sample that a reward term may take, at the sample's end.

    Attributes:
        hub_angle: true angle of the hub [rad].
        hub_speed: true speed of the hub [rad/s].
        tip_deflection: true deflection of the tip [m].
        stuck: whether friction holds the hub.
        target: angle to reach [rad].
        command: held during the sample, as a share of the drive's limit, from -1 to 1.
        command_change: from the sample before, as a share of the limit.
        start_angle: angle of the hub at the start of the episode [rad].
        beam_length: [m]; 1 for an arm without a beam.
        time: since the start of the episode [s].
        failed: whether the arm left its range, which ends the episode.
    """

    hub_angle: float
    hub_speed: float
    tip_deflection: float
    stuck: bool
    target: float
    command: float
    command_change: float
    start_angle: float
    beam_length: float
    time: float
    failed: bool


#: A sample on which a term is tried.
EXAMPLE = Sample(
    hub_angle=0.1, hub_speed=0.2, tip_deflection=0.003, stuck=False, target=0.4, command=0.5, command_change=0.1,
    start_angle=0.0, beam_length=1.0, time=0.5, failed=False,
)  # fmt: skip


@dataclass(frozen=True)
class RewardTerm:
    """One term of a reward: weight · function(sample), reported in `info` as `reward_<name>`.

    The function is compiled into the environment's kernel. It takes any fields of `Sample` by name and uses plain
    arithmetic, `math` and numbers of its own file only.

    Attributes:
        function: of the named quantities; its name is the term's name.
        weight: factor of the term, where a task has no other.
        formula: for the environment's page, without the weight.

    Raises:
        InputError: for a function that cannot be compiled into a kernel, or does not return a number.

    Examples:
        >>> def tip_speed(hub_speed, beam_length):
        ...     return -abs(hub_speed) * beam_length
        >>> RewardTerm(tip_speed, weight=0.1, formula="−abs(hub speed) · beam length").name
        'tip_speed'
    """

    function: Callable[..., float]
    weight: float
    formula: str

    def __post_init__(self) -> None:
        where = f"reward term '{self.name}'"
        if not self.name.isidentifier():
            raise InputError(f"{where} has no name: write its function with def")
        for quantity in self.quantities:
            if quantity not in Sample._fields:
                raise InputError(f"{where}: unknown quantity '{quantity}'{did_you_mean(quantity, Sample._fields)}")
        if not math.isfinite(self.weight):
            raise InputError(f"{where}: weight = {self.weight!r}; give a finite number")
        for name, value in self._names().items():
            if not (value is math or _is_number(value)):
                raise InputError(f"{where} uses '{name}'; a term uses its quantities, math, and numbers of its file only")
        self._try()
        with contextlib.suppress(OSError):  # the kernel is built from it; a function that was sent to a process has no file
            vars(self.function).setdefault("source", inspect.getsource(self.function))

    @property
    def name(self) -> str:
        """Name of the term."""
        return self.function.__name__

    @property
    def quantities(self) -> tuple[str, ...]:
        """Names of the quantities that the function takes, in its order."""
        return tuple(inspect.signature(self.function).parameters)

    @property
    def numbers(self) -> dict[str, float]:
        """Numbers of its file that the function uses, by name."""
        return {name: value for name, value in self._names().items() if not isinstance(value, ModuleType)}

    def _try(self) -> None:
        """Call the function once; divisions by zero and the like are left to the kernel, which does not raise them."""
        try:
            value = self.function(**{name: getattr(EXAMPLE, name) for name in self.quantities})
        except (ArithmeticError, ValueError):
            return
        except Exception as error:
            raise InputError(f"reward term '{self.name}' fails: {type(error).__name__}: {error}") from error
        if not _is_number(value):
            raise InputError(f"reward term '{self.name}' returns {value!r}; return a number")

    def _names(self) -> dict[str, Any]:
        """Global and enclosing variables of the function, by name."""
        outside = inspect.getclosurevars(self.function)
        return {**outside.globals, **outside.nonlocals}


def _is_number(value: object) -> bool:
    return isinstance(value, int | float)
