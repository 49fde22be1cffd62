"""Logs of robots of every format: without the extra `logs`, and damaged."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from recording_files import refusal, save
from robot_logs import JOINTS, TIMES, mcap, parquet, sqlite_bag

from flexarm_env.errors import InputError
from flexarm_env.recordings.recording import Recording


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
