"""ROS 2 bags in SQLite files (.db3), as older distributions write them; newer ones write MCAP."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from flexarm_env.errors import InputError
from flexarm_env.recordings.columns import ColumnMap
from flexarm_env.recordings.formats.base import Format
from flexarm_env.recordings.formats.extras import library
from flexarm_env.recordings.formats.mcap import ros2_decoder
from flexarm_env.recordings.formats.topics import Message, read_topics, topics_of
from flexarm_env.recordings.messages import quoted
from flexarm_env.recordings.table import Table

KIND = "ROS 2 bag"


def read(content: bytes, columns: ColumnMap | None) -> Table:
    """Read the content of a bag by its column map.

    Args:
        content: of the .db3 file.
        columns: its column map.

    Raises:
        InputError: for a damaged file, a topic that is absent or of an unknown type, and a path that leads to no number.
    """
    layout = columns or ColumnMap()
    wanted = topics_of(layout)
    base = sqlite3.connect(":memory:")
    try:
        base.deserialize(content)
        base.execute("PRAGMA trusted_schema = OFF")
        tables = {name for (name,) in base.execute("SELECT name FROM sqlite_master WHERE type = 'table'")}
        if not {"topics", "messages"} <= tables:
            raise InputError("is no ROS 2 bag: it has no tables of topics and messages")
        topics = {name: (key, kind) for key, name, kind in base.execute("SELECT id, name, type FROM topics")}
        return read_topics(_messages(base, topics, wanted, "message_definitions" in tables), topics, layout)
    except InputError:
        raise
    except (sqlite3.Error, ValueError, TypeError) as error:
        raise InputError(f"is damaged or no ROS 2 bag: {quoted(str(error))}") from None
    finally:
        base.close()


def _messages(base: sqlite3.Connection, topics: dict[str, tuple[int, str]], wanted: set[str], defined: bool) -> Iterator[Message]:
    for topic in sorted(wanted & set(topics)):
        key, kind = topics[topic]
        decode = _decoder(base, kind, defined)
        for logged, data in base.execute("SELECT timestamp, data FROM messages WHERE topic_id = ? ORDER BY timestamp", (key,)):
            yield Message(topic, logged, partial(decode, data))


def _decoder(base: sqlite3.Connection, kind: str, defined: bool) -> Callable[[bytes], Any]:
    """Find the definition of a type, in the bag or among those of ROS itself."""
    query = "SELECT encoded_message_definition FROM message_definitions WHERE topic_type = ? AND encoding = 'ros2msg'"
    row = base.execute(query, (kind,)).fetchone() if defined else None
    if row is not None:
        return ros2_decoder(kind, row[0])
    types = library("rosbags.typesys", KIND)
    try:
        definition, _ = types.get_typestore(types.Stores.LATEST).generate_msgdef(kind, ros_version=2)
    except (KeyError, types.TypesysError):
        raise InputError(f"type {quoted(kind)} is defined neither in the bag nor by ROS; record it with MCAP storage") from None
    return ros2_decoder(kind, definition)


FORMAT = Format(KIND, (".db3",), ("variable",), read)
