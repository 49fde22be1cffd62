"""Foreign text files, read where they lie by a map of their columns."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recording_files import LOGGER, refusal, save

from flexarm_env.errors import InputError
from flexarm_env.recordings.column_maps import load_columns
from flexarm_env.recordings.recording import Recording

NAMES = ("time", "voltage", "arm_angle")


def test_columns_from_toml(tmp_path: Path) -> None:
    table = save(
        tmp_path,
        '[columns]\ndelimiter = ";"\ndecimal = ","\ntime = {column = "t", unit = "ms"}\n'
        'current = {column = "i", unit = "mA"}\narm_angle = {column = "phi", unit = "deg", sign = -1}\n'
        "[drive]\nanything = 1\n",
        "map.toml",
    )
    assert load_columns(table) == load_columns(LOGGER)


@pytest.mark.parametrize(
    ("above", "below", "words"),
    [
        ("delimiter = ';'\n", "", "unknown key 'delimiter' beside [columns]; write it under the line [columns]"),
        (
            "",
            "[controllers.arm_angle]\nproportional = 3\n",
            "unknown key 'controllers' beside [columns]; did you mean 'controller'",
        ),
        ("", "[column]\n", "unknown key 'column' beside [columns]; did you mean 'columns'?"),
        (
            "",
            "[conditions]\npayload = '0.3 kg'\n",
            "has [conditions] beside [columns], which is read for no recording; write run",
        ),
    ],
)
def test_what_stands_beside_a_map_is_not_passed_over(tmp_path: Path, above: str, below: str, words: str) -> None:
    table = save(tmp_path, f"{above}[columns]\narm_angle = {{sign = -1}}\n{below}", "map.toml")
    with pytest.raises(InputError) as caught:
        load_columns(table)
    assert str(caught.value).startswith(f"{table}: {words}")


def test_semicolons_decimal_commas_and_signs(tmp_path: Path) -> None:
    path = save(tmp_path, "note;t;i;phi\nx;100,5;1500,0;90\ny;101,5;-2,5E1;0\n")
    recording = Recording.read(path, LOGGER)
    assert recording.time.tolist() == [0, 0.001]
    assert recording.command.tolist() == pytest.approx([1.5, -0.025])
    assert recording.signals["arm_angle"][0] == pytest.approx(-np.pi / 2)


def test_a_header_that_numpy_writes(tmp_path: Path) -> None:
    path = tmp_path / "run.txt"
    values = np.column_stack([0.1 * np.arange(4), np.ones(4), np.arange(4)])
    np.savetxt(path, values, header="payload = 0.3 kg\nt u q")
    columns = {name: {"column": place, "unit": unit} for name, place, unit in zip(NAMES, "tuq", ("s", "V", "rad"), strict=True)}
    for mark in ("#", "# "):
        run = Recording.read(path, {"delimiter": " ", "header_prefix": mark, **columns})
        assert run.signals["arm_angle"].tolist() == [0, 1, 2, 3]
        assert run.conditions == {"payload": 0.3}
    assert "row 2, column 'time': no 't'" in refusal(
        save(tmp_path, "# note\n# x u q\n0 1 2\n1 1 2\n"), columns={"delimiter": " ", "header_prefix": "#", **columns}
    )


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
        (changed(time={"column": "t", "unit": "s", "scale": 10**400}), "not zero"),
        (changed(time={"rate": 10**400}), "samples per second"),
        (changed(current={"value": 10**400}), "command of every row"),
        (changed(arm_angle={"column": "phi", "unit": "rad", "repeats": 10**400}), "2 or more"),
        (changed(time=None), "no time"),
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


def test_a_map_without_a_signal_is_for_commands_alone(tmp_path: Path) -> None:
    path = save(tmp_path, "t;i\n0;1\n1;2\n")
    message = refusal(path, columns=changed(arm_angle=None))
    assert message.startswith("has no measured signal")
    assert message.endswith("to [columns]")
    assert Recording.read(path, changed(arm_angle=None), require_signal=False).signals == {}


@pytest.mark.parametrize("content", ["", "columns = 3", "[columns", b"\xff\xfe"])
def test_column_files_that_are_none(tmp_path: Path, content: str | bytes) -> None:
    path = save(tmp_path, content, "map.toml")
    with pytest.raises(InputError) as caught:
        load_columns(path)
    assert str(caught.value).startswith(f"{path}: ")
    with pytest.raises(InputError, match="No such file"):
        load_columns(tmp_path / "none.toml")
