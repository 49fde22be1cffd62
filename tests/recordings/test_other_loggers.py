"""Text files of other loggers: LabVIEW, Excel, ROS's two columns of time; and maps that refine a header."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cli_stand_ins import GOOD_ARM
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from recording_files import GOOD, LOGGER, refusal, save

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.recordings.column_maps import load_columns
from flexarm_env.recordings.recording import Recording
from flexarm_env.terminal.inputs import read_recordings

FILE = """LabVIEW Measurement\t
Writer_Version\t2
Reader_Version\t2
Separator\tTab
Decimal_Separator\t.
Multi_Headings\tYes
X_Columns\tOne
Time_Pref\tAbsolute
Operator\tlab
Date\t2019/05/02
Time\t10:22:01.123456
***End_of_Header***\t
\t
"""
SEGMENT = """Channels\t2\t\t
Samples\t3\t3\t
Date\t2019/05/02\t2019/05/02\t
Time\t10:22:01.12\t10:22:01.12\t
X_Dimension\tTime\tTime\t
X0\t0.5\t0.5\t
Delta_X\t0.25\t0.25\t
***End_of_Header***\t\t\t
X_Value\tMotor\tEncoder\tComment
"""
ROWS = "0.5\t1\t2.5\tmotor on\n0.75\t2\t3\t\n1.0\t3\t4\n"
LABVIEW = {
    "time": {"column": "X_Value", "unit": "s"},
    "voltage": {"column": "Motor", "unit": "V"},
    "arm_angle": {"column": "Encoder", "unit": "rad"},
}
HIGH = FILE.count("\n") + SEGMENT.count("\n")


def lvm(folder: Path, text: str) -> Path:
    return save(folder, text, "run.lvm")


@pytest.mark.parametrize(
    "text",
    [
        FILE + SEGMENT + ROWS,
        FILE + SEGMENT + ROWS + "\t\n\n",
        (FILE + SEGMENT + ROWS).replace("\n", "\r\n"),
        (FILE + SEGMENT + ROWS).replace(".", ","),
        (FILE + SEGMENT + ROWS).replace("\tTab", "\tComma").replace("\t", ","),
        FILE.replace("One", "No") + SEGMENT + "\t1\t2.5\tmotor on\n\t2\t3\t\n\t3\t4\n",
        FILE + SEGMENT + ROWS.replace("1.0\t3\t4\n", "") + "\n" + SEGMENT + "1.0\t3\t4\t\n",
        FILE.replace("One", "No") + SEGMENT + "\t1\t2.5\t\n" + SEGMENT.replace("0.5", "0.75") + "\t2\t3\n\t3\t4\n",
        FILE.replace("One", "No") + SEGMENT + "\t1\t2.5\t\n0.75\t2\t3\t\n1.0\t3\t4\n",  # times that are there are kept
        FILE.replace("One", "No") + SEGMENT.replace("X_Value\tMotor", "Motor\tX_Value") + "1\t\t2.5\t\n2\t\t3\n3\t\t4\n",
        FILE + "X_Value\tMotor\tEncoder\tComment\n" + ROWS,
        FILE + SEGMENT.replace("\tComment", "") + ROWS.replace("\tmotor on", "").replace("3\t\n", "3\n"),
    ],
)
def test_labview_files_are_read(tmp_path: Path, text: str) -> None:
    recording = Recording.read(lvm(tmp_path, text), LABVIEW)
    assert recording.time.tolist() == [0, 0.25, 0.5]
    assert recording.command.tolist() == [1, 2, 3]
    assert recording.signals["arm_angle"].tolist() == [2.5, 3, 4]


def test_the_clock_of_a_channel_that_is_not_read_does_no_harm(tmp_path: Path) -> None:
    third = SEGMENT.replace("0.25\t0.25", "9\t0.25\t0.25").replace("0.5\t0.5", "0\t0.5\t0.5").replace("Motor", "Door\tMotor")
    path = save(tmp_path, FILE.replace("One", "No") + third + "\t7\t1\t2\n\t7\t1\t2\n", "run.lvm")
    assert Recording.read(path, LABVIEW).time.tolist() == [0.0, 0.25]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (FILE + SEGMENT + ROWS + "1.25\t3\n", [f"row {HIGH + 4}: has 2 cells where 3 are expected", "cut off", "3'"]),
        (FILE + SEGMENT + ROWS.replace("\t3\t\n", "\toops\t\n"), [f"row {HIGH + 2}, column 'arm_angle'", "'oops'"]),
        (FILE + SEGMENT, ["no samples"]),
        (FILE, ["no columns follow", "cut off"]),
        (FILE[:200], ["***End_of_Header***", "cut off"]),
        ("t,i\n0,1\n", ["row 1", "'t,i'", "LabVIEW Measurement"]),
        (FILE + SEGMENT + ROWS + SEGMENT.replace("Encoder", "Gage") + ROWS, [f"row {2 * HIGH - 10}", "other columns than"]),
        (FILE.replace("Tab", "Pipe") + SEGMENT + ROWS, ["Pipe", "Tab, Comma"]),
        (
            FILE.replace("One", "No") + SEGMENT.replace("0.25\t0.25", "0.25\t0.5") + "\t1\t2\n\t1\t2\n",
            ["its channels have the times 0.5 + k 0.25 and 0.5 + k 0.5", "a file of its own"],
        ),
        (
            FILE.replace("One", "No") + SEGMENT.replace("X0\t0.5\t0.5", "X0\t0.5\t0.75") + "\t1\t2\n\t1\t2\n",
            ["its channels have the times 0.5 + k 0.25 and 0.75 + k 0.25"],
        ),
        (FILE.replace("One", "No") + SEGMENT.replace("Delta_X", "Delta") + "\t1\t2\n", ["neither times nor", "Delta_X"]),
        (
            FILE + SEGMENT.replace("Motor", "Moto") + ROWS,
            [f"row {HIGH}, column 'voltage'", "no 'Motor' in the header; did you mean 'Moto'"],
        ),
        (FILE + SEGMENT, [f"no samples after row {HIGH}"]),
        (
            FILE.replace("One", "No") + SEGMENT.replace("X_Value\tMotor", "Motor\tX_Value") + "1\t\t2.5\n2\t\t3\n3\n",
            [f"row {HIGH + 3}: has 1 cells where 3 are expected"],
        ),
    ],
)
def test_labview_files_that_are_refused(tmp_path: Path, text: str, words: list[str]) -> None:
    message = refusal(lvm(tmp_path, text), columns=LABVIEW)
    for word in words:
        assert word in message


def test_a_labview_file_needs_a_map(tmp_path: Path) -> None:
    assert "needs a [columns] table" in refusal(lvm(tmp_path, FILE + SEGMENT + ROWS))


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data(), evenly=st.booleans())
def test_damaged_labview_files_are_read_or_refused(tmp_path: Path, data: st.DataObject, evenly: bool) -> None:
    content = bytearray((FILE.replace("One", "No") if evenly else FILE).encode() + (SEGMENT + ROWS + SEGMENT + ROWS).encode())
    for _ in range(data.draw(st.integers(1, 4))):
        place = data.draw(st.integers(0, len(content) - 1))
        content[place : place + data.draw(st.integers(0, 30))] = data.draw(
            st.binary(max_size=6) | st.sampled_from([b"\t", b"\n", b"\t\n"])
        )
    message = ""
    try:
        assert np.all(np.diff(Recording.read(save(tmp_path, bytes(content), "run.lvm"), LABVIEW).time) > 0)
    except InputError as error:
        message = str(error)
    assert len(message) < 1000
    assert not message or message.isprintable()


def test_the_first_line_of_excel(tmp_path: Path) -> None:
    text = GOOD.replace(",", ";")
    wanted = Recording.read(save(tmp_path, GOOD)).signals["arm_angle"]
    for line in ("sep=;", "sep=;;;", "sep=; "):
        assert np.array_equal(Recording.read(save(tmp_path, f"{line}\n{text}")).signals["arm_angle"], wanted)
    commas = save(tmp_path, f"sep=;\n{text.replace('.', ',')}")
    assert np.array_equal(Recording.read(commas, {"decimal": ","}).signals["arm_angle"], wanted)
    assert "row 4, column 'arm_angle': '0,6' has a decimal comma; say decimal = ','" in refusal(
        save(tmp_path, f"sep=;\n{text}".replace("0.6", "0,6"))
    )
    assert Recording.read(save(tmp_path, "sep=;\nt;i;phi\n0;1;2\n1;1;2\n"), LOGGER).command.tolist() == [0.001, 0.001]
    assert "row 1: has 'sep=,', but [columns] has delimiter = ';'" in refusal(save(tmp_path, f"sep=,\n{GOOD}"), columns=LOGGER)
    assert "decimal and delimiter are both ','" in refusal(save(tmp_path, GOOD), columns={"decimal": ","})


def test_semicolons_and_decimal_commas_under_our_own_header(tmp_path: Path) -> None:
    text = (
        GOOD.replace(",", ";")
        .replace("0.6", "0,6")
        .replace("0.1", "0,1")
        .replace("0.2", "0,2")
        .replace("0.5", "0,5")
        .replace("0.7", "0,7")
    )
    path = save(tmp_path, text)
    assert "delimiter = ';'" in refusal(path)
    assert Recording.read(path, {"delimiter": ";", "decimal": ","}).signals["arm_angle"].tolist() == [0.5, 0.6, 0.7]


def test_time_in_two_columns(tmp_path: Path) -> None:
    rows = "".join(f"{1_700_000_000 + k // 4},{250_000_000 * (k % 4) + 3},{k},{k}\n" for k in range(9))
    table: dict[str, Any] = {
        "time": {"column": ["secs", "nsecs"], "unit": ["s", "ns"]},
        "current": {"column": "i", "unit": "A"},
        "arm_angle": {"column": "phi", "unit": "deg"},
    }
    path = save(tmp_path, f"secs,nsecs,i,phi\n{rows}")
    assert np.allclose(Recording.read(path, table).time, np.arange(9) / 4, rtol=0, atol=1e-12)
    by_index = {
        **table,
        "time": {"index": [0, 1], "unit": ["s", "ns"]},
        "current": {"index": 2, "unit": "A"},
        "arm_angle": {"index": 3, "unit": "deg"},
    }
    assert np.array_equal(
        Recording.read(save(tmp_path, rows), by_index).time,
        Recording.read(save(tmp_path, f"secs,nsecs,i,phi\n{rows}"), table).time,
    )
    assert "row 3, column 'time (2)': 'x'" in refusal(
        save(tmp_path, f"secs,nsecs,i,phi\n{rows}".replace("250000003,1", "x,1", 1)), columns=table
    )
    for entry, words in (
        ({"column": ["secs", "nsecs"], "unit": ["s"]}, "2 places and 1 units"),
        ({"column": [], "unit": []}, "0 places"),
        ({"column": ["secs", 1], "unit": ["s", "ns"]}, "write a text"),
    ):
        with pytest.raises(InputError, match=words):
            load_columns({**table, "time": entry})
    with pytest.raises(InputError, match="time alone may be"):
        load_columns({**table, "current": {"column": ["i", "j"], "unit": "A"}})


def test_a_rate_in_place_of_time(tmp_path: Path) -> None:
    table = {"time": {"rate": "0.5 kHz"}, "current": {"column": "i", "unit": "A"}, "arm_angle": {"column": "phi", "unit": "rad"}}
    assert Recording.read(save(tmp_path, "i,phi\n1,2\n3,4\n5,6\n"), table).time.tolist() == [0, 0.002, 0.004]
    path = save(tmp_path, "current [A],arm_angle [rad]\n1,2\n3,4\n")
    assert Recording.read(path, {"time": {"rate": 100}}).time.tolist() == [0, 0.01]
    assert "has a column of time, but [columns] gives a rate" in refusal(save(tmp_path, GOOD), columns={"time": {"rate": 100}})
    for rate in (0, -1, "fast", "2 s", float("inf"), True):
        with pytest.raises(InputError, match="rate"):
            load_columns({**table, "time": {"rate": rate}})
    with pytest.raises(InputError, match="'rate' and 'unit'"):
        load_columns({**table, "time": {"rate": 100, "unit": "s"}})


SPEEDS = "time [s],voltage [V],arm_angle [deg],motor_speed [rad/s]\n0,1,2,3\n1,2,3,4\n2,2,3,5\n"


def test_a_map_may_refine_our_own_header(tmp_path: Path) -> None:
    path = save(tmp_path, SPEEDS)
    plain = Recording.read(path)
    for entry, factor in (
        ({"unit": "rps"}, 2 * np.pi),
        ({"unit": "rpm"}, 2 * np.pi / 60),
        ({"sign": -1}, -1),
        ({"scale": 70}, 70),
        ({"unit": "deg/s", "sign": -1, "scale": 2}, -2 * np.pi / 180),
    ):
        mended = save(
            tmp_path, "[columns]\nmotor_speed = { " + ", ".join(f"{k} = {v!r}" for k, v in entry.items()) + " }\n", "mend.toml"
        )
        recording = Recording.read(path, mended)
        assert np.allclose(recording.signals["motor_speed"], factor * plain.signals["motor_speed"], rtol=1e-14)
        assert np.array_equal(recording.signals["arm_angle"], plain.signals["arm_angle"])
        assert np.array_equal(recording.time, plain.time)


@pytest.mark.parametrize(
    ("text", "table", "words"),
    [
        (SPEEDS, {"strain_mid": {"sign": -1}}, "row 1, no column 'strain_mid', which [columns] refines"),
        (SPEEDS, {"motor_speed": {"unit": "m"}}, "column 'motor_speed': unit 'm' does not convert"),
        ("t,i\n0,1\n", {"motor_speed": {"unit": "rps"}}, "unknown column 't'"),
        ("0,1,2\n", {"motor_speed": {"unit": "rps"}}, "numbers where the header should be"),
    ],
)
def test_refinements_of_what_is_not_there(tmp_path: Path, text: str, table: dict[str, Any], words: str) -> None:
    assert words in refusal(save(tmp_path, text), columns=table)


def test_a_matlab_file_has_no_header_to_refine(tmp_path: Path) -> None:
    assert "has no place for 'motor_speed'; add 'variable'" in refusal(
        save(tmp_path, b"x", "run.mat"), columns={"motor_speed": {"sign": -1}}
    )


def test_the_map_of_an_arm_may_refine_the_header_of_its_files(tmp_path: Path) -> None:
    arm_file = save(tmp_path, GOOD_ARM + "\n[columns]\narm_angle = { sign = -1 }\n", "A.toml")
    arm = Arm.load(arm_file)
    (recording,) = read_recordings(arm, [save(tmp_path, GOOD)], None)
    assert recording.signals["arm_angle"].tolist() == [-0.5, -0.6, -0.7]
    assert recording.notes == ("read by its own header; the arm's [columns] refine it in arm_angle",)
    (commands,) = read_recordings(arm, [save(tmp_path, "time [s],current [A]\n0,1\n1,2\n")], None, require_signal=False)
    assert commands.command.tolist() == [1, 2]


def test_a_header_that_a_map_does_not_fit_is_shown(tmp_path: Path) -> None:
    table = {
        "time": {"column": "t", "unit": "s"},
        "current": {"column": "current [A]", "unit": "A"},
        "arm_angle": {"column": "enc", "unit": "deg"},
    }
    message = refusal(save(tmp_path, "# rig 7\n" + GOOD), columns=table)
    assert message == "row 2, column 'time': no 't' in the header, which has 'time [s]', 'current [A]', 'arm_angle [rad]'"


def test_a_column_beyond_the_rows_names_the_first(tmp_path: Path) -> None:
    table = {"time": {"index": 0, "unit": "s"}, "current": {"index": 1, "unit": "A"}, "arm_angle": {"index": 2, "unit": "rad"}}
    assert "row 3, column 'arm_angle': index 2, but the rows have 2 cells, as '1,1'; count from 0" in refusal(
        save(tmp_path, "\n7\n1,1\n2,2\n"), columns=table
    )


def test_conditions_and_a_controller_beside_maps_that_refine(tmp_path: Path) -> None:
    law = "[controller]\nkind = 'PD'\n"
    assert load_columns({"current": {}, "arm_angle": {"sign": -1}}).refines
    with pytest.raises(InputError, match="has conditions in columns"):
        load_columns({"arm_angle": {"sign": -1}, "conditions": {"gain": {"column": "K", "unit": "V"}}})
    with pytest.raises(InputError, match=r"add current = .* there"):
        load_columns(save(tmp_path, f"[columns]\narm_angle = {{ sign = -1 }}\n{law}", "map.toml"))
    table = {"time": {"rate": 10}, "current": {"column": "i", "unit": "A"}, "arm_angle": {"column": "q", "unit": "rad"}}
    conditions = {"gain": {"column": "K", "unit": "1"}}
    recording = Recording.read(save(tmp_path, "i,q,K\n1,2,7\n1,3,7\n"), {**table, "conditions": conditions})
    assert recording.conditions == {"gain": 7.0}
    assert recording.time.tolist() == [0, 0.1]


@pytest.mark.parametrize(
    "line",
    [
        'motor_speed = { unit = "rps" }',
        "motor_speed = { scale = 0.2 }",
        "arm_angle = { sign = -1 }",
        "motor_speed = { repeats = 2 }",
        'arm_angle = { wrap = "6.2831853 rad" }',
        'arm_angle = { range = ["-100 rad", "100 rad"] }',
        "arm_angle = { ignore = [[0, 0.5]] }",
        'time = { shift = "1 s" }',
        'arm_angle = { shift = "1 s" }\nmotor_speed = { sign = -1, ignore = [[0, 1]] }',
    ],
)
def test_each_correction_alone_mends_a_header(tmp_path: Path, line: str) -> None:
    path = save(tmp_path, SPEEDS)
    plain, mended = Recording.read(path), Recording.read(path, save(tmp_path, f"[columns]\n{line}\n", "mend.toml"))
    assert list(mended.signals) == list(plain.signals)
    assert np.array_equal(mended.command, plain.command)
    changed = {name for name in plain.signals if not np.array_equal(mended.signals[name], plain.signals[name])}
    assert changed <= (
        {"arm_angle", "motor_speed"} if line.startswith("time") else {entry.split()[0] for entry in line.splitlines()}
    )
    assert changed or "wrap" in line or "range" in line
