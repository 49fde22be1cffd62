"""Parquet tables, MCAP files and a ROS 2 bag, written by the libraries of the extra `logs`."""

from __future__ import annotations

import json
import sqlite3
from pathlib import Path
from typing import Any

import numpy as np
import pytest

N = 8
STARTED = 1_700_000_000_900_000_000
STAMPS = [STARTED + 20_000_000 * k for k in range(N)]
TIMES = 0.02 * np.arange(N)
JOINT_STATE = """std_msgs/Header header
string[] name
float64[] position
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
JOINTS = {
    "time": {"variable": "header.stamp", "unit": "s"},
    "current": {"variable": "/joint_states.effort[0]", "unit": "A"},
    "arm_angle": {"variable": "/joint_states.position[hub]", "unit": "rad"},
}


def parquet(path: Path, **columns: Any) -> Path:
    arrow = pytest.importorskip("pyarrow")
    pytest.importorskip("pyarrow.parquet").write_table(arrow.table(columns), path)
    return path


def mcap(path: Path, compression: str = "ZSTD", effort: bool = True) -> Path:
    """Joint states at 50 Hz, and a command 5 ms later at 100 Hz."""
    pytest.importorskip("mcap_ros2")
    from mcap.writer import CompressionType
    from mcap_ros2.writer import Writer

    with path.open("wb") as file:
        writer = Writer(file, compression=getattr(CompressionType, compression))
        states = writer.register_msgdef("sensor_msgs/msg/JointState", JOINT_STATE)
        number = writer.register_msgdef("std_msgs/msg/Float64", "float64 data\n")
        for k, stamp in enumerate(STAMPS):
            names = ["hub", "tip"] if k % 2 else ["tip", "hub"]  # a driver need not keep their order
            positions = [0.1 * k, -1.0] if k % 2 else [-1.0, 0.1 * k]
            header = {"stamp": {"sec": stamp // 10**9, "nanosec": stamp % 10**9}, "frame_id": ""}
            state = {"header": header, "name": names, "position": positions, "effort": [float(k)] if effort else []}
            writer.write_message("/joint_states", states, state, log_time=stamp + 1000, publish_time=stamp)
            for step in (0, 1):
                time = stamp + 5_000_000 + step * 10_000_000
                writer.write_message("/motor/command", number, {"data": float(2 * k + step)}, log_time=time, publish_time=time)
        writer.finish()
    return path


def messages(path: Path, sent: list[tuple[str, dict[str, Any]]]) -> Path:
    """Messages of JSON, each of a topic."""
    pytest.importorskip("mcap")

    from mcap.writer import Writer

    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        schema = writer.register_schema("State", "jsonschema", b"{}")
        channels = {topic: writer.register_channel(topic, "json", schema) for topic in dict(sent)}
        for k, (topic, content) in enumerate(sent):
            writer.add_message(channels[topic], log_time=k, data=json.dumps(content).encode(), publish_time=k)
        writer.finish()
    return path


def sqlite_bag(folder: Path) -> Path:
    """A bag of one topic without messages."""
    path = folder / "empty.db3"
    base = sqlite3.connect(path)
    base.executescript(
        "CREATE TABLE topics(id INTEGER, name TEXT, type TEXT, serialization_format TEXT);"
        "CREATE TABLE messages(id INTEGER, topic_id INTEGER, timestamp INTEGER, data BLOB);"
        "CREATE TABLE message_definitions(id INTEGER, topic_type TEXT, encoding TEXT, encoded_message_definition TEXT);"
        "INSERT INTO topics VALUES (1, '/joint_states', 'sensor_msgs/msg/JointState', 'cdr');"
    )
    base.execute("INSERT INTO message_definitions VALUES (1, 'sensor_msgs/msg/JointState', 'ros2msg', ?)", (JOINT_STATE,))
    base.commit()
    base.close()
    return path
