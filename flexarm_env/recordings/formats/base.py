"""The contract of a format of recording files."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import BinaryIO

import numpy as np

from flexarm_env.errors import InputError
from flexarm_env.recordings.checks import as_vector
from flexarm_env.recordings.columns import MADE, ColumnMap, Source, condition_value
from flexarm_env.recordings.messages import quoted
from flexarm_env.recordings.stretches import held
from flexarm_env.recordings.table import Table
from flexarm_env.units import BaseValue


@dataclass(frozen=True)
class Format:
    """A kind of file that holds recordings.

    Attributes:
        name: for messages, such as "MATLAB file".
        suffixes: of its files, in lower case, such as (".mat",). A folder stands for the files that have one of them.
        keys: by which entries of a `[columns]` table a column is found in it: "column", "index", "variable".
        read: makes a table of a file's content and its column map (None if there is none). Every fault is an InputError,
            without the file's name.
        needs_map: whether only a column map says which column is which; otherwise a file may have FlexArm's own header.
        also: suffixes that such a file may have, too, but that files in a folder may have for other reasons.
        matrices: whether an entry may take a `row` or an `index` of a variable.
        header: reads the names of the columns of an open file; None where columns have no names of FlexArm's own.
    """

    name: str
    suffixes: tuple[str, ...]
    keys: tuple[str, ...]
    read: Callable[[bytes, ColumnMap | None], Table]
    needs_map: bool = True
    also: tuple[str, ...] = ()
    matrices: bool = False
    header: Callable[[BinaryIO], list[str]] | None = None

    def table(self, content: bytes, columns: ColumnMap | None) -> Table:
        """Read the content of a file.

        Args:
            content: of the file.
            columns: its column map, if there is one.

        Raises:
            InputError: for a column map that is missing or of another format, and for content that the format cannot read.
        """
        self._check_map(columns)
        if columns is None:
            table = self.read(content, columns)
        else:
            made = {name: source for name, source in columns.sources.items() if source.key in MADE}
            read = {name: source for name, source in columns.sources.items() if name not in made}
            table = _with_made(self._with_conditions(content, replace(columns, sources=read)), made)
        values = {name: as_vector(name, numbers) for name, numbers in table.values.items()}
        if not all(map(len, values.values())):
            raise InputError("has a column without samples; it needs at least two in each")
        return replace(table, values=values)

    def _check_map(self, columns: ColumnMap | None) -> None:
        """Refuse a column map that is missing or of another format."""
        use = " or ".join(f"'{key}'" for key in self.keys)
        if columns is None and self.needs_map:
            raise InputError(f"a {self.name} needs a [columns] table that names its columns by {use}")
        allowed = {*self.keys, *MADE} if self.needs_map else {*self.keys, *MADE, "header"}
        for name, source in (columns.sources | columns.conditions).items() if columns else ():
            if source.key == "header" and self.needs_map:
                raise InputError(f"is a {self.name}, but [columns] has no place for '{name}'; add {use}")
            if source.key not in allowed:
                raise InputError(f"is a {self.name}, but [columns] has '{source.key}' for '{name}'; use {use}")
            if not self.matrices and (source.row, source.cut) != (None, None):
                raise InputError(
                    f"is a {self.name}, but [columns] has 'row' or 'index' beside the {source.key} of '{name}'; "
                    f"write the element behind its name, as {source.place}[0]"
                )
        if columns is not None:
            _refuse_twins(columns)

    def _with_conditions(self, content: bytes, columns: ColumnMap) -> Table:
        """Read the columns of conditions beside the others: one number throughout, a mean, or numbers that change in steps."""
        table = self.read(content, replace(columns, sources=columns.sources | columns.conditions))
        conditions, notes = dict(table.conditions), list(table.notes)
        changing: dict[str, Sequence[float]] = {}
        for name, source in columns.conditions.items():
            if name in conditions:
                raise InputError(f"condition '{name}' comes twice, in [columns] and in the file's remarks; keep one of the two")
            numbers = as_vector(name, table.values[name])
            known = numbers[~np.isnan(numbers)]  # not of the rows of other topics
            place = quoted(str(source.place))
            if not np.isfinite(known).all():
                raise InputError(f"condition '{name}': {place} has {known[~np.isfinite(known)][0]}; correct it")
            differ = len(known) and bool((known != known[0]).any())
            if not len(known) or (differ and not (source.mean or source.split)):
                raise InputError(
                    f"condition '{name}': {place} is not one number throughout; write split = true for a recording of each of "
                    f"its numbers, or mean = true"
                )
            if differ and source.split:
                samples = max(len(table.values[column]) for column in columns.sources)
                if len(numbers) != samples:
                    raise InputError(
                        f"condition '{name}': {place} has {len(numbers)} numbers for {samples} samples; write mean = true"
                    )
                changing[name] = [_condition_of(name, number, source) for number in held(numbers).tolist()]
                continue
            with np.errstate(over="ignore"):  # an overflow is reported as a condition that is not finite
                number = float(np.mean(known)) if differ else float(known[0])
            if differ:
                spread = f"{known.min():.4g} to {known.max():.4g}"
                notes.append(f"condition '{name}' is the mean of {place}, {number:.4g} {source.unit} of {spread}")
            conditions[name] = _condition_of(name, number, source)
        values = {name: numbers for name, numbers in table.values.items() if name not in columns.conditions}
        return replace(table, values=values, conditions=conditions, changing=changing, notes=tuple(notes))


def _condition_of(name: str, number: float, source: Source) -> BaseValue:
    try:
        return condition_value(name, number, source)
    except InputError as error:
        raise InputError(f"condition '{name}': {error}") from None


def _refuse_twins(columns: ColumnMap) -> None:
    """Refuse a map by which two quantities are one variable; headers refuse two of one column."""
    found: dict[tuple[str | int | float, int | None, int | None], str] = {}
    for name, source in (columns.sources | columns.conditions).items():
        twin = found.setdefault((source.place, source.row, source.cut), name) if source.key == "variable" else name
        if twin != name:
            raise InputError(f"columns '{twin}' and '{name}': both map to {quoted(str(source.place))}; correct one of them")


def _with_made(table: Table, made: Mapping[str, Source]) -> Table:
    """Add to a table the times of an even rate, and a command that is the same throughout."""
    count = max(map(len, table.values.values()), default=0)
    values, sources = dict(table.values), dict(table.sources)
    for name, source in made.items():
        if name in values:
            what = "a column of time, but [columns] gives a rate" if name == "time" else f"a column '{name}' beside its value"
            raise InputError(f"has {what}; leave the {source.key} out")
        number = float(source.place)
        with np.errstate(over="ignore", invalid="ignore"):  # an overflow is reported with its row
            column = np.arange(count) / number if source.key == "rate" else np.full(count, number)
        values, sources = {name: column} | values, {name: source} | sources
    return replace(table, values=values, sources=sources)
