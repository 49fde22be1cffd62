"""An arm's own [columns] is followed where its columns are there, and never dropped without a word."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cli_stand_ins import GOOD_ARM
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from recording_files import same

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.lab.session import Session
from flexarm_env.lab.uploads import read_upload
from flexarm_env.recordings.column_maps import load_columns
from flexarm_env.recordings.recording import Recording
from flexarm_env.terminal.inputs import read_recordings

OWN = "time [s],current [A],arm_angle [rad]"
ROWS = "".join(f"{k / 10},{k % 3},{k / 7}\n" for k in range(12))
TIME = '{ column = "time [s]", unit = "s" }'
CURRENT = '{ column = "current [A]", unit = "A" }'
TURNED = '{ column = "arm_angle [rad]", unit = "rad", sign = -1 }'


def arm_file(folder: Path, settings: str = "", **columns: str) -> Path:
    path = folder / "A.toml"
    lines = "".join(f"{name} = {entry}\n" for name, entry in columns.items())
    path.write_text(f"{GOOD_ARM}\n[columns]\n{settings}\n{lines}")
    return path


def recording(folder: Path, header: str, rows: str = ROWS) -> Path:
    path = folder / "run.csv"
    path.write_text(f"{header}\n{rows}")
    return path


@pytest.mark.parametrize("header", [OWN, "time [s],current [A],arm_angle [rad],note", "time [s];current [A];arm_angle [rad]"])
def test_the_arm_is_enough(flexarm, identify, tmp_path, header):
    file = recording(tmp_path, header, "".join(f"{k / 10},1,{k / 7}{',x' * (header[-1] == 'e')}\n" for k in range(12)))
    if ";" in header:
        file.write_text(file.read_text().replace(",", ";"))
    arm = arm_file(tmp_path, 'delimiter = ";"' if ";" in header else "", time=TIME, current=CURRENT, arm_angle=TURNED)
    assert flexarm("compare", file, "--arm", arm) == 0
    noted = flexarm.err
    assert flexarm("compare", file, "--arm", arm, "--columns", arm) == 0
    (by_arm,), (by_map,) = (call[2] for call in identify.log)
    assert same(by_arm, by_map)
    assert by_arm.signals["arm_angle"][7] == -1
    assert ("its own header differs in arm_angle" in noted) == (header == OWN)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    texts=st.permutations(["time [s]", "current [A]", "arm_angle [rad]", "motor_speed [rad/s]"]),
    units=st.tuples(st.sampled_from(["s", "ms"]), st.sampled_from(["A", "mA"]), st.sampled_from(["rad", "deg", "mrad"])),
    sign=st.sampled_from([1, -1]),
    scale=st.sampled_from([1, 2.5]),
)
def test_whatever_the_map_says_of_a_plain_file_counts(
    tmp_path: Path, texts: list[str], units: tuple[str, ...], sign: int, scale: float
) -> None:
    names = ("time", "current", "arm_angle")
    columns: dict[str, dict[str, Any]] = {n: {"column": t, "unit": u} for n, t, u in zip(names, texts, units, strict=False)}
    columns["arm_angle"] |= {"sign": sign, "scale": scale}
    file = recording(tmp_path, ",".join(texts), "".join(f"{k},{k},{k},{k}\n" for k in range(4)))
    (found,) = read_recordings(replace(Arm.load("thesis"), columns=columns), [file], None)
    assert same(found, Recording.read(file, columns))
    plain = Recording.read(file)
    assert found.notes or all((plain.signals[s] == v).all() for s, v in found.signals.items())


def test_files_that_flexarm_wrote_are_read_plainly_beside_those_of_the_logger(flexarm, identify, tmp_path):
    arm = arm_file(
        tmp_path,
        time='{ column = "t", unit = "ms" }',
        current='{ column = "i", unit = "mA" }',
        arm_angle='{ column = "phi", unit = "deg", sign = -1 }',
    )
    recording(tmp_path, "t,i,phi").rename(tmp_path / "logger.csv")
    recording(tmp_path, OWN)
    assert flexarm("compare", tmp_path, "--arm", arm) == 0
    logger, own = identify.log[0][2]
    assert (logger.name, own.name) == ("logger", "run")
    assert same(own, Recording.read(tmp_path / "run.csv"))
    assert logger.time[-1] == pytest.approx(0.0011)
    assert flexarm.err == ""


BY_NUMBER = {"time": '{ index = 0, unit = "s" }', "current": '{ index = 1, unit = "A" }'}


def test_a_map_of_numbers_agrees_with_the_header_or_is_noted(flexarm, identify, tmp_path):
    file = recording(tmp_path, OWN)
    for unit, sign in (("rad", -1), ("deg", 1)):
        arm = arm_file(tmp_path, **BY_NUMBER, arm_angle=f'{{ index = 2, unit = "{unit}", sign = {sign} }}')
        assert flexarm("compare", file, "--arm", arm) == 0
        read = identify.log[-1][2][0]
        assert same(read, Recording.read(file, arm if unit == "rad" else None))
        assert f"Note: {file}: read by " in flexarm.err
        assert "differ" in flexarm.err


def test_part_of_a_map_that_says_otherwise_is_not_dropped(flexarm, tmp_path):
    arm = arm_file(tmp_path, time=TIME, current=CURRENT, arm_angle=TURNED, motor_speed='{ column = "w", unit = "rpm" }')
    line = flexarm.refused("compare", recording(tmp_path, OWN), "--arm", arm)
    assert "no 'w' in the header" in line
    assert "run.csv" in line


def test_commands_are_played_as_their_header_says(flexarm, tmp_path):
    file = recording(tmp_path, "time [s],current [A]", "0,0\n0.1,1\n0.2,0\n")
    opposite = CURRENT.replace("}", ", sign = -1 }")
    for current, noted in ((CURRENT, False), (opposite, True)):
        arm = arm_file(tmp_path, time=TIME, current=current, arm_angle=TURNED)
        assert flexarm("simulate", "--input", file, "--arm", arm, "--save", tmp_path / "made.csv") == 0
        assert Recording.read(tmp_path / "made.csv").command.tolist() == [0, 1, 0]
        assert ("differ in current" in flexarm.err) == noted


def test_a_map_that_makes_no_sense_is_refused_for_plain_files_too(flexarm, tmp_path):
    arm = arm_file(tmp_path, tiem=TIME)
    assert "did you mean 'time'" in flexarm.refused("compare", recording(tmp_path, OWN), "--arm", arm)


def test_the_lab_reads_by_the_same_rule_and_says_so(tmp_path):
    arm = Arm.load(arm_file(tmp_path, time=TIME, current=CURRENT, arm_angle=TURNED))
    content = recording(tmp_path, OWN, "".join(f"{k / 10},{k % 3},{k / 7}\n" for k in range(60))).read_bytes()
    (recorded,) = read_upload(arm, "run.csv", content, None, [])
    assert recorded.signals["arm_angle"][7] == -1
    session = Session(arm)
    (line,) = session.upload([("run.csv", content)])
    assert line == "run.csv: read by the arm's [columns]; its own header differs in arm_angle"
    assert len(session.recordings) == 1


def test_a_file_that_no_rule_reads_is_refused_by_the_map(tmp_path):
    arm = Arm.load(arm_file(tmp_path, time=TIME, current=CURRENT, arm_angle=TURNED))
    with pytest.raises(InputError, match="no 'current \\[A\\]' in the header"):
        read_recordings(arm, [recording(tmp_path, "time [s],u,arm_angle [rad]")], None)


NUMBERS = {
    "time": {"index": 0, "unit": "s"},
    "current": {"index": 1, "unit": "A"},
    "arm_angle": {"index": 2, "unit": "rad"},
    "motor_speed": {"index": 3, "unit": "rad/s"},
}
DEGREES = "time [s],current [A],arm_angle [deg],motor_speed [rad/s]"


def read_by_numbers(file: Path) -> Recording:
    arm = replace(Arm.load("thesis"), columns=load_columns(NUMBERS))
    (found,) = read_recordings(arm, [file], None)
    return found


def same_table(folder: Path, header: str, kind: str) -> Path:
    """Write a table whose angle is in degrees as CSV, behind many remarks or not, or as Parquet."""
    names = header.split(",")
    columns = [[k / 10 for k in range(12)], [float(k % 3) for k in range(12)], [float(k) for k in range(12)], [2.0] * 12]
    if kind == "parquet":
        arrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
        parquet.write_table(arrow.table(dict(zip(names, columns, strict=False))), folder / "run.parquet")
        return folder / "run.parquet"
    rows = "".join(",".join(map(str, row)) + "\n" for row in zip(*columns[: len(names)], strict=True))
    return recording(folder, "# a remark of the logger\n" * (5000 if kind == "remarks" else 0) + header, rows)


@pytest.mark.parametrize("kind", ["csv", "remarks", "parquet"])
def test_a_header_with_other_units_is_followed_in_every_kind_of_file(tmp_path, kind):
    found = read_by_numbers(same_table(tmp_path, DEGREES, kind))
    assert found.signals["arm_angle"][11] == pytest.approx(11.0 * np.pi / 180.0)
    assert any("read by its own header; the arm's [columns] differ in arm_angle" in note for note in found.notes)


@pytest.mark.parametrize("kind", ["csv", "parquet"])
def test_a_map_of_more_numbers_than_the_file_has_columns_is_not_dropped_without_a_word(tmp_path, kind):
    found = read_by_numbers(same_table(tmp_path, DEGREES.rpartition(",")[0].replace("deg", "rad"), kind))
    assert list(found.signals) == ["arm_angle"]
    assert any("read by its own header; the arm's [columns] differ in motor_speed" in note for note in found.notes)
