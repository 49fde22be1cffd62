"""Parquet tables, MCAP files and ROS 2 bags, written here by the libraries of the extra `logs`."""

from __future__ import annotations

import shutil
import sqlite3
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from recording_files import refusal, save

from flexarm_env.errors import InputError
from flexarm_env.recordings.recording import Recording

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


@pytest.mark.parametrize(
    ("suffix", "package"), [(".parquet", "pyarrow"), (".mcap", "mcap"), (".db3", "mcap")], ids=["parquet", "mcap", "db3"]
)
def test_the_missing_extra_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, suffix: str, package: str) -> None:
    for name in ("pyarrow", "pyarrow.parquet", "mcap", "mcap_ros2", "mcap_ros2.decoder"):
        monkeypatch.setitem(sys.modules, name, None)
    content = sqlite_bag(tmp_path).read_bytes() if suffix == ".db3" else b"x" * 100
    table = {"time": {"column": "t", "unit": "s"}, "current": {"column": "i", "unit": "A"}} if suffix == ".parquet" else JOINTS
    message = refusal(save(tmp_path, content, f"run{suffix}"), columns=table)
    assert f"is read by {package}" in message
    assert message.endswith("pip install 'flexarm-env[logs]'")


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


def parquet(path: Path, **columns: Any) -> Path:
    arrow = pytest.importorskip("pyarrow")
    pytest.importorskip("pyarrow.parquet").write_table(arrow.table(columns), path)
    return path


def test_parquet_under_our_own_header(tmp_path: Path) -> None:
    path = parquet(
        tmp_path / "run.parquet",
        **{"time [ms]": 1000 * TIMES, "current [A]": np.arange(N), "arm_angle [deg]": np.arange(N, dtype=np.float32)},
    )
    recording = Recording.read(path)
    assert np.allclose(recording.time, TIMES, rtol=0, atol=1e-15)
    assert np.allclose(Recording.read(path, {"arm_angle": {"sign": -1}}).signals["arm_angle"], -np.pi / 180 * np.arange(N))


def test_two_quantities_of_one_parquet_column_are_refused(tmp_path: Path) -> None:
    path = parquet(tmp_path / "run.parquet", t=TIMES, i=np.arange(N), q=np.arange(N))
    table = {name: {"column": "q", "unit": unit} for name, unit in (("current", "A"), ("arm_angle", "rad"))}
    assert "columns 'current' and 'arm_angle': both map to 'q'; correct one of them" in refusal(
        path, columns={"time": {"column": "t", "unit": "s"}, **table}
    )
    arrow = pytest.importorskip("pyarrow")
    twice = arrow.Table.from_arrays([arrow.array(TIMES), arrow.array(TIMES), arrow.array(TIMES)], names=["t", "q", "q"])
    pytest.importorskip("pyarrow.parquet").write_table(twice, tmp_path / "twice.parquet")
    table |= {"current": {"column": "t", "unit": "A"}}
    assert "column 'arm_angle': the header has 'q' twice" in refusal(
        tmp_path / "twice.parquet", columns={"time": {"rate": 50}, **table}
    )


def test_true_and_false_in_parquet_are_those_of_a_condition(tmp_path: Path) -> None:
    table = {name: {"column": name[0], "unit": unit} for name, unit in (("time", "s"), ("current", "A"), ("arm_angle", "rad"))}
    path = parquet(tmp_path / "run.parquet", t=TIMES, c=np.ones(N, bool), a=TIMES, x=np.zeros(N))
    assert refusal(path, columns=table) == "column 'current': is 'bool', no numbers; name another"
    table |= {"current": {"column": "x", "unit": "A"}, "conditions": {"on": {"column": "c", "unit": "1"}}}
    assert Recording.read(path, table).conditions == {"on": 1.0}


def test_parquet_by_a_map_with_lists_and_timestamps(tmp_path: Path) -> None:
    arrow = pytest.importorskip("pyarrow")
    path = parquet(
        tmp_path / "run.parquet",
        timestamp=arrow.array(np.array(STAMPS).astype("datetime64[ns]")),
        seconds=TIMES,
        state=arrow.array([[float(k), 2.0 * k] for k in range(N)], arrow.list_(arrow.float32(), 2)),
        action=arrow.array([[1.0 * k] for k in range(N)]),
        camera=arrow.array([1.0 * k if k % 2 == 0 else None for k in range(N)]),
        note=arrow.array(["a"] * N),
    )
    table: dict[str, Any] = {
        "time": {"column": "timestamp", "unit": "ms"},
        "current": {"column": "action[0]", "unit": "A"},
        "arm_angle": {"column": "state[1]", "unit": "rad"},
        "tip_deflection": {"column": "camera", "unit": "mm"},
    }
    recording = Recording.read(path, table)
    assert np.allclose(recording.time, TIMES, rtol=0, atol=1e-12)
    assert recording.command.tolist() == list(range(N))
    assert recording.signals["arm_angle"].tolist() == list(range(0, 2 * N, 2))
    assert np.array_equal(np.isnan(recording.signals["tip_deflection"]), np.arange(N) % 2 == 1)
    assert np.array_equal(Recording.read(path, {**table, "time": {"index": 1, "unit": "s"}}).command, recording.command)
    for place, words in (
        ("action", "'list<element: double>'; name one of its elements, as [0]"),
        ("action[1]", "have 1 elements, no [1]"),
        ("state[2]", "have 2 elements, no [2]"),
        ("seconds[0]", "'double'; leave [...] out"),
        ("note", "'string', no numbers"),
        ("acton[0]", "no 'acton' in the header; did you mean 'action'?"),
    ):
        assert words in refusal(path, columns={**table, "current": {"column": place, "unit": "A"}})


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


@pytest.mark.parametrize("compression", ["NONE", "LZ4", "ZSTD"])
def test_joint_states_in_mcap(tmp_path: Path, compression: str) -> None:
    recording = Recording.read(mcap(tmp_path / "run.mcap", compression), JOINTS)
    assert np.allclose(recording.time, TIMES, rtol=0, atol=1e-9)
    assert recording.command.tolist() == list(range(N))
    assert np.allclose(recording.signals["arm_angle"], 0.1 * np.arange(N))


def test_topics_at_other_times(tmp_path: Path) -> None:
    table = {**JOINTS, "time": {"variable": "log_time", "unit": "s"}, "current": {"variable": "/motor/command.data", "unit": "A"}}
    recording = Recording.read(mcap(tmp_path / "run.mcap"), table)
    assert len(recording) == 3 * N - 1  # the first state comes before the first command
    measured = ~np.isnan(recording.signals["arm_angle"])
    assert np.allclose(recording.signals["arm_angle"][measured], 0.1 * np.arange(1, N))
    assert np.allclose(np.diff(recording.time[measured]), 0.02, rtol=0, atol=1e-9)
    assert recording.command[measured].tolist() == [2 * k - 1 for k in range(1, N)]


def messages(path: Path, sent: list[tuple[str, dict[str, Any]]]) -> Path:
    """Messages of JSON, each of a topic."""
    pytest.importorskip("mcap")
    import json

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


TOPICS = {
    "time": {"variable": "t", "unit": "s"},
    "current": {"variable": "/motor.i", "unit": "A"},
    "arm_angle": {"variable": "/state.q", "unit": "rad"},
}


def test_held_readings_are_those_of_the_messages_of_their_topic(tmp_path: Path) -> None:
    """Beside the commands between them, no row repeats the one before it."""
    sent = [("/motor", {"t": 0.01 * k - 0.002, "i": k}) for k in range(13)]
    sent += [("/state", {"t": 0.01 * k, "q": 1.0 + k // 3}) for k in range(12)]
    path = messages(tmp_path / "run.mcap", sent)
    found = [Recording.read(path, TOPICS | {"arm_angle": TOPICS["arm_angle"] | how}) for how in ({}, {"repeats": 3})]
    measured = [run.signals["arm_angle"][~np.isnan(run.signals["arm_angle"])] for run in found]
    assert [len(found[0]), len(measured[0])] == [25, 12]
    assert measured[1].tolist() == [1.0, 2.0, 3.0, 4.0]
    assert found[1].time[~np.isnan(found[1].signals["arm_angle"])] == pytest.approx(0.002 + 0.03 * np.arange(4))


@pytest.mark.parametrize(("of_time", "own"), [("0 s", "30 ms"), ("30 ms", "0 s"), ("0.05 s", "-0.02 s")])
def test_a_late_topic_is_moved_by_its_whole_shift(tmp_path: Path, of_time: str, own: str) -> None:
    """By no whole number of the rows that commands between the readings make."""
    sent = [("/motor", {"t": 10.0 * k - 2.0, "i": k}) for k in range(13)]
    sent += [("/state", {"t": 10.0 * k + 30.0, "q": float(k)}) for k in range(12)]
    shifted = {name: TOPICS[name] | {"shift": by} for name, by in (("time", of_time), ("arm_angle", own))}
    shifted["time"] |= {"unit": "ms"}
    run = Recording.read(messages(tmp_path / "run.mcap", sent), TOPICS | shifted)
    measured = ~np.isnan(run.signals["arm_angle"])
    assert run.time[measured] == pytest.approx(0.002 + 0.01 * run.signals["arm_angle"][measured], abs=1e-12)
    assert measured.sum() == 12


@pytest.mark.parametrize(
    ("times", "words"),
    [
        ([{"sec": 0, "nanosec": 5}, 0.1], "'t' is a stamp with nanoseconds in some messages and a number in others; name a time"),
        ([0.0, float("inf")], "message 2 of topic '/state', column 'time': is no time; correct it"),
        ([0.0, 10**400], "message 2 of topic '/state', column 'time': is no time; correct it"),
        ([float("nan"), 1.0], "message 1 of topic '/state', column 'time': is no time; correct it"),
        ([{"sec": 10**400, "nanosec": 5}, {"sec": 0, "nanosec": 5}], "message 1 of topic '/state', column 'time': is no time"),
    ],
)
def test_times_of_messages_that_are_none_are_refused(tmp_path: Path, times: list[Any], words: str) -> None:
    kind = {"sec": 0, "nanosec": 0} if isinstance(times[-1], dict) else 0.0
    sent = [("/motor", {"t": kind, "i": 0}), ("/motor", {"t": kind if kind else 1.0, "i": 0})]
    sent += [("/state", {"t": time, "q": 0.0}) for time in times]
    assert words in refusal(messages(tmp_path / "run.mcap", sent), columns=TOPICS)


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        ("/joint_state.effort[0]", "no topic '/joint_state'; did you mean '/joint_states'?"),
        ("/joint_states.efort[0]", "a message has no 'efort', but 'header', 'name', 'position', 'effort'"),
        ("/joint_states.effort[3]", "a message has no '[3]', but 1 elements, counted from 0"),
        ("/joint_states.position[knee]", "a message has no '[knee]'"),
        ("/joint_states.position", "leads to 2 elements, counted from 0, not to a number"),
        ("/joint_states.header", "leads to 'stamp', 'frame_id', not to a number"),
        ("/joint_states", "is no path; write one such as '/joint_states.position[0]'"),
        ("joint_states.effort[0]", "is no path"),
    ],
)
def test_paths_that_lead_nowhere(tmp_path: Path, entry: str, words: str) -> None:
    path = mcap(tmp_path / "run.mcap")
    assert words in refusal(path, columns={**JOINTS, "current": {"variable": entry, "unit": "A"}})


def test_json_in_mcap(tmp_path: Path) -> None:
    pytest.importorskip("mcap")
    import json

    from mcap.writer import Writer

    with (tmp_path / "run.mcap").open("wb") as file:
        writer = Writer(file)
        writer.start()
        schema = writer.register_schema("State", "jsonschema", b"{}")
        channels = [writer.register_channel(topic, form, schema) for topic, form in (("/state", "json"), ("/other", "protobuf"))]
        for k, stamp in enumerate(STAMPS):
            data = {"t": 0.02 * k, "motor": {"i": k}, "phi": [0.5 * k]}
            for channel in channels:
                late = stamp + k * 1_000_000  # by more each time, so that one clock is not taken for the other
                writer.add_message(channel, log_time=late, data=json.dumps(data).encode(), publish_time=late)
        writer.finish()
    table = {
        "time": {"variable": "t", "unit": "s"},
        "current": {"variable": "/state.motor.i", "unit": "A"},
        "arm_angle": {"variable": "/state.phi[0]", "unit": "rad"},
    }
    recording = Recording.read(tmp_path / "run.mcap", table)
    assert np.allclose(recording.time, TIMES, rtol=0, atol=1e-12)
    assert recording.signals["arm_angle"].tolist() == [0.5 * k for k in range(N)]
    by_log = Recording.read(tmp_path / "run.mcap", {**table, "time": {"variable": "log_time", "unit": "s"}})
    assert np.allclose(by_log.time, 1.05 * TIMES, rtol=0, atol=1e-9)
    other = {**table, "current": {"variable": "/other.motor.i", "unit": "A"}}
    assert "topic '/other' is encoded as 'protobuf of jsonschema'" in refusal(tmp_path / "run.mcap", columns=other)


def test_a_chunk_that_unpacks_to_more_than_a_file_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flexarm_env.recordings.formats.mcap.LARGEST_FILE", 2000)
    for compression in ("LZ4", "ZSTD"):
        assert "once unpacked" in refusal(mcap(tmp_path / "run.mcap", compression), columns=JOINTS)


@pytest.mark.parametrize("defined", [True, False])
def test_a_bag_in_sqlite(tmp_path: Path, defined: bool) -> None:
    pytest.importorskip("rosbags")
    pytest.importorskip("mcap_ros2")
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    kinds = store.types
    folder = tmp_path / "bag"
    with Writer(folder, version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
        connection = writer.add_connection("/joint_states", "sensor_msgs/msg/JointState", typestore=store)
        for k, stamp in enumerate(STAMPS):
            time = kinds["builtin_interfaces/msg/Time"](sec=stamp // 10**9, nanosec=stamp % 10**9)
            header = kinds["std_msgs/msg/Header"](stamp=time, frame_id="")
            numbers = np.array([0.1 * k]), np.array([0.0]), np.array([1.0 * k])
            message = kinds["sensor_msgs/msg/JointState"](header, ["hub"], *numbers)
            writer.write(connection, stamp, store.serialize_cdr(message, "sensor_msgs/msg/JointState"))
    (path,) = folder.glob("*.db3")
    base = sqlite3.connect(path)
    if not defined:
        base.execute("DROP TABLE message_definitions")  # as bags were before the distribution Iron
        base.commit()
    base.close()
    recording = Recording.read(path, JOINTS)
    assert np.allclose(recording.time, TIMES, rtol=0, atol=1e-9)
    assert recording.command.tolist() == list(range(N))
    assert np.allclose(recording.signals["arm_angle"], 0.1 * np.arange(N))
    (found,) = Recording.read_all(folder, JOINTS)  # beside it lies metadata.yaml
    assert found.name == path.stem
    if not defined:
        base = sqlite3.connect(path)
        base.execute("UPDATE topics SET type = 'my_msgs/msg/State'")
        base.commit()
        base.close()
        assert "type 'my_msgs/msg/State' is defined neither in the bag nor by ROS" in refusal(path, columns=JOINTS)


def test_bags_that_are_none(tmp_path: Path) -> None:
    pytest.importorskip("mcap_ros2")
    assert "topic '/joint_states' has 0 messages" in refusal(sqlite_bag(tmp_path), columns=JOINTS)
    assert "is damaged or no ROS 2 bag" in refusal(save(tmp_path, b"nothing" * 100, "run.db3"), columns=JOINTS)
    other = tmp_path / "other.db3"
    base = sqlite3.connect(other)
    base.execute("CREATE TABLE a(b)")
    base.close()
    assert "no tables of topics and messages" in refusal(other, columns=JOINTS)
    assert "a ROS 2 bag needs a [columns] table" in refusal(other)


def test_rates_and_two_columns_are_no_time_of_messages(tmp_path: Path) -> None:
    path = mcap(tmp_path / "run.mcap")
    assert "'log_time', not a rate" in refusal(path, columns={**JOINTS, "time": {"rate": 100}})
    two = {"variable": ["header.stamp.sec", "header.stamp.nanosec"], "unit": ["s", "ns"]}
    assert "give one path, such as 'header.stamp'" in refusal(path, columns={**JOINTS, "time": two})


@pytest.mark.parametrize("kind", ["mcap", "parquet", "db3"])
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_damaged_logs_are_read_or_refused(tmp_path: Path, kind: str, data: st.DataObject) -> None:
    table: dict[str, Any] = JOINTS
    whole = tmp_path / f"whole.{kind}"
    if not whole.exists() and kind == "parquet":
        parquet(whole, t=TIMES, i=TIMES, phi=TIMES)
    elif not whole.exists() and kind == "mcap":
        mcap(whole)
    elif not whole.exists():
        pytest.importorskip("mcap_ros2")
        shutil.copy(sqlite_bag(tmp_path), whole)
    if kind == "parquet":
        table = {
            "time": {"column": "t", "unit": "s"},
            "current": {"column": "i", "unit": "A"},
            "arm_angle": {"column": "phi", "unit": "rad"},
        }
    content = bytearray(whole.read_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        place = data.draw(st.integers(0, len(content) - 1))
        content[place : place + data.draw(st.integers(0, 8))] = data.draw(st.binary(max_size=8))
    message = ""
    try:
        assert np.all(np.diff(Recording.read(save(tmp_path, bytes(content), f"run.{kind}"), table).time) > 0)
    except InputError as error:
        message = str(error)
    assert len(message) < 1000
