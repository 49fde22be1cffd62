"""MCAP files with ROS 2 or JSON messages, as `ros2 bag record` and Foxglove write them."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from flexarm_env.errors import InputError
from flexarm_env.recordings.columns import ColumnMap
from flexarm_env.recordings.formats.base import Format
from flexarm_env.recordings.formats.extras import library
from flexarm_env.recordings.formats.json_text import load_json
from flexarm_env.recordings.formats.topics import Message, read_topics, topics_of
from flexarm_env.recordings.messages import quoted
from flexarm_env.recordings.table import LARGEST_FILE, Table

KIND = "MCAP file"


def read(content: bytes, columns: ColumnMap | None) -> Table:
    """Read the content of an MCAP file by its column map.

    Args:
        content: of the file.
        columns: its column map.

    Raises:
        InputError: for a damaged file, a topic that is absent or in another encoding, and a path that leads to no number.
    """
    library("mcap", KIND)
    layout = columns or ColumnMap()
    wanted = topics_of(layout)
    known: dict[int, Any] = {}
    try:
        messages = list(_messages(content, wanted, known))
        return read_topics(messages, [channel.topic for channel in known.values()], layout)
    except InputError:
        raise
    except Exception as error:  # a damaged file makes the libraries raise nearly anything
        raise InputError(f"is damaged or no MCAP file: {quoted(str(error) or type(error).__name__)}") from None


def _messages(content: bytes, wanted: set[str], known: dict[int, Any]) -> Iterator[Message]:
    """Yield the messages of topics; channels are added to those known."""
    records, stream = library("mcap.records", KIND), library("mcap.stream_reader", KIND)
    decoders: dict[int, Callable[[bytes], Any]] = {}
    schemas: dict[int, Any] = {}
    for record in _records(stream.StreamReader(io.BytesIO(content), emit_chunks=True, record_size_limit=LARGEST_FILE), records):
        if isinstance(record, records.Schema):
            schemas[record.id] = record
        elif isinstance(record, records.Channel):
            known[record.id] = record
        elif isinstance(record, records.Message) and known[record.channel_id].topic in wanted:
            channel = known[record.channel_id]
            if channel.id not in decoders:
                decoders[channel.id] = _decoder(channel, schemas.get(channel.schema_id))
            yield Message(channel.topic, record.log_time, partial(decoders[channel.id], record.data))


def _records(reader: Any, records: Any) -> Iterator[Any]:
    """Yield the records of a file and of its chunks, which are unpacked to no more than a file may have."""
    stream, room = library("mcap.stream_reader", KIND), LARGEST_FILE
    for record in reader.records:
        if not isinstance(record, records.Chunk):
            yield record
            continue
        data = _unpack(record.compression, record.data, room)
        room -= len(data)
        record.data, record.compression, record.uncompressed_size = data, "", len(data)
        yield from stream.breakup_chunk(record)


def _unpack(compression: str, data: bytes, room: int) -> bytes:
    """Decompress a chunk that has at most so many bytes."""
    if compression == "lz4":
        data = library("lz4.frame", KIND).LZ4FrameDecompressor().decompress(data, max_length=room + 1)
    elif compression == "zstd":
        with library("zstandard", KIND).ZstdDecompressor().stream_reader(data) as reader:
            data = reader.read(room + 1)
    if len(data) > room:
        raise InputError(f"holds more than {LARGEST_FILE >> 20} MB once unpacked; cut it into shorter recordings")
    return bytes(data)


def _decoder(channel: Any, schema: Any) -> Callable[[bytes], Any]:
    """Find how messages of a channel are decoded."""
    if channel.message_encoding == "json":
        return load_json
    if channel.message_encoding == "cdr" and schema is not None and schema.encoding == "ros2msg":
        return ros2_decoder(schema.name, schema.data.decode())
    form = f"{channel.message_encoding}{f' of {schema.encoding}' if schema is not None else ''}"
    raise InputError(f"topic {quoted(channel.topic)} is encoded as {quoted(form)}, which is not read; only ROS 2 and JSON are")


def ros2_decoder(name: str, definition: str) -> Callable[[bytes], Any]:
    """Make the decoder of ROS 2 messages by the definition of their type.

    Raises:
        InputError: for a definition that is none.
    """
    factory, records = library("mcap_ros2.decoder", KIND), library("mcap.records", KIND)
    try:
        schema = records.Schema(id=1, data=definition.encode(), encoding="ros2msg", name=name)
        found: Callable[[bytes], Any] = factory.DecoderFactory().decoder_for("cdr", schema)
    except Exception as error:  # a damaged text makes its parser raise nearly anything
        raise InputError(f"the definition of {quoted(name)} cannot be read: {quoted(str(error))}") from None
    return found


FORMAT = Format(KIND, (".mcap",), ("variable",), read)
