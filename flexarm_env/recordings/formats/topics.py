"""Numbers in the messages of topics, as MCAP files and ROS 2 bags hold them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexarm_env import units
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.recordings.columns import ColumnMap, Source, lateness_of, quantity_of, si_factor
from flexarm_env.recordings.joining import Part, join, parts_by_lateness
from flexarm_env.recordings.messages import quoted
from flexarm_env.recordings.resolution import repeated_readings
from flexarm_env.recordings.table import MOST_LINES, Table

Floats = NDArray[np.float64]

# Possessive, so that no path takes time that grows faster than its length.
_PATH = re.compile(r"(/[\w/~-]++)?((?>(?:\.?+\w++|\[[^\[\]]++\])*))")
_STEP = re.compile(r"\.?(\w+)|\[([^\[\]]+)\]")
LOG_TIME = "log_time"
#: Largest time in a message: nanoseconds of a thousand years.
_LATEST = 3e19


@dataclass(frozen=True)
class Message:
    """A message of a topic: the time [ns] at which it was logged, and a function that decodes it."""

    topic: str
    logged: int
    decode: Callable[[], Any]


def topics_of(columns: ColumnMap) -> set[str]:
    """List the topics that a map names."""
    return {_cut(name, source)[0] for name, source in columns.sources.items() if quantity_of(name) != "time"}


def read_topics(messages: Iterable[Message], known: Iterable[str], columns: ColumnMap) -> Table:
    """Read the numbers that a map names, with the time of each message.

    Args:
        messages: of the topics that the map names, in any order.
        known: the topics of the file.
        columns: paths such as "/joint_states.position[0]", counted from 0 or by the name of a joint; for time a path in the
            messages of each topic, such as "header.stamp", or "log_time".

    Raises:
        InputError: for a topic that is absent, and for a path that leads to no number.
    """
    groups = _groups(columns, sorted(set(known)))
    steps = {name: _STEP.findall(_cut(name, source)[1]) for name, source in columns.sources.items()}
    rows: dict[str, list[list[float]]] = {topic: [] for topic in groups}
    times: dict[str, list[int | float]] = {topic: [] for topic in groups}
    by_log = columns.sources["time"].place == LOG_TIME
    for number, message in enumerate(messages):
        if number >= MOST_LINES:
            raise InputError(f"has over {MOST_LINES} messages; cut it into shorter recordings")
        content = _decoded(message, number)
        times[message.topic].append(message.logged if by_log else _time(content, steps["time"]))
        rows[message.topic].append([_number(content, steps[name], name) for name in groups[message.topic]])
    return _table(columns, groups, times, rows)


def _decoded(message: Message, number: int) -> Any:
    try:
        return message.decode()
    except Exception as error:  # damaged content makes decoders raise nearly anything
        where = f"message {number + 1}, of topic {quoted(message.topic)}"
        raise InputError(f"{where}, is damaged: {quoted(str(error) or type(error).__name__)}") from None


def _groups(columns: ColumnMap, topics: list[str]) -> dict[str, list[str]]:
    """Group the quantities of a map by topic."""
    if "time" not in columns.sources:
        raise InputError("has a time for each message; name it by variable = 'header.stamp' or 'log_time', not a rate")
    if "time (2)" in columns.sources:
        raise InputError("column 'time': give one path, such as 'header.stamp', of which seconds and nanoseconds are read")
    groups: dict[str, list[str]] = {}
    for name, source in columns.sources.items():
        if name != "time":
            groups.setdefault(_cut(name, source)[0], []).append(name)
    for topic, names in groups.items():
        if topic not in topics:
            raise InputError(f"column '{names[0]}': no topic {quoted(topic)}{did_you_mean(topic, topics[:20])}")
    return groups


def _table(
    columns: ColumnMap, groups: dict[str, list[str]], times: dict[str, list[int | float]], rows: dict[str, list[list[float]]]
) -> Table:
    """Put the messages of all topics in one order of time."""
    empty = next((topic for topic in groups if len(rows[topic]) < 2), None)
    if empty is not None:
        raise InputError(f"topic {quoted(empty)} has {len(rows[empty])} messages; it needs at least two")
    _check_times(times, str(columns.sources["time"].place))
    whole = all(isinstance(instants[0], int) for instants in times.values())
    factor = 1e-9 / units.factor(columns.sources["time"].unit, "s") if whole else 1.0
    first = min(instants[0] for instants in times.values())
    second = 1.0 / si_factor("time", columns.sources["time"], {})
    lateness = {name: lateness_of(name, columns.sources) * second if len(groups) > 1 else 0.0 for name in columns.sources}
    parts: list[Part] = []
    for topic, names in groups.items():
        time = np.array([instant - first for instant in times[topic]], dtype=np.float64) * factor
        values = zip(names, np.array(rows[topic], dtype=np.float64).T, strict=True)
        read = {name: _without_repeats(columns.sources[name], numbers) for name, numbers in values}
        parts += parts_by_lateness(time, read, lateness)
    return Table(join(parts), {name: _corrected(source, len(groups)) for name, source in columns.sources.items()})


def _corrected(source: Source, topics: int) -> Source:
    """Leave out the corrections of a source that are made before several topics, or the messages of one, are joined."""
    corrections = replace(source.corrections, repeats=1)
    return replace(source, corrections=replace(corrections, shift=0.0) if topics > 1 else corrections)


def _check_times(times: Mapping[str, list[int | float]], path: str) -> None:
    """Refuse times of two kinds, whose zeros differ, and times that are none."""
    if len({isinstance(instant, int) for instants in times.values() for instant in instants}) > 1:
        raise InputError(
            f"column 'time': {quoted(path)} is a stamp with nanoseconds in some messages and a number in others; "
            f"name a time that all have, such as '{LOG_TIME}'"
        )
    for topic, instants in times.items():
        bad = next((number for number, instant in enumerate(instants) if not abs(instant) <= _LATEST), None)
        if bad is not None:
            raise InputError(f"message {bad + 1} of topic {quoted(topic)}, column 'time': is no time; correct it")


def _without_repeats(source: Source, values: Floats) -> Floats:
    """Leave out the readings that are only held, of the messages of one topic: beside those of others no row follows another."""
    repeats = source.corrections.repeats
    return np.where(repeated_readings(values, repeats), np.nan, values) if repeats > 1 else values


def _cut(name: str, source: Source) -> tuple[str, str]:
    """Cut a path into topic and place in a message."""
    match = _PATH.fullmatch(str(source.place))
    if match is None or (quantity_of(name) != "time" and not (match[1] and match[2])):
        raise InputError(
            f"column '{name}': {quoted(str(source.place))} is no path; write one such as '/joint_states.position[0]'"
        )
    return match[1] or "", match[2]


def _follow(content: Any, steps: list[tuple[str, str]], name: str) -> Any:
    """Follow a path into a message; a text in brackets stands for the place of that name in the message's `name`."""
    parent = content
    for field, index in steps:
        try:
            if field:
                content, parent = _field(content, field), content
            else:
                content = content[int(index) if index.isdecimal() else list(_field(parent, "name")).index(index)]
        except (KeyError, AttributeError, IndexError, ValueError, TypeError):
            raise InputError(
                f"column '{name}': a message has no {quoted(field or f'[{index}]')}, but {_holds(content)}"
            ) from None
    return content


def _field(message: Any, name: str) -> Any:
    return message[name] if isinstance(message, dict) else getattr(message, name)


def _holds(content: Any) -> str:
    """Describe a message or a part of it."""
    if isinstance(content, (list, tuple, bytes)):
        return f"{len(content)} elements, counted from 0"
    fields = content if isinstance(content, dict) else getattr(content, "__slots__", ())
    return ", ".join(quoted(str(field)) for field in list(fields)[:8]) or quoted(str(content))


def _number(content: Any, steps: list[tuple[str, str]], name: str) -> float:
    value = _follow(content, steps, name)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError(f"column '{name}': its path leads to {_holds(value)}, not to a number")
    return units.as_float(value)


def _time(content: Any, steps: list[tuple[str, str]]) -> int | float:
    """Read the time of a message: of a stamp in whole nanoseconds, of a number as it is."""
    value = _follow(content, steps, "time")
    for parts in (("sec", "nanosec"), ("sec", "nsec")):
        try:
            seconds, rest = (_field(value, part) for part in parts)
        except (KeyError, AttributeError, TypeError):
            continue
        if isinstance(seconds, int) and isinstance(rest, int):
            return seconds * 1_000_000_000 + rest
    return _number(content, steps, "time")
