"""Readings that are absent in a file, and the corrections of a signal that a column map states."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from recording_files import GOOD, HEADER, LOGGER, example, refusal, save
from work import calls, ends

from flexarm_env.errors import InputError
from flexarm_env.recordings.column_maps import load_columns
from flexarm_env.recordings.corrections import Corrections
from flexarm_env.recordings.recording import Recording

NATIVE: dict[str, Any] = {
    "time": {"column": "time [s]", "unit": "s"},
    "current": {"column": "current [A]", "unit": "A"},
    "arm_angle": {"column": "arm_angle [rad]", "unit": "rad"},
}


def mapped(time: Any = None, **corrections: Any) -> dict[str, Any]:
    """The map of a file with FlexArm's own header, with corrections of the angle, and of time."""
    return NATIVE | {"arm_angle": NATIVE["arm_angle"] | corrections, "time": NATIVE["time"] | (time or {})}


def read(folder: Path, angles: list[float], table: dict[str, Any], step: float = 0.1) -> Recording:
    rows = "".join(f"{step * k!r},1,{'' if np.isnan(v) else repr(v)}\n" for k, v in enumerate(angles))
    return Recording.read(save(folder, f"{HEADER}\n{rows}"), table)


@pytest.mark.parametrize("cell", ["", " ", "\t", "NaN", "nan", "NA", " NA ", '""'])
def test_a_cell_of_a_signal_may_be_empty(tmp_path: Path, cell: str) -> None:
    recording = Recording.read(save(tmp_path, GOOD.replace("0.6", cell)))
    assert np.array_equal(recording.signals["arm_angle"], [0.5, np.nan, 0.7], equal_nan=True)
    assert recording.command.tolist() == [1, 2, 3]
    assert recording.notes == ("'arm_angle' was measured in 2 of 3 rows",)
    assert "arm_angle (66.7 % measured)" in repr(recording)


@pytest.mark.parametrize("cell", ["", " ", "\t", "NaN", "nan", "NA", " NA ", '""'])
def test_an_empty_cell_of_the_command_holds_the_last_one(tmp_path: Path, cell: str) -> None:
    """As a drive does; some logs have a row for each message of any sensor."""
    recording = Recording.read(save(tmp_path, GOOD.replace("2,0.6", f"{cell},0.6")))
    assert recording.command.tolist() == [1, 1, 3]
    assert recording.signals["arm_angle"].tolist() == [0.5, 0.6, 0.7]
    assert recording.notes == ("'current' stands in 2 of 3 rows; in the others the last command holds",)
    recording.write(tmp_path / "again.csv")
    again = Recording.read(tmp_path / "again.csv")
    assert (again.command.tolist(), again.notes) == ([1, 1, 3], ())


def test_arrays_have_a_command_for_every_sample() -> None:
    with pytest.raises(InputError, match="sample 2, column 'current': is nan"):
        Recording.from_arrays("run", [0, 1, 2], "current", [1, np.nan, 2], {"arm_angle": [0, 1, 2]})


@pytest.mark.parametrize(("delimiter", "decimal"), [(";", ","), ("\t", "."), (" ", ".")])
def test_so_may_those_of_other_tables(tmp_path: Path, delimiter: str, decimal: str) -> None:
    rows = [["0", "1.5", "2.5"], ["1", "1.5", "NA" if delimiter == " " else ""], ["2", "1.5", "nan"]]
    text = "\n".join(delimiter.join(row).replace(".", decimal) for row in rows)
    places = {
        name: {"index": k, "unit": unit} for k, (name, unit) in enumerate([("time", "s"), ("current", "A"), ("arm_angle", "rad")])
    }
    recording = Recording.read(save(tmp_path, text), {"delimiter": delimiter, "decimal": decimal, **places})
    assert np.array_equal(recording.signals["arm_angle"], [2.5, np.nan, np.nan], equal_nan=True)


def test_rows_of_gaps_are_read_as_fast_as_others(tmp_path: Path) -> None:
    rows = [f"{k},1,0.25" for k in range(60_000)]
    gaps = [row if k % 10 == 0 else row.removesuffix("0.25") for k, row in enumerate(rows)]
    taken = []
    for lines in (rows, gaps):
        path = save(tmp_path, "\n".join([HEADER, *lines, ""]))
        taken.append(calls(functools.partial(Recording.read, path)))
    assert taken[1] < 2 * taken[0]


def test_blanks_in_a_cell_take_no_time_that_grows_with_their_square(tmp_path: Path) -> None:
    path = save(tmp_path, GOOD.replace("0.6", f"{' ' * 130_000}x").replace("0.7", ""))
    with ends():
        assert "is not a number" in refusal(path)


def test_a_part_leaves_out_what_was_not_measured_there() -> None:
    signals = {"arm_angle": [0, 1, 2, 3, 4, 5], "strain_base": [0, 1, *[np.nan] * 4]}
    recording = example(6, signals=signals)
    assert list(recording.part(0.0, 0.3).signals) == ["arm_angle", "strain_base"]
    assert list(recording.part(0.2).signals) == ["arm_angle"]
    with pytest.raises(InputError, match=r"nothing was measured from 0\.2 to None s"):
        example(6, signals={"strain_base": signals["strain_base"]}).part(0.2)


def test_spans_to_ignore_end_before_their_stop(tmp_path: Path) -> None:
    angles = np.arange(20.0)
    table = mapped(ignore=[[0, "0.3 s"], ["1500 ms", float("inf")]])
    found = read(tmp_path, angles.tolist(), table, step=0.125).signals["arm_angle"]
    assert np.flatnonzero(np.isnan(found)).tolist() == [0, 1, 2, *range(12, 20)]
    assert found[3:12].tolist() == angles[3:12].tolist()


def test_readings_at_the_ends_of_a_range_are_none(tmp_path: Path) -> None:
    found = read(tmp_path, [-2.0, -1.5, -1.4, 0.0, 1.4, 1.5, 9e9], mapped(range=["-1.5 rad", 1.5]))
    assert np.isnan(found.signals["arm_angle"]).tolist() == [True, True, False, False, False, True, True]
    assert "over 1e+07" in refusal(save(tmp_path, GOOD.replace("0.6", "9e9")), columns=mapped())


def test_nothing_is_left_of_a_signal(tmp_path: Path) -> None:
    message = refusal(save(tmp_path, GOOD), columns=mapped(ignore=[[0, 10]]))
    assert message == "column 'arm_angle': has no reading in any row; leave the column out"


@given(
    held=arrays(np.float64, st.integers(2, 12), elements=st.sampled_from([0.0, 1.0, 2.0])),
    times=st.integers(2, 7),
    phase=st.integers(0, 6),
    end=st.integers(0, 6),
)
def test_of_held_readings_the_first_counts(held: np.ndarray, times: int, phase: int, end: int) -> None:
    assume(len(np.unique(held)) > 1)
    rows = np.repeat(held, times)
    begun = min(phase, times - 1)
    shown = rows[begun : len(rows) - min(end, times - 1)]
    found = Corrections(repeats=times).apply(np.arange(len(shown)), shown)
    first = np.arange(len(rows)) % times == 0
    expected = np.where(first, rows, np.nan)[begun : len(rows) - min(end, times - 1)]
    assert np.array_equal(found, expected, equal_nan=True)


@pytest.mark.parametrize("times", [2, 3, 5])
def test_of_a_reading_that_never_changes_the_first_of_each_beat_counts(times: int) -> None:
    found = Corrections(repeats=times).apply(np.arange(11), np.full(11, 0.5))
    assert np.flatnonzero(~np.isnan(found)).tolist() == list(range(0, 11, times))


def test_a_held_reading_that_comes_late_counts_from_its_change_and_once() -> None:
    values = np.array([1.0] * 5 + [2.0] * 6 + [3.0] * 4 + [4.0] * 10)
    found = Corrections(repeats=5).apply(np.arange(25), values)
    assert np.flatnonzero(~np.isnan(found)).tolist() == [0, 5, 11, 15, 20]


@given(
    steps=arrays(np.float64, st.integers(2, 40), elements=st.floats(-3.0, 3.0)),
    absent=st.sets(st.integers(0, 40)),
    modulus=st.sampled_from([2.0 * np.pi, 6.5, 100.0]),
)
def test_a_wrap_is_undone(steps: np.ndarray, absent: set[int], modulus: float) -> None:
    whole = np.cumsum(steps)
    there = np.array([k not in absent for k in range(len(whole))])
    assume(there.any() and np.all(np.abs(np.diff(whole[there])) < 0.49 * modulus))
    values = np.where(there, np.mod(whole, modulus), np.nan)
    found = Corrections(wrap=modulus).apply(np.arange(len(values)), values)
    off = (found - whole)[there]
    assert np.ptp(off) < 1e-9
    assert np.isnan(found).tolist() == (~there).tolist()


@given(values=arrays(np.float64, 30, elements=st.floats(-5.0, 5.0) | st.just(np.nan)), rows=st.integers(-25, 25))
def test_a_shift_moves_readings_and_makes_none_up(values: np.ndarray, rows: int) -> None:
    time = 0.002 * np.arange(30)
    found = Corrections(shift=0.002 * rows + 0.0004).apply(time, values)
    expected = np.full(30, np.nan)
    expected[max(-rows, 0) : 30 - max(rows, 0)] = values[max(rows, 0) : 30 + min(rows, 0)]
    assert np.array_equal(found, expected, equal_nan=True)


def test_a_shift_across_uneven_steps_keeps_each_reading_near_its_time() -> None:
    rng = np.random.default_rng(0)
    time = np.cumsum(rng.uniform(0.8, 1.2, 200))
    time -= time[0]
    found = Corrections(shift=5.0).apply(time, time)
    there = ~np.isnan(found)
    step = np.median(np.diff(time))
    assert there.mean() > 0.75
    assert np.abs(found[there] - round(5.0 / step) * step - time[there]).max() <= 0.5 * step
    assert len(np.unique(found[there])) == there.sum()


def test_the_rest_of_a_shift_is_said(tmp_path: Path) -> None:
    angles = np.arange(10.0).tolist()
    own = read(tmp_path, angles, mapped(shift="0.23 s"))
    assert own.notes == (
        "'arm_angle' was measured in 8 of 10 rows",
        "'arm_angle' was moved by 2 rows, back in time; 30 ms of it are less than a row",
    )
    assert own.signals["arm_angle"][:8].tolist() == angles[2:]
    both = read(tmp_path, angles, mapped({"shift": "-0.3 s"}, shift="0.2 s"))
    assert both.notes[1] == "'arm_angle' was moved by 1 row, forward in time"
    assert both.signals["arm_angle"][1:].tolist() == angles[:-1]
    assert both.command.tolist() == [1.0] * 10


def test_corrections_come_after_unit_sign_and_scale(tmp_path: Path) -> None:
    path = save(tmp_path, "t;i;phi\n0;1;350\n1000;1;10\n2000;1;30\n3000;1;100\n")
    corrections = {"wrap": "360 deg", "range": ["-99 deg", "1 rad"], "ignore": [["2 s", 3]]}
    table = LOGGER | {"decimal": ".", "arm_angle": {**LOGGER["arm_angle"], "scale": 1.0, **corrections}}
    found = Recording.read(path, table).signals["arm_angle"]
    assert np.array_equal(np.isnan(found), [True, False, True, True])
    assert found[1] == pytest.approx(np.radians(-10.0))


@pytest.mark.parametrize(
    ("entry", "wanted"),
    [
        ({"repeats": 1}, "repeats is 1; write the number of rows"),
        ({"repeats": "10"}, "repeats is '10'"),
        ({"repeats": True}, "repeats is True"),
        ({"repeats": 10**30}, "repeats is 1000000000000000000000000000000; write the number of rows"),
        ({"wrap": 0}, "wrap is 0; write the size of the jump, such as '6.2832 rad'"),
        ({"wrap": "1 s"}, "wrap: "),
        ({"wrap": [1]}, "wrap is [1]"),
        ({"shift": "1 m"}, "shift: "),
        ({"shift": float("nan")}, "shift is nan"),
        ({"range": ["1 rad", "-1 rad"]}, "range is ['1 rad', '-1 rad']; write the two ends"),
        ({"range": "1 rad"}, "write the two ends of the sensor's range, such as ['-1.5 rad', '1.5 rad']"),
        ({"range": ["1 V", "2 V"]}, "range: "),
        ({"ignore": [0, 1]}, "ignore is [0, 1]; write spans of time, such as [[0, '1.0 s']]"),
        ({"ignore": [[1, 0]]}, "ignore is [[1, 0]]"),
        ({"ignore": [["a", 1]]}, "ignore: 'a'"),
        ({"ignor": [[0, 1]]}, "did you mean 'ignore'"),
    ],
)
def test_corrections_are_checked(entry: dict[str, Any], wanted: str) -> None:
    with pytest.raises(InputError) as caught:
        load_columns(mapped(**entry))
    message = str(caught.value)
    assert message.startswith("[columns] arm_angle: ")
    assert wanted in message
    assert len(message.splitlines()) == 1


@pytest.mark.parametrize(("column", "key"), [("current", "shift"), ("time", "wrap"), ("time", "ignore")])
def test_they_are_for_signals(column: str, key: str) -> None:
    with pytest.raises(InputError, match=f"unknown key '{key}'"):
        load_columns(NATIVE | {column: NATIVE[column] | {key: 1}})
