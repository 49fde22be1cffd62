"""ROS 2 bags in SQLite."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import numpy as np
import pytest
from recording_files import refusal, save
from robot_logs import JOINTS, STAMPS, TIMES, N, sqlite_bag

from flexarm_env.recordings.recording import Recording


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
