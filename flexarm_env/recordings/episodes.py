"""The recordings in a file of several, such as the episodes of a LeRobot data set."""

from __future__ import annotations

import numpy as np

from flexarm_env.errors import InputError
from flexarm_env.recordings.columns import ColumnMap
from flexarm_env.recordings.table import Table


def episodes_of(table: Table, name: str, columns: ColumnMap | None) -> dict[str, Table]:
    """Part a table into its recordings by name, those that the column map names; their lines are the rows of the file.

    Args:
        table: of the file.
        name: of the file, and of its recording where there is one.
        columns: its column map.

    Raises:
        InputError: for an episode of one row, for one whose rows do not follow each other, and for a file of none that the map
            names.
    """
    if not len(table.episodes):
        if columns is not None and columns.episodes:
            raise InputError("has no episodes, but [columns] names some by episode_index; leave it out")
        return {name: table}
    numbers = np.asarray(table.episodes)
    first = np.flatnonzero(np.diff(numbers, prepend=numbers[0] - 1))
    begun: dict[int, int] = {}
    found: dict[str, Table] = {}
    for start, stop in zip(first.tolist(), [*first[1:].tolist(), len(numbers)], strict=True):
        number = int(numbers[start])
        if number in begun:
            raise InputError(f"row {start + 1}: episode {number} begins again, which began in row {begun[number] + 1}")
        if stop - start < 2:
            raise InputError(f"row {start + 1}: episode {number} has one row; it needs at least two")
        begun[number] = start
        if columns is None or not columns.episodes or number in columns.episodes:
            columns_there = {column: values[start:stop] for column, values in table.values.items()}
            own = name if len(first) == 1 else f"{name} episode {number}"
            changing = {condition: values[start:stop] for condition, values in table.changing.items()}
            lines = range(start + 1, stop + 1)
            found[own] = Table(columns_there, table.sources, table.conditions, lines, changing=changing, notes=table.notes)
    return found


def check_episodes(count: int, columns: ColumnMap | None, where: str = "") -> None:
    """Check that every episode that a column map names was found.

    Args:
        count: recordings found.
        columns: the map.
        where: the file for the message, with a colon; "" for several.

    Raises:
        InputError: for fewer.
    """
    named = () if columns is None else columns.episodes
    if count < len(named):
        listed = ", ".join(map(str, named))
        raise InputError(f"{where}has {count} of the episodes that episode_index in [columns] names ({listed}); correct it")
