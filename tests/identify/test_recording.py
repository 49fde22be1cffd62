"""Recordings: units, foreign files, bad input in one line, and files that come back bit for bit."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from flexarm_env import units
from flexarm_env.errors import InputError
from flexarm_env.identify import readers
from flexarm_env.identify.columns import SIGNALS, UNITS, load_columns
from flexarm_env.identify.recording import Recording

HEADER = "time [s],current [A],arm_angle [rad]"
GOOD = f"{HEADER}\n0,1,0.5\n0.1,2,0.6\n0.2,3,0.7\n"
CU_BOULDER = {
    "delimiter": "\t",
    "header_prefix": "%",
    "time": {"column": "Time (ms)", "unit": "ms"},
    "voltage": {"column": "Output Voltage (V)", "unit": "V"},
    "arm_angle": {"column": "Hubangle(Theta in rad)", "unit": "rad"},
    "tip_deflection": {"index": 2, "unit": "m", "sign": -1},
    "reference": {"column": "Position Reference (rad)", "unit": "rad"},
}
EMPS = {
    "time": {"variable": "t", "unit": "s"},
    "voltage": {"variable": "vir", "unit": "V"},
    "arm_angle": {"variable": "qm", "unit": "m", "scale": "1 rad/m"},
    "reference": {"variable": "qg", "unit": "m", "scale": "1 rad/m"},
}
LOGGER = {
    "delimiter": ";",
    "decimal": ",",
    "time": {"column": "t", "unit": "ms"},
    "current": {"column": "i", "unit": "mA"},
    "arm_angle": {"column": "phi", "unit": "deg", "sign": -1},
}


def save(folder: Path, content: str | bytes, name: str = "run.csv") -> Path:
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def refusal(path: Path, **options: Any) -> str:
    """Return the one line that reading a bad file gives, without the path that it must begin with."""
    with pytest.raises(InputError) as caught:
        Recording.read(path, **options)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert len(message.splitlines()) == 1
    return message.removeprefix(f"{path}: ")


def same(a: Recording, b: Recording) -> bool:
    names = ["time", "command", *a.signals, *(["reference"] if a.reference is not None else [])]

    def bits(recording: Recording, name: str) -> bytes:
        values = getattr(recording, name, None)
        return (recording.signals[name] if values is None else values).tobytes()

    return (
        a.input_kind == b.input_kind
        and list(a.signals) == list(b.signals)
        and (a.reference is None) == (b.reference is None)
        and a.conditions == b.conditions
        and all(bits(a, name) == bits(b, name) for name in names)
    )


def example(n: int = 5, **changes: Any) -> Recording:
    fields: dict[str, Any] = {
        "name": "example",
        "time": 0.1 * np.arange(n),
        "input_kind": "current",
        "command": np.arange(n),
        "signals": {"arm_angle": np.linspace(0, 1, n)},
    }
    return Recording.from_arrays(**(fields | changes))


# Native files


def test_reads_a_native_file(tmp_path: Path) -> None:
    recording = Recording.read(save(tmp_path, "# payload = 300 g\n# made on a Tuesday\n" + GOOD))
    assert recording.name == "run"
    assert recording.time.tolist() == [0, 0.1, 0.2]
    assert recording.command.tolist() == [1, 2, 3]
    assert recording.signals["arm_angle"].tolist() == [0.5, 0.6, 0.7]
    assert recording.reference is None
    assert recording.conditions == {"payload": 0.3}
    assert recording.source == str(tmp_path / "run.csv")
    assert len(recording.sha256) == 64
    assert (len(recording), recording.sample_time, recording.duration) == (3, pytest.approx(0.1), 0.2)
    assert len(repr(recording).splitlines()) == 1
    assert all(values.flags.c_contiguous for values in recording.signals.values())


@pytest.mark.parametrize(
    ("column", "unit", "value", "expected"),
    [
        ("arm_angle", "deg", 180, np.pi),
        ("arm_angle", "mrad", 5, 0.005),
        ("motor_speed", "rpm", 60, 2 * np.pi),
        ("motor_speed", "deg/s", 180, np.pi),
        ("strain_mid", "mV", 250, 0.25),
        ("tip_deflection", "mm", -3, -0.003),
    ],
)
def test_any_compatible_unit_converts(tmp_path: Path, column: str, unit: str, value: float, expected: float) -> None:
    text = f"time [ms],current [mA],{column}[{unit}]\n0,500,{value}\n10,0,0\n"
    recording = Recording.read(save(tmp_path, text))
    assert recording.signals[column][0] == pytest.approx(expected, rel=1e-15)
    assert recording.command[0] == pytest.approx(0.5)
    assert recording.time[1] == pytest.approx(0.01)


@pytest.mark.parametrize(
    "text",
    [
        "\ufeff" + GOOD,
        GOOD.replace("\n", "\r\n"),
        GOOD.replace("\n", "\r"),
        GOOD.rstrip("\n"),
        GOOD + "\n\n",
        "\n \n" + GOOD,
        GOOD.replace("time [s]", '"time [s]"').replace("0.6", '"0.6"'),
        GOOD.replace(",", " , "),
    ],
)
def test_what_editors_do_to_a_file_does_no_harm(tmp_path: Path, text: str) -> None:
    plain = Recording.read(save(tmp_path, GOOD, "plain.csv"))
    assert same(Recording.read(save(tmp_path, text)), plain)


def test_time_starts_at_zero(tmp_path: Path) -> None:
    recording = Recording.read(save(tmp_path, f"{HEADER}\n1000,1,0.5\n1000.5,2,0.6\n"))
    assert recording.time.tolist() == [0, 0.5]


def test_volts_need_a_calibration(tmp_path: Path) -> None:
    path = save(tmp_path, "time [s],current [A],arm_angle [mV]\n0,0,500\n1,0,0\n")
    assert Recording.read(path, calibration={"arm_angle": -2.0}).signals["arm_angle"][0] == -1.0
    message = refusal(path)
    assert "'arm_angle' is in mV" in message
    assert "rad/V" in message


def test_a_calibration_leaves_other_units_alone(tmp_path: Path) -> None:
    recording = Recording.read(save(tmp_path, GOOD), calibration={"arm_angle": 2.0})
    assert recording.signals["arm_angle"][0] == 0.5


@pytest.mark.parametrize("gains", [{"arm_angel": 1.0}, {"arm_angle": 0.0}, {"arm_angle": np.nan}])
def test_calibration_is_checked(tmp_path: Path, gains: dict[str, float]) -> None:
    with pytest.raises(InputError, match=r"calibration: .*arm_ang"):
        Recording.read(save(tmp_path, GOOD), calibration=gains)


def test_gaps_are_reported_and_accepted(tmp_path: Path) -> None:
    rows = "".join(f"{t},0,0\n" for t in (0, 1, 2, 3, 7, 8, 10, 20))
    recording = Recording.read(save(tmp_path, f"{HEADER}\n{rows}"))
    assert recording.gaps == [(3, 4.0), (6, 10.0)]
    assert "2 gaps" in repr(recording)


# Bad input: the text, and what the message must hold

BAD = {
    "empty": ("", ["empty"]),
    "blank": ("\n\n", ["no header"]),
    "no header": ("0,1,2\n1,2,3\n", ["row 1", "header", "time [s]"]),
    "header only": (HEADER + "\n", ["no samples"]),
    "header only, no newline": (HEADER, ["no samples"]),
    "remarks only": ("# payload = 1 kg\n", ["no header"]),
    "one row": (HEADER + "\n0,1,2\n", ["1 sample", "two"]),
    "unknown unit": (GOOD.replace("[rad]", "[radd]"), ["arm_angle", "'radd'", "rad"]),
    "empty unit": (GOOD.replace("[rad]", "[]"), ["arm_angle", "no unit", "arm_angle [rad]"]),
    "wrong dimension": (GOOD.replace("[rad]", "[m]"), ["arm_angle", "'m'", "deg"]),
    "hertz is no rad/s": ("time [s],current [A],motor_speed [Hz]\n0,0,0\n1,0,0\n", ["'Hz'", "rpm"]),
    "percent is no angle": (GOOD.replace("[rad]", "[%]"), ["arm_angle", "'%'"]),
    "a unit that is a bomb": (GOOD.replace("[A]", "[A**9**9**9**9]"), ["current", "unknown unit"]),
    "no bracket": (GOOD.replace(" [rad]", ""), ["column 3", "arm_angle [rad]"]),
    "parentheses": (GOOD.replace("[rad]", "(rad)"), ["column 3", "arm_angle [rad]"]),
    "unknown column": (GOOD.replace("arm_angle", "arm_angel"), ["column 3", "did you mean 'arm_angle'"]),
    "extra column": (GOOD.replace("[rad]", "[rad],torque [N]", 1), ["column 4", "'torque'", "time"]),
    "nameless column": (GOOD.replace("[rad]", "[rad],", 1), ["column 4", "''"]),
    "no time": ("current [A],arm_angle [rad]\n0,1\n1,2\n", ["no time", "time [s]"]),
    "no input": ("time [s],arm_angle [rad]\n0,1\n1,2\n", ["neither", "current", "voltage"]),
    "both inputs": ("time [s],current [A],voltage [V],arm_angle [rad]\n0,1,1,1\n", ["both", "keep"]),
    "no signal": (
        "time [s],current [A],reference [rad]\n0,1,1\n1,2,2\n",
        ["no measured signal", "strain_mid"],
    ),
    "twice": (GOOD.replace("current [A]", "time [ms]"), ["column 2", "'time' comes twice"]),
    "text": (GOOD.replace("0.6", "oops"), ["row 3", "'arm_angle'", "'oops'"]),
    "text after blank lines": (GOOD.replace("0.1,2,0.6", "\n\n0.1,2,oops"), ["row 5", "'arm_angle'"]),
    "python number": (GOOD.replace("0.6", "1_0"), ["row 3", "'1_0'"]),
    "digits of elsewhere": (GOOD.replace("0.6", "٣"), ["row 3", "'arm_angle'"]),
    "decimal comma, quoted": (GOOD.replace("0.6", '"0,6"'), ["row 3", "decimal comma", "0.6"]),
    "decimal commas": (f"{HEADER}\n0,0,1,0,0,5\n", ["row 2", "6 cells", "0.5, not 0,5"]),
    "semicolons": (GOOD.replace(",", ";"), ["semicolons", "delimiter = ';'"]),
    "tabs": (GOOD.replace(",", "\t"), ["tabs", "delimiter"]),
    "empty cell": (GOOD.replace("2,0.6", ",0.6"), ["row 3", "'current'", "empty"]),
    "nan": (GOOD.replace("0.6", "nan"), ["row 3", "'arm_angle'", "nan"]),
    "infinite": (GOOD.replace("0.6", "-inf"), ["row 3", "'arm_angle'", "inf"]),
    "too large": (GOOD.replace("0.6", "1e999"), ["row 3", "'arm_angle'", "inf"]),
    "too large once converted": (
        GOOD.replace("0.6", "1e308").replace("[rad]", "[turn]"),
        ["row 3", "'arm_angle'"],
    ),
    "nan time first": (GOOD.replace("\n0,", "\nnan,"), ["row 2", "'time'"]),
    "time goes back": (GOOD.replace("0.2,3", "0.05,3"), ["row 4", "'time'", "goes back"]),
    "time repeats": (GOOD.replace("0.2,3", "0.1,3"), ["row 4", "'time'", "repeats"]),
    "short row": (GOOD.replace("0.1,2,0.6", "0.1,2"), ["row 3", "2 cells"]),
    "long row": (GOOD.replace("0.1,2,0.6", "0.1,2,0.6,9"), ["row 3", "4 cells"]),
    "cut off": (GOOD[:-5], ["row 4"]),
    "remark among the numbers": (GOOD + "# the end\n", ["row 5"]),
    "binary": (b"\x00\x01\x02" + GOOD.encode(), ["binary", "CSV"]),
    "latin-1": ((GOOD.replace("0.6", "0.6°")).encode("latin-1"), ["row 3", "UTF-8"]),
    "utf-16": (GOOD.encode("utf-16"), ["UTF-8"]),
    "zip": (b"PK\x03\x04\xff\xfe\xfd", ["UTF-8"]),
    "condition, bad unit": ("# payload = 0.3 kgg\n" + GOOD, ["row 1", "'kgg'"]),
    "condition, wrong unit": ("# payload = 0.3 m\n" + GOOD, ["row 1", "kg"]),
    "condition, comma": ("# payload = 0,3 kg\n" + GOOD, ["row 1", "0.3 kg"]),
    "condition, twice": ("# payload = 1 kg\n# payload = 2 kg\n" + GOOD, ["row 2", "twice"]),
    "condition, misspelt": ("# paylod = 1 kg\n" + GOOD, ["row 1", "did you mean 'payload'"]),
    "condition, negative": ("# payload = -1 kg\n" + GOOD, ["payload", "-1"]),
    "one endless field": ('"' + "x" * 200_000, ["CSV"]),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_one_clear_line(tmp_path: Path, case: str) -> None:
    text, wanted = BAD[case]
    message = refusal(save(tmp_path, text))
    for word in wanted:
        assert word in message


def test_absent_file(tmp_path: Path) -> None:
    assert "No such file" in refusal(tmp_path / "none.csv")


def test_folder_instead_of_file(tmp_path: Path) -> None:
    assert "is a folder" in refusal(tmp_path)


def test_symlink_loop(tmp_path: Path) -> None:
    (tmp_path / "a.csv").symlink_to(tmp_path / "b.csv")
    (tmp_path / "b.csv").symlink_to(tmp_path / "a.csv")
    assert "cannot be read" in refusal(tmp_path / "a.csv")
    with pytest.raises(InputError, match="cannot be read"):
        Recording.read_all(tmp_path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_a_pipe_is_refused_and_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.csv")
    assert "not a regular file" in refusal(tmp_path / "pipe.csv")


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="permissions do not bind this user")
def test_permission_error(tmp_path: Path) -> None:
    path = save(tmp_path, GOOD)
    path.chmod(0)
    assert "Permission denied" in refusal(path)


def test_impossible_path() -> None:
    with pytest.raises(InputError, match="cannot be read"):
        Recording.read("a\0b.csv")


def test_too_large_a_file_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "big.csv"
    with path.open("wb") as file:
        file.truncate(2 * 2**30)
    start = time.perf_counter()
    message = refusal(path)
    assert time.perf_counter() - start < 0.5
    assert "2048 MB" in message
    assert "256 MB" in message


def test_control_characters_do_not_break_the_line(tmp_path: Path) -> None:
    path = save(tmp_path, GOOD.replace("0.6", '"a\x1bb\u2028c"'), "a\nb.csv")
    with pytest.raises(InputError) as caught:
        Recording.read(path)
    assert str(caught.value).isprintable()


@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(where=st.integers(0, len(GOOD)), cut=st.integers(0, 20), junk=st.text(max_size=8) | st.binary(max_size=8))
def test_damaged_files_are_read_or_refused(tmp_path: Path, where: int, cut: int, junk: str | bytes) -> None:
    extra = junk if isinstance(junk, bytes) else junk.encode("utf-8", "surrogatepass")
    content = GOOD.encode()
    path = save(tmp_path, content[:where] + extra + content[where + cut :])
    message = ""
    try:
        assert np.all(np.diff(Recording.read(path).time) > 0)
    except InputError as error:
        message = str(error)
    assert not message or (message.startswith(str(path)) and message.isprintable())


@given(st.text(max_size=20))
def test_any_text_is_a_unit_or_refused(text: str) -> None:
    message = ""
    try:
        assert np.isfinite(units.factor(text, "rad"))
    except InputError as error:
        message = str(error)
    assert message.isprintable()


# Folders and lists


def test_a_folder_stands_for_its_csv_files(tmp_path: Path) -> None:
    for name in ("b.csv", "a.CSV", "notes.txt", ".hidden.csv"):
        save(tmp_path, GOOD, name)
    (tmp_path / "c.csv").mkdir()
    assert [r.name for r in Recording.read_all(tmp_path)] == ["a", "b"]
    assert [r.name for r in Recording.read_all([tmp_path / "b.csv", tmp_path / "a.CSV"])] == ["b", "a"]


def test_names_are_told_apart(tmp_path: Path) -> None:
    for folder in ("one", "two"):
        (tmp_path / folder).mkdir()
        save(tmp_path / folder, GOOD)
    assert [r.name for r in Recording.read_all([tmp_path / "one", tmp_path / "two"])] == [
        "one/run",
        "two/run",
    ]


def test_folders_that_hold_nothing(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="without CSV files"):
        Recording.read_all(tmp_path)
    with pytest.raises(InputError, match="no recordings"):
        Recording.read_all([])


def test_a_file_counts_once(tmp_path: Path) -> None:
    path = save(tmp_path, GOOD)
    with pytest.raises(InputError, match="named twice"):
        Recording.read_all([path, tmp_path])


# Foreign files


def test_columns_from_toml(tmp_path: Path) -> None:
    table = save(
        tmp_path,
        '[columns]\ndelimiter = ";"\ndecimal = ","\ntime = {column = "t", unit = "ms"}\n'
        'current = {column = "i", unit = "mA"}\narm_angle = {column = "phi", unit = "deg", sign = -1}\n'
        "[drive]\nanything = 1\n",
        "map.toml",
    )
    assert load_columns(table) == load_columns(LOGGER)


def test_semicolons_decimal_commas_and_signs(tmp_path: Path) -> None:
    path = save(tmp_path, "note;t;i;phi\nx;100,5;1500,0;90\ny;101,5;-2,5E1;0\n")
    recording = Recording.read(path, LOGGER)
    assert recording.time.tolist() == [0, 0.001]
    assert recording.command.tolist() == pytest.approx([1.5, -0.025])
    assert recording.signals["arm_angle"][0] == pytest.approx(-np.pi / 2)


def test_a_thousands_mark_is_not_taken_for_a_point(tmp_path: Path) -> None:
    message = refusal(save(tmp_path, "t;i;phi\n0;1.500;1\n1;0;0\n"), columns=LOGGER)
    assert "row 2, column 'current': '1.500'" in message


def test_rows_to_skip_blanks_and_no_header(tmp_path: Path) -> None:
    table = {
        "delimiter": " ",
        "skip_rows": 2,
        "time": {"index": 0, "unit": "s"},
        "voltage": {"index": 2, "unit": "V"},
        "motor_speed": {"index": 1, "unit": "V", "scale": "100 rad/s/V"},
    }
    path = save(tmp_path, "rig 7\nTuesday\n  0.0   1.0  -5\n  0.5   2.0   5\n")
    recording = Recording.read(path, table)
    assert recording.command.tolist() == [-5, 5]
    assert recording.signals["motor_speed"].tolist() == [100, 200]


def test_text_in_columns_not_asked_for_does_no_harm(tmp_path: Path) -> None:
    path = save(tmp_path, 't,i,phi,note\n0,1,2,"a, b"\n1,1,2,c\n')
    table = {**LOGGER, "delimiter": ",", "decimal": "."}
    assert len(Recording.read(path, table)) == 2


def test_a_plain_scale_and_a_calibration_multiply(tmp_path: Path) -> None:
    table = {**LOGGER, "arm_angle": {"column": "phi", "unit": "V", "scale": 0.5}}
    recording = Recording.read(save(tmp_path, "t;i;phi\n0;1;3\n1;1;3\n"), table, calibration={"arm_angle": 2.0})
    assert recording.signals["arm_angle"][0] == 3.0


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("t;i;psi\n0;1;2\n", ["'arm_angle'", "did you mean 'psi'"]),
        ("t;i;phi;phi\n0;1;2;3\n", ["'phi' twice", "index"]),
        ("t;i;phi\n0;1;2\n1;1\n", ["row 3", "2 cells"]),
        ("t;i;phi\n0;1\n1;1\n", ["'arm_angle'", "2 cells"]),
        ("t,i,phi\n0,1,2\n", ["'time'", "'t'", "'t,i,phi'", "delimiter"]),
        ("0;1;2\n1;1;2\n", ["row 1", "header"]),
    ],
)
def test_foreign_files_that_do_not_fit_their_map(tmp_path: Path, text: str, wanted: list[str]) -> None:
    message = refusal(save(tmp_path, text), columns=LOGGER)
    for word in wanted:
        assert word in message


def changed(**entries: Any) -> dict[str, Any]:
    return {key: value for key, value in {**LOGGER, **entries}.items() if value is not None}


@pytest.mark.parametrize(
    ("table", "wanted"),
    [
        (changed(delimeter=";"), "did you mean 'delimiter'"),
        (changed(arm_angel={"index": 1, "unit": "rad"}), "did you mean 'arm_angle'"),
        (changed(time={"colunm": "t", "unit": "s"}), "did you mean 'column'"),
        (changed(time={"column": "t"}), "no unit"),
        (changed(time={"unit": "s"}), "exactly one of"),
        (changed(time={"column": "t", "index": 0, "unit": "s"}), "exactly one of"),
        (changed(time={"index": -1, "unit": "s"}), "count from 0"),
        (changed(time={"index": True, "unit": "s"}), "a whole number"),
        (changed(time={"variable": "t", "unit": "s"}), "'variable'"),
        (changed(time="t"), "unit = 's'"),
        (changed(time={"column": "t", "unit": "s", "sign": 2}), "write 1 or -1"),
        (changed(time={"column": "t", "unit": "s", "scale": 0}), "not zero"),
        (changed(time={"column": "t", "unit": "s", "scale": "fast"}), "'fast'"),
        (changed(time=None), "no time"),
        (changed(arm_angle=None), "no measured signal"),
        (changed(voltage={"column": "v", "unit": "V"}), "both current and voltage"),
        (changed(delimiter=";;"), "one character"),
        (changed(delimiter=1), "a text"),
        (changed(delimiter=","), "decimal and delimiter"),
        (changed(decimal="'"), "decimal is"),
        (changed(skip_rows=-1), "negative"),
    ],
)
def test_column_maps_are_checked(table: dict[str, Any], wanted: str) -> None:
    with pytest.raises(InputError) as caught:
        load_columns(table)
    assert wanted in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


@pytest.mark.parametrize("content", ["", "columns = 3", "[columns", b"\xff\xfe"])
def test_column_files_that_are_none(tmp_path: Path, content: str | bytes) -> None:
    path = save(tmp_path, content, "map.toml")
    with pytest.raises(InputError) as caught:
        load_columns(path)
    assert str(caught.value).startswith(f"{path}: ")
    with pytest.raises(InputError, match="No such file"):
        load_columns(tmp_path / "none.toml")


# MATLAB files


def matlab(folder: Path, **variables: Any) -> Path:
    path = folder / "run.mat"
    good: dict[str, Any] = {
        "t": np.arange(4.0),
        "vir": np.ones((4, 1)),
        "qm": np.arange(4),
        "qg": np.zeros(4),
    }
    scipy.io.savemat(path, good | variables)
    return path


def test_reads_matlab_vectors(tmp_path: Path) -> None:
    recording = Recording.read(matlab(tmp_path), EMPS)
    assert recording.input_kind == "voltage"
    assert recording.signals["arm_angle"].tolist() == [0, 1, 2, 3]


@pytest.mark.parametrize(
    ("variable", "value", "wanted"),
    [
        ("qm", np.ones((4, 2)), "not a vector"),
        ("qm", np.ones(4) * 1j, "not a vector"),
        ("qm", "text", "not a vector"),
        ("qm", {"a": 1}, "not a vector"),
        ("qm", np.ones((0, 0)), "not a vector"),
        ("qm", np.ones(3), "differ in length"),
        ("qm", np.array([0, 1, np.nan, 3]), "sample 3, column 'arm_angle': is nan"),
        ("t", np.array([0, 1, 1, 3]), "sample 3, column 'time': repeats"),
    ],
)
def test_matlab_variables_are_checked(tmp_path: Path, variable: str, value: Any, wanted: str) -> None:
    assert wanted in refusal(matlab(tmp_path, **{variable: value}), columns=EMPS)


def test_matlab_files_that_do_not_fit(tmp_path: Path) -> None:
    path = matlab(tmp_path)
    table = {**EMPS, "arm_angle": {"variable": "vri", "unit": "rad"}}
    assert "did you mean 'vir'" in refusal(path, columns=table)
    assert "[columns]" in refusal(path)
    assert "use 'variable'" in refusal(path, columns=LOGGER)
    assert "use 'column'" in refusal(save(tmp_path, GOOD), columns=EMPS)


def test_matlab_7_3_and_damage(tmp_path: Path) -> None:
    head = b"MATLAB 7.3 MAT-file".ljust(124, b" ") + b"\x00\x02IM"
    assert "-v7" in refusal(save(tmp_path, head + bytes(512), "run.mat"), columns=EMPS)
    assert "-v7" in refusal(save(tmp_path, b"nothing of the kind", "run.mat"), columns=EMPS)


@pytest.mark.parametrize("compressed", [False, True])
def test_cut_off_matlab_files(tmp_path: Path, compressed: bool) -> None:
    path = matlab(tmp_path)
    variables = {name: value for name, value in scipy.io.loadmat(path).items() if name[0] != "_"}
    scipy.io.savemat(path, variables, do_compression=compressed)
    whole = path.read_bytes()
    assert len(Recording.read(path, EMPS)) == 4
    for size in range(0, len(whole), 7):
        refusal(save(tmp_path, whole[:size], "run.mat"), columns=EMPS)
        zeros = save(tmp_path, whole[:size] + bytes(len(whole) - size), "run.mat")
        if size < len(whole) - 60:  # the last vector is zeros anyway
            refusal(zeros, columns=EMPS)


# Files of others


def test_practice_recordings(measurements: Path) -> None:
    recordings = Recording.read_all(measurements / "practice" / "p01")
    assert [r.name for r in recordings] == ["pulse", "square", "sweep"]
    for recording in recordings:
        raw = np.loadtxt(recording.source, delimiter=",", skiprows=1)
        assert recording.input_kind == "current"
        assert not recording.gaps
        columns = [recording.time, recording.command, *recording.signals.values()]
        assert np.array_equal(np.column_stack(columns), raw)


def test_cu_boulder_recordings(measurements: Path) -> None:
    files = sorted((measurements / "cu_boulder").glob("*.txt"))
    assert len(files) == 6
    for recording in Recording.read_all(files, CU_BOULDER):
        raw = np.loadtxt(recording.source, delimiter="\t", skiprows=1)
        assert np.allclose(recording.time, (raw[:, 0] - raw[0, 0]) / 1000, rtol=0, atol=1e-12)
        assert np.array_equal(recording.signals["arm_angle"], raw[:, 1])
        assert np.array_equal(recording.signals["tip_deflection"], -raw[:, 2])
        assert recording.reference is not None
        assert np.array_equal(recording.reference, raw[:, 5])
        assert np.array_equal(recording.command, raw[:, 6])


@pytest.mark.parametrize("name", ["DATA_EMPS", "DATA_EMPS_PULSES"])
def test_emps_recordings(measurements: Path, name: str) -> None:
    recording = Recording.read(measurements / "emps" / f"{name}.mat", EMPS)
    raw = scipy.io.loadmat(recording.source)
    assert recording.duration == pytest.approx(24.84)
    assert np.array_equal(recording.command, raw["vir"].ravel())
    assert np.array_equal(recording.signals["arm_angle"], raw["qm"].ravel())


# Arrays, parts, writing


@pytest.mark.parametrize(
    ("changes", "wanted"),
    [
        ({"input_kind": "torque"}, "unknown input 'torque'"),
        ({"signals": {"arm_angel": np.zeros(5)}}, "did you mean 'arm_angle'"),
        ({"signals": {}}, "no measured signal"),
        ({"command": np.zeros(4)}, "lengths differ"),
        ({"command": np.zeros((5, 1))}, "vector"),
        ({"command": [1, [2], 3, 4, 5]}, "vector"),
        ({"command": list("abcde")}, "vector"),
        ({"command": [1, 2, 3, 4, np.inf]}, "sample 5, column 'current'"),
        ({"time": [0, 1, 2, 2, 3]}, "sample 4, column 'time': repeats"),
        ({"time": [-1e308, 0, 1e308, 1.1e308, 1.2e308]}, "column 'time'"),
        ({"conditions": {"payload": -1.0}}, "payload"),
        ({"conditions": {"a b": 1.0}}, "'a b'"),
    ],
)
def test_arrays_are_checked_as_files_are(changes: dict[str, Any], wanted: str) -> None:
    with pytest.raises(InputError) as caught:
        example(**changes)
    assert wanted in str(caught.value)


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


finite = st.floats(allow_nan=False, allow_infinity=False)


@st.composite
def recordings(draw: st.DrawFn) -> Recording:
    n = draw(st.integers(2, 12))
    column = arrays(np.float64, n, elements=finite)
    steps = draw(arrays(np.float64, n - 1, elements=st.floats(1e-6, 1e3)))
    names = draw(st.lists(st.sampled_from(list(SIGNALS)), min_size=1, unique=True))
    return Recording.from_arrays(
        "drawn",
        np.concatenate([[0.0], np.cumsum(steps)]),
        draw(st.sampled_from(["current", "voltage"])),
        draw(column),
        {name: draw(column) for name in names},
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
    signals = {name: np.zeros(2) for name in reversed(SIGNALS)}
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
        with pytest.raises(InputError, match="cannot be written"):
            example().write(path)
    assert os.listdir(tmp_path) == []


def test_reading_is_fast(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    n = 5000
    signals = {name: rng.normal(size=n) for name in ("arm_angle", "motor_speed", "strain_mid", "strain_base")}
    example(n, signals=signals).write(tmp_path / "run.csv")

    def seconds() -> float:
        start = time.perf_counter()
        Recording.read(tmp_path / "run.csv")
        return time.perf_counter() - start

    assert min(seconds() for _ in range(5)) < 0.05


def test_the_largest_file_is_stated_in_bytes() -> None:
    assert readers.LARGEST_FILE == 256 * 1024**2


# Units


@pytest.mark.parametrize(
    ("value", "target", "expected"),
    [
        ("0.0116 rad", "rad", 0.0116),
        ("300g", "kg", 0.3),
        (".5", "kg", 0.5),
        (2, "kg", 2.0),
        ("3 mNm", "N*m", 0.003),
        ("3 Nm", "N*m/rad", 3.0),
        ("0.02 Nms/rad", "N*m*s/rad", 0.02),
        ("12 m/s²", "m/s**2", 12.0),
    ],
)
def test_quantities(value: str | float, target: str, expected: float) -> None:
    assert units.quantity(value, target) == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize(
    ("value", "target"),
    [
        ("", "kg"),
        ("kg", "kg"),
        ("1e999 kg", "kg"),
        ("1 V", ""),
        ("5 V/Hz", "V*s/rad"),
        ("20 degC", "K"),
        ("3 kg kg", "kg"),
    ],
)
def test_quantities_that_are_refused(value: str, target: str) -> None:
    with pytest.raises(InputError):
        units.quantity(value, target)


def test_other_conditions_become_si(tmp_path: Path) -> None:
    text = "# temperature = 20 degC\n# speed = 60 rpm\n# trial = 3 of 5\n# date = 2017-04-27\n" + GOOD
    conditions = Recording.read(save(tmp_path, text)).conditions
    assert conditions == {"temperature": pytest.approx(293.15), "speed": pytest.approx(2 * np.pi)}
