"""MCAP files of ROS 2 messages and of JSON."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recording_files import refusal
from robot_logs import JOINTS, STAMPS, TIMES, N, mcap, messages

from flexarm_env.recordings.recording import Recording


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


def test_rates_and_two_columns_are_no_time_of_messages(tmp_path: Path) -> None:
    path = mcap(tmp_path / "run.mcap")
    assert "'log_time', not a rate" in refusal(path, columns={**JOINTS, "time": {"rate": 100}})
    two = {"variable": ["header.stamp.sec", "header.stamp.nanosec"], "unit": ["s", "ns"]}
    assert "give one path, such as 'header.stamp'" in refusal(path, columns={**JOINTS, "time": two})
