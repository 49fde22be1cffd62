"""Small files as the export of common loggers writes them, each with the map that a person would write for it."""

from __future__ import annotations

import io
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
from recording_files import refusal, save

from flexarm_env.recordings.recording import Recording

TIMES = 0.01 * np.arange(6)
VOLTS = np.array([0.0, 1.0, 1.0, -1.0, -1.0, 0.0])
ANGLES = np.array([0.0, 0.1, 0.3, 0.4, 0.4, 0.35])
ROWS = list(zip(TIMES, VOLTS, ANGLES, strict=True))


def named(key: str, time: str, voltage: str, angle: str, **settings: Any) -> dict[str, Any]:
    """A map with one place for each column."""
    places = {"time": (time, "s"), "voltage": (voltage, "V"), "arm_angle": (angle, "rad")}
    return {**settings, **{name: {key: place, "unit": unit} for name, (place, unit) in places.items()}}


def lines(delimiter: str, decimal: str = ".", times: Sequence[Any] = TIMES) -> str:
    rows = zip(times, VOLTS, ANGLES, strict=True)
    return "".join(delimiter.join(str(cell).replace(".", decimal) for cell in row) + "\n" for row in rows)


def is_right(recording: Recording) -> bool:
    found = recording.time, recording.command, recording.signals["arm_angle"]
    return all(np.allclose(a, b, rtol=0, atol=1e-6) for a, b in zip(found, (TIMES, VOLTS, ANGLES), strict=True))


CONTROL_DESK = '"Recorder_1";"12/05/2024 10:11:12"\n\nx;Platform()://arm/Model Root/u/Out1;Platform()://arm/Model Root/q/Out1\n'
CONTROL_DESK_MAP = named("column", "x", "Platform()://arm/Model Root/u/Out1", "Platform()://arm/Model Root/q/Out1", delimiter=";")


@pytest.mark.parametrize("units", ["", "[s];[V];[rad]\n", "s;V;\n", "(s);(V);(rad)\n"])
@pytest.mark.parametrize("decimal", [".", ","])
def test_control_desk_with_units_under_its_header(tmp_path: Path, units: str, decimal: str) -> None:
    path = save(tmp_path, CONTROL_DESK + units + lines(";", decimal))
    assert is_right(Recording.read(path, {**CONTROL_DESK_MAP, "skip_rows": 2, "decimal": decimal}))


def test_a_unit_that_is_not_the_map_s_is_refused(tmp_path: Path) -> None:
    path = save(tmp_path, CONTROL_DESK + "[s];[V];[deg]\n" + lines(";"))
    message = refusal(path, columns={**CONTROL_DESK_MAP, "skip_rows": 2})
    assert "row 4, column 'arm_angle': the file states 'deg', but [columns] has 'rad'" in message


@pytest.mark.parametrize("row", ["a;b;c\n", "s;V;angle\n"])
def test_a_row_of_words_that_are_no_units_is_refused(tmp_path: Path, row: str) -> None:
    message = refusal(save(tmp_path, CONTROL_DESK + row + lines(";")), columns={**CONTROL_DESK_MAP, "skip_rows": 2})
    assert "row 4, column 'time'" in message


def matlab(tmp_path: Path, content: dict[str, Any]) -> Path:
    file = io.BytesIO()
    scipy.io.savemat(file, content)
    return save(tmp_path, file.getvalue(), "run.mat")


def test_dspace_with_x_and_y(tmp_path: Path) -> None:
    y = np.zeros((1, 2), dtype=[("Name", object), ("Data", object)])
    y["Data"][0] = [VOLTS[None].astype(np.float32), ANGLES[None].astype(np.float32)]
    x = np.zeros((1, 1), dtype=[("Name", object), ("Data", object)])
    x["Data"][0, 0] = TIMES[None]
    path = matlab(tmp_path, {"arm_001": {"X": x, "Y": y, "Description": "", "RTProgram": "arm.sdf"}})
    assert is_right(Recording.read(path, named("variable", "arm_001.X.Data", "arm_001.Y(1).Data", "arm_001.Y(2).Data")))


@pytest.mark.parametrize(
    ("angle", "cut"),
    [
        (ANGLES[:, None], {}),
        (ANGLES.reshape(1, 1, -1), {}),
        (np.stack([ANGLES, 2.0 * ANGLES]).reshape(2, 1, -1), {"row": 0}),
        (np.stack([ANGLES, 2.0 * ANGLES], axis=1), {"index": 0}),
    ],
)
def test_a_simulink_structure_with_time(tmp_path: Path, angle: np.ndarray, cut: dict[str, int]) -> None:
    signals = np.zeros((1, 2), dtype=[("values", object), ("label", object)])
    signals["values"][0] = [VOLTS.reshape(1, 1, -1), angle]
    path = matlab(tmp_path, {"out": {"logsout": {"time": TIMES[:, None], "signals": signals}, "tout": TIMES[:, None]}})
    table = named("variable", "out.logsout.time", "out.logsout.signals(1).values", "out.logsout.signals(2).values")
    table["arm_angle"] |= cut
    assert is_right(Recording.read(path, table))


def test_a_quarc_host_file(tmp_path: Path) -> None:
    path = matlab(tmp_path, {"data_arm": np.stack([TIMES, VOLTS, ANGLES]).astype(np.float32)})
    assert is_right(Recording.read(path, named("variable", "data_arm(1,:)", "data_arm(2,:)", "data_arm(3,:)")))


LABVIEW = (
    "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nDecimal_Separator\t.\nMulti_Headings\tNo\nX_Columns\tMulti\n"
    "***End_of_Header***\t\n\t\nChannels\t2\t\t\t\nSamples\t6\t\t6\t\nX_Dimension\tTime\t\tTime\t\n***End_of_Header***\t\t\t\t\n"
    "X_Value\tMotor\tX_Value\tEncoder\tComment\n"
)


def multi_x(late: float) -> str:
    rows = zip(TIMES, VOLTS, ANGLES, strict=True)
    return LABVIEW + "".join(f"{time:g}\t{volt:g}\t{time + late:g}\t{angle:g}\t\n" for time, volt, angle in rows)


def test_labview_with_times_beside_each_channel(tmp_path: Path) -> None:
    table = named("column", "X_Value", "Motor", "Encoder")
    assert is_right(Recording.read(save(tmp_path, multi_x(0.0), "run.lvm"), table))
    by_index = table | {"time": {"index": 2, "unit": "s"}}
    assert is_right(Recording.read(save(tmp_path, multi_x(0.0), "run.lvm"), by_index))
    for one in (table, by_index):
        message = refusal(save(tmp_path, multi_x(0.004), "run.lvm"), columns=one)
        assert "row 14: its channels have the times '0' and '0.004'" in message


def test_a_torn_row_of_labview_is_no_row_with_two_times(tmp_path: Path) -> None:
    channels = LABVIEW.replace("X_Value\tMotor", "X_Value\tSpare\tX_Value\tMotor")
    rows = "".join(f"{t:g}\t9\t{t:g}\t{u:g}\t{t:g}\t{q:g}\t\n" for t, u, q in ROWS)
    table = named("column", "X_Value", "Motor", "Encoder")
    assert is_right(Recording.read(save(tmp_path, channels + rows, "run.lvm"), table))
    for torn in ("0.06", "0.06\t9", "0.06\t9\t0.06", "0.06\t9\t0.06\t1\t0.06"):
        message = refusal(save(tmp_path, f"{channels}{rows}{torn}\n", "run.lvm"), columns=table)
        assert f"row {len(channels.splitlines()) + 7}: has {len(torn.split())} cells where 6 are expected" in message


def test_an_arduino_with_a_boot_banner(tmp_path: Path) -> None:
    boot = "ets Jun  8 2016 00:22:57\r\nrst:0x1 (POWERON_RESET),boot:0x13\r\n"
    text = boot + "s;u;q\r\n" + lines(";").replace("\n", "\r\n")
    table = named("column", "s", "u", "q", delimiter=";")
    assert is_right(Recording.read(save(tmp_path, text), {**table, "skip_rows": 2}))
    assert "row 1, column 'time': no 's' in the header, which is one column" in refusal(save(tmp_path, text), columns=table)
    torn = refusal(save(tmp_path, f"{text}0.06;0."), columns={**table, "skip_rows": 2})
    assert "row 10: has 2 cells where 3 are expected; is the row cut off? it is '0.06;0.'" in torn


def test_plotjuggler_where_a_topic_is_slower(tmp_path: Path) -> None:
    rows = "".join(f"{1.7e9 + t:.2f},{u},{q if k % 2 == 0 else ''}\n" for k, (t, u, q) in enumerate(ROWS))
    path = save(tmp_path, "__time,/cmd/data,/joint_states/hub/position\n" + rows)
    recording = Recording.read(path, named("column", "__time", "/cmd/data", "/joint_states/hub/position"))
    assert np.allclose(recording.time, TIMES, rtol=0, atol=1e-6)
    assert np.isnan(recording.signals["arm_angle"]).tolist() == [False, True] * 3


def test_excel_with_semicolons_and_decimal_commas(tmp_path: Path) -> None:
    path = save(tmp_path, "sep=;\nZeit [s];Spannung [V];Winkel [rad]\n" + lines(";", ","))
    assert is_right(Recording.read(path, named("column", "Zeit [s]", "Spannung [V]", "Winkel [rad]", decimal=",")))


def stamps(form: str, zone: str = "") -> list[str]:
    """Times from 0.995 s on, across a full second."""
    ticks = [round(1e6 * (0.995 + time)) for time in TIMES]
    return [form.format(tick // 1_000_000, tick % 1_000_000) + zone for tick in ticks]


@pytest.mark.parametrize("form", ["2024-12-31T23:59:{:02d}.{:06d}", "2024-12-31 23:59:{:02d}.{:06d}"])
@pytest.mark.parametrize("zone", ["", "Z", "+01:00", " +0100"])
def test_dates_with_times_as_pandas_writes_its_index(tmp_path: Path, form: str, zone: str) -> None:
    text = "time,u,q\n" + lines(",", times=stamps(form, zone))
    for unit in ("s", "ms"):
        table = named("column", "time", "u", "q") | {"time": {"column": "time", "unit": unit}}
        assert is_right(Recording.read(save(tmp_path, text), table))


@pytest.mark.parametrize(
    ("old", "new"), [(":01.005000Z", ":01.005000"), ("2024-12-31T23:59:01.005000Z", "0.5"), ("-31T23:59:01.0", "-32T23:59:01.0")]
)
def test_a_date_that_is_none_is_named(tmp_path: Path, old: str, new: str) -> None:
    text = "time,u,q\n" + lines(",", times=stamps("2024-12-31T23:59:{:02d}.{:06d}", "Z"))
    assert old in text
    message = refusal(save(tmp_path, text.replace(old, new)), columns=named("column", "time", "u", "q"))
    assert "row 3, column 'time': " in message
    assert "is no date with a time as in the first row" in message


@pytest.mark.parametrize("zone", [None, "UTC"])
def test_parquet_of_pandas_with_a_datetime_index(tmp_path: Path, zone: str | None) -> None:
    arrow = pytest.importorskip("pyarrow")
    ticks = (1_700_000_000_000_000 + 1e6 * TIMES).astype(np.int64)
    table = arrow.table({"u": VOLTS, "q": ANGLES, "__index_level_0__": arrow.array(ticks, arrow.timestamp("us", tz=zone))})
    pytest.importorskip("pyarrow.parquet").write_table(table, tmp_path / "run.parquet")
    assert is_right(Recording.read(tmp_path / "run.parquet", named("column", "__index_level_0__", "u", "q")))


def test_mcap_with_json(tmp_path: Path) -> None:
    file = io.BytesIO()
    writer = pytest.importorskip("mcap.writer").Writer(file)
    writer.start()
    schema = writer.register_schema("S", "jsonschema", b"{}")
    topics = [writer.register_channel(topic, "json", schema) for topic in ("/cmd", "/encoder")]
    for time, volt, angle in zip(TIMES, VOLTS, ANGLES, strict=True):
        logged = 1_700_000_000_000_000_000 + int(1e9 * time)
        writer.add_message(topics[0], logged, json.dumps({"u": volt}).encode(), logged)
        writer.add_message(topics[1], logged + 1000, json.dumps({"position": [angle, 0.0]}).encode(), logged + 1000)
    writer.finish()
    path = save(tmp_path, file.getvalue(), "run.mcap")
    assert is_right(Recording.read(path, named("variable", "log_time", "/cmd.u", "/encoder.position[0]")))


def test_messages_of_several_topics_in_one_table(tmp_path: Path) -> None:
    """A row for each message: the cells of the other topics are empty."""
    rows = "__time,/motor/command/data,/joint_states/hub/position\n"
    stamp = 1_700_000_000.0
    for k, (time, volts, angle) in enumerate(ROWS):
        rows += f"{stamp + time:.6f},{volts},{angle if k == 0 else ''}\n"
        rows += f"{stamp + time + 0.004:.6f},,{angle}\n" if k else ""
    columns = named("column", "__time", "/motor/command/data", "/joint_states/hub/position")
    recording = Recording.read(save(tmp_path, rows), columns)
    assert np.allclose(recording.command, np.repeat(VOLTS, 2)[1:])
    measured = ~np.isnan(recording.signals["arm_angle"])
    assert np.allclose(recording.signals["arm_angle"][measured], ANGLES)
    assert "'voltage' stands in 6 of 11 rows; in the others the last command holds" in recording.notes


def test_times_of_day_go_on_past_midnight(tmp_path: Path) -> None:
    times = [f"23:59:59.{97 + k}0" if k < 3 else f"00:00:00.{k - 3:02d}" for k in range(6)]
    path = save(tmp_path, "time,u,q\n" + lines(",", times=times))
    assert is_right(Recording.read(path, named("column", "time", "u", "q")))
    for cell, words in (("12:61:00", "row 4, column 'time': '12:61:00' is no time of day"), ("0.02", "'0.02' is no time of day")):
        wrong = save(tmp_path, "time,u,q\n" + lines(",", times=[*times[:2], cell, *times[3:]]))
        assert words in refusal(wrong, columns=named("column", "time", "u", "q"))


@pytest.mark.parametrize("stamp", ["05/12/2024 23:59:{:02d}.5", "5.12.24 10:00:{:02d}", "05-12-2024 10:00:{:02d}"])
def test_dates_that_may_be_read_two_ways_are_refused(tmp_path: Path, stamp: str) -> None:
    path = save(tmp_path, "time,u,q\n" + lines(",", times=[stamp.format(k).replace(",", ".") for k in range(6)]))
    assert "is a date whose day and month may be read two ways" in refusal(path, columns=named("column", "time", "u", "q"))
