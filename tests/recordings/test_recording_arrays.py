"""Recordings from arrays, their parts, and files that come back bit for bit."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from recording_files import example, same, save

from flexarm_env.errors import InputError
from flexarm_env.recordings import table
from flexarm_env.recordings.columns import UNITS
from flexarm_env.recordings.recording import Recording
from flexarm_env.sensors import known_sensors


@pytest.mark.parametrize(
    ("changes", "wanted"),
    [
        ({"input_kind": "force"}, "unknown input 'force'"),
        ({"signals": {"arm_angel": np.zeros(5)}}, "did you mean 'arm_angle'"),
        ({"signals": {}}, "no measured signal"),
        ({"command": np.zeros(4)}, "lengths differ"),
        ({"command": np.zeros((5, 1))}, "vector"),
        ({"command": [1, [2], 3, 4, 5]}, "vector"),
        ({"command": list("abcde")}, "vector"),
        ({"command": [1, 2, 3, 4, np.inf]}, "sample 5, column 'current'"),
        ({"command": [1, 2, 3, np.nan, 5]}, "sample 4, column 'current': is nan"),
        ({"reference": [1, 2, 3, np.nan, 5]}, "sample 4, column 'reference': is nan"),
        ({"signals": {"arm_angle": [1, np.nan, np.inf, 4, 5]}}, "sample 3, column 'arm_angle': is inf"),
        ({"signals": {"arm_angle": np.zeros(5), "strain_mid": np.full(5, np.nan)}}, "column 'strain_mid': has no reading"),
        ({"time": [0, 1, 2, 2, 3]}, "sample 4, column 'time': repeats"),
        ({"time": [-1e308, 0, 1e308, 1.1e308, 1.2e308]}, "column 'time'"),
        ({"conditions": {"payload": -1.0}}, "payload"),
        ({"conditions": {"a b": 1.0}}, "'a b'"),
        ({"conditions": {3: 1.0}}, "condition 3: write its name in letters"),
        ({"conditions": {"payload": "0.3 kg"}}, "condition 'payload' is '0.3 kg'; write a finite number"),
        ({"conditions": {"payload": None}}, "condition 'payload' is None; write a finite number"),
        ({"conditions": {"kp": [1, 2]}}, "condition 'kp' is [1, 2]; write a finite number"),
        ({"conditions": {"kp": 10**400}}, "write a finite number"),
        ({"conditions": ["payload"]}, "conditions = ['payload']; give a dict"),
        ({"signals": None}, "signals = None; give a dict"),
        ({"signals": {3: np.zeros(5)}}, "unknown signal 3"),
        ({"input_kind": None}, "unknown input None"),
        ({"input_kind": ["current"]}, "unknown input ['current']"),
        ({"command": np.ma.masked_array(np.zeros(5), mask=[0, 0, 0, 1, 0])}, "sample 4, column 'current': is nan"),
        ({"time": np.ma.masked_array(np.arange(5), mask=[0, 1, 0, 0, 0])}, "sample 2, column 'time': is nan"),
        ({"command": np.full(5, np.longdouble("1e4000"))}, "column 'current': is inf"),
    ],
)
def test_arrays_are_checked_as_files_are(changes: dict[str, Any], wanted: str) -> None:
    with pytest.raises(InputError) as caught:
        example(**changes)
    assert wanted in str(caught.value)


def test_a_masked_sample_was_not_measured() -> None:
    """What stands under a mask, such as -999 of a logger, is no reading."""
    readings = np.ma.masked_array([1, -999, 3, 4, 5], mask=[False, True, False, False, False])
    angle = example(signals={"arm_angle": readings}).signals["arm_angle"]
    assert np.array_equal(angle, [1.0, np.nan, 3.0, 4.0, 5.0], equal_nan=True)


def test_arrays_are_copied() -> None:
    command = np.zeros(5)
    recording = example(command=command, time=2.0 + np.arange(5))
    command[:] = 9
    assert not recording.command.any()
    assert recording.time[0] == 0


def test_part_is_in_seconds_and_half_open() -> None:
    recording = example(10, conditions={"payload": 0.5})
    part = recording.part(0.3, 0.7)
    assert part.command.tolist() == [3, 4, 5, 6]
    assert part.time[0] == 0
    assert part.conditions == {"payload": 0.5, "start": recording.time[3]}
    assert part.part(0.1).conditions["start"] == pytest.approx(0.4)
    assert same(recording.part(), recording)
    lengths = [len(recording.part(0.0, 0.4)), len(recording.part(0.4))]
    assert lengths == [4, 6]
    with pytest.raises(InputError, match="fewer than two samples"):
        recording.part(0.85)


readings = st.floats(-1e7, 1e7)


@st.composite
def recordings(draw: st.DrawFn) -> Recording:
    n = draw(st.integers(2, 12))
    column = arrays(np.float64, n, elements=readings)
    measured = arrays(np.float64, n, elements=readings | st.just(np.nan)).filter(lambda values: not np.isnan(values).all())
    steps = draw(arrays(np.float64, n - 1, elements=st.floats(0.02, 100.0)))
    names = draw(st.lists(st.sampled_from(list(known_sensors())), min_size=1, unique=True))
    return Recording.from_arrays(
        "drawn",
        np.concatenate([[0.0], np.cumsum(steps)]),
        draw(st.sampled_from(["current", "voltage"])),
        draw(column),
        {name: draw(measured) for name in names},
        draw(st.none() | column),
        draw(st.dictionaries(st.sampled_from(["payload", "temperature", "start"]), st.floats(0, 1e6))),
    )


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(recordings())
def test_a_written_recording_comes_back_bit_for_bit(tmp_path: Path, recording: Recording) -> None:
    path = tmp_path / "again.csv"
    recording.write(path)
    assert same(Recording.read(path), recording)
    part = recording.part()
    part.write(path)
    assert same(Recording.read(path), part)


def test_the_header_is_the_contract(tmp_path: Path) -> None:
    names = ("tip_deflection", "strain_base", "strain_mid", "motor_speed", "arm_angle")
    signals = {name: np.zeros(2) for name in names}
    recording = example(2, signals=signals, reference=np.zeros(2), conditions={"payload": 0.3})
    recording.write(tmp_path / "run.csv")
    lines = (tmp_path / "run.csv").read_text().splitlines()
    assert lines[0] == "# payload = 0.3 kg"
    assert lines[1] == (
        "time [s],current [A],arm_angle [rad],motor_speed [rad/s],strain_mid [V],strain_base [V],"
        "tip_deflection [m],reference [rad]"
    )
    assert all(f"[{UNITS[name]}]" in lines[1] for name in signals)


def test_writing_is_whole_or_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = save(tmp_path, "before")

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(InputError, match="No space left"):
        example().write(path)
    assert path.read_text() == "before"
    assert os.listdir(tmp_path) == ["run.csv"]


def test_writing_where_one_cannot(tmp_path: Path) -> None:
    for path in (tmp_path / "none" / "run.csv", tmp_path):
        with pytest.raises(InputError, match="cannot write"):
            example().write(path)
    assert os.listdir(tmp_path) == []


def test_the_largest_file_is_stated_in_bytes() -> None:
    assert table.LARGEST_FILE == 256 * 1024**2
