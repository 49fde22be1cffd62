"""Native recordings, their units and conditions, and folders of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recording_files import GOOD, HEADER, refusal, same, save

from flexarm_env.errors import InputError
from flexarm_env.recordings.recording import Recording


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


@pytest.mark.parametrize(
    ("unit", "scale", "radians"),
    [
        ("V", 1, 8.0),  # 2 V by a calibration of 4 rad/V
        ("V", 0.5, 4.0),
        ("mV", 1000, 8.0),
        ("V", "3 rad/V", 6.0),
        ("mV", "3 rad/V", 0.006),
        ("rad", 0.5, 1.0),
        ("mrad", 1000, 2.0),
        ("m", "3 rad/m", 6.0),
    ],
)
def test_a_calibration_is_for_volts_that_no_scale_converts(tmp_path: Path, unit: str, scale: float | str, radians: float) -> None:
    path = save(tmp_path, "t,i,q\n0,1,2\n1,1,2\n")
    table = {"time": {"column": "t", "unit": "s"}, "current": {"column": "i", "unit": "A"}}
    columns = {**table, "arm_angle": {"column": "q", "unit": unit, "scale": scale}}
    read = Recording.read(path, columns, calibration={"arm_angle": 4.0})
    assert read.signals["arm_angle"].tolist() == pytest.approx([radians, radians])
    if unit not in ("V", "mV") or isinstance(scale, str):
        assert same(Recording.read(path, columns), read)
    else:
        assert f"column 'arm_angle' is in {unit}" in refusal(path, columns=columns)


@pytest.mark.parametrize("gains", [{"arm_angel": 1}, *({"arm_angle": gain} for gain in (0.0, np.nan, None, "2 rad/V", 10**400))])
def test_calibration_is_checked(tmp_path: Path, gains: dict[str, Any]) -> None:
    with pytest.raises(InputError, match=r"calibration: .*arm_ang"):
        Recording.read(save(tmp_path, GOOD), calibration=gains)


def test_gaps_are_reported_and_accepted(tmp_path: Path) -> None:
    rows = "".join(f"{t},0,0\n" for t in (0, 1, 2, 3, 7, 8, 10, 20))
    recording = Recording.read(save(tmp_path, f"{HEADER}\n{rows}"))
    assert recording.gaps == [(3, 4.0), (6, 10.0)]
    assert "2 gaps" in repr(recording)


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


def test_a_copy_is_noted(tmp_path: Path) -> None:
    first, other = save(tmp_path, GOOD), save(tmp_path, GOOD.replace("0.7", "0.8"), "other.csv")
    copies = [
        save(tmp_path, text, f"copy {k}.csv")
        for k, text in enumerate((GOOD, GOOD.replace("[rad]", "[mrad]"), f"# rig: 2\n{GOOD}"))
    ]
    notes = [one.notes for one in Recording.read_all([first, other, *copies])]
    words = f"has every row of '{first.stem}', and counts beside it: is it a copy? leave one out"
    assert notes == [(), (), (words,), (), (words,)]
    still = "time [s],current [A],arm_angle [rad]\n0,0,0\n1,0,0\n2,0,0\n"
    assert all(one.notes == () for one in Recording.read_all([save(tmp_path, still, f"still {k}.csv") for k in range(2)]))


def test_other_conditions_become_si(tmp_path: Path) -> None:
    text = "# temperature = 20 degC\n# speed = 60 rpm\n# trial = 3 of 5\n# date = 2017-04-27\n" + GOOD
    conditions = Recording.read(save(tmp_path, text)).conditions
    assert conditions == {"temperature": pytest.approx(293.15), "speed": pytest.approx(2 * np.pi)}
