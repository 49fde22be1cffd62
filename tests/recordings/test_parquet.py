"""Parquet tables."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recording_files import refusal
from robot_logs import STAMPS, TIMES, N, parquet

from flexarm_env.recordings.recording import Recording


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


def test_stamps_of_a_scale_are_refused_in_parquet(tmp_path: Path) -> None:
    arrow = pytest.importorskip("pyarrow")
    path = parquet(tmp_path / "run.parquet", t=arrow.array(np.array(STAMPS).astype("datetime64[ns]")), i=TIMES, q=TIMES)
    table: dict[str, Any] = {name: {"column": name[0], "unit": unit} for name, unit in (("time", "s"), ("current", "A"))}
    table |= {"current": {"column": "i", "unit": "A"}, "arm_angle": {"column": "q", "unit": "rad"}}
    assert np.allclose(Recording.read(path, table).time, TIMES, rtol=0, atol=1e-12)
    table["time"]["scale"] = 0.001
    assert "column 'time': scale is 0.001, but its times have a unit of their own" in refusal(path, columns=table)
