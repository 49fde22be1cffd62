"""Recordings, arms and column maps that are refused: one line each."""

from __future__ import annotations

import os

import pytest
from cli_stand_ins import GOOD_ARM, HEADER, ROWS


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("", "empty"),
        (ROWS, "header"),
        ("time,current,arm_angle\n" + ROWS, "unit"),
        ("time [s],current [A],arm_angle [furlong]\n" + ROWS, "unit"),
        ("time [s],current [A],arm_angel [rad]\n" + ROWS, "did you mean 'arm_angle'"),
        ("time [s],arm_angle [rad]\n0,0\n1,0\n", "current"),
        ("time [s],current [A]\n0,0\n1,0\n", "signal"),
        ("current [A],arm_angle [rad]\n0,0\n1,0\n", "time"),
        (HEADER + "0,1,0\n", "two"),
        (HEADER + "0,1,0\n0.1,oops,0.1\n", "row 3"),
        (HEADER + "0,,0\n0.1,1,0.1\n", "row 2"),
        (HEADER + "0,NaN,0\n0.1,1,0\n", "row 2"),
        (HEADER + "0,1,0\n0.1,1,inf\n", "row 3"),
        (HEADER + "0,1,0\n0.2,1,0\n0.1,1,0\n", "back"),
        (HEADER + "0,1,0\n0,1,0\n", "repeats"),
        (HEADER + "0,1,0\n0.1,1\n", "row 3"),
        (HEADER.replace(",", ";") + ROWS.replace(",", ";"), "semicolon"),
        ("time [s],voltage [V],arm_angle [rad]\n" + ROWS, "--arm"),
        ("time [s],current [A],tip_deflection [m]\n" + ROWS, "none"),
        (b"\x89PNG\r\n\x1a\n\0\0\0\xff\xfe", "UTF-8"),
        (b"\0" * 64, "binary"),
    ],
)
@pytest.mark.parametrize("command", ["compare", "diagnose"])
def test_a_bad_recording_gets_one_line(flexarm, tmp_path, command, content, words):
    file = tmp_path / "run.csv"
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    line = flexarm.refused(command, file)
    assert str(file) in line
    assert words in line


def test_recordings_that_are_no_files_get_one_line(flexarm, tmp_path):
    (tmp_path / "empty").mkdir()
    (tmp_path / "new\nline.csv").write_text(HEADER)
    os.mkfifo(tmp_path / "pipe.csv")
    (tmp_path / "loop.csv").symlink_to(tmp_path / "loop.csv")
    with open(tmp_path / "big.csv", "wb") as file:
        file.truncate(3 << 30)
    for name in ("no.csv", "empty", "new\nline.csv", "pipe.csv", "loop.csv", "big.csv"):
        assert (tmp_path / name).name.split("\n")[0] in flexarm.refused("compare", tmp_path / name)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("gear_ratio", "gear_ration", "did you mean 'gear_ratio'"),
        ("[drive]", "[dirve]", "did you mean 'drive'"),
        ("coulomb", "colomb", "did you mean 'coulomb'"),
        ("torque =", "torqe =", "did you mean 'torque'"),
        ("arm_angle", "arm_angel", "did you mean 'arm_angle'"),
        ('"0.2 Nm"', '"0.2 s"', "convert"),
        ('"0.2 Nm"', '"0.2 Nmm/fortnight/"', "effects.coulomb.torque"),
        ('"0.2 Nm"', "-1.0", "out of bounds"),
        ('"0.2 Nm"', "nan", "not a number"),
        ('"0.2 Nm"', "true", "no number"),
        ('"0.2 Nm"', "[1]", "no number"),
        ("[hub]\ninertia = 0.13", "", "missing"),
        ("gear_ratio = 1.5", "", "gear_ratio is missing"),
        ("[hub]", "[[hub]]", "table"),
        ("gear_ratio = 1.5", 'gear_ratio = 1.5\ninput = "steam"', "input"),
        ("gear_ratio = 1.5", 'gear_ratio = 1.5\ninput = "voltage"', "resistance"),
        ("[effects.coulomb]", "[sensors.strain_mid]\n[effects.coulomb]", "beam"),
        ("gear_ratio = 1.5", "gear_ratio = = 1.5", "TOML"),
        (GOOD_ARM, "", "missing"),
        (GOOD_ARM, "\0", "TOML"),
        (GOOD_ARM, "x = " + "[" * 20_000, "nested"),
        ("gear_ratio = 1.5", f"gear_ratio = {10**400}", "out of bounds"),
        ("gear_ratio = 1.5", f"gear_ratio = {'1' * 5000}", "TOML"),
        ("gear_ratio = 1.5", 'gear_ratio = 1.5\ninput = ["current"]', "input"),
        ("[drive]", "columns = 5\n[drive]", "columns is not a table"),
        ("[drive]", "fitted = 5\n[drive]", "fitted is not a table"),
    ],
)
def test_a_bad_arm_file_gets_one_line(flexarm, runs, tmp_path, old, new, words):
    file = tmp_path / "arm.toml"
    assert old in GOOD_ARM
    file.write_text(GOOD_ARM.replace(old, new, 1))
    line = flexarm.refused("compare", runs, "--arm", file)
    assert str(file) in line
    assert words in line


def test_a_long_key_of_an_arm_file_makes_no_long_line(flexarm, runs, tmp_path):
    file = tmp_path / "arm.toml"
    file.write_text(GOOD_ARM.replace("gear_ratio", "gear" * 50_000, 1))
    line = flexarm.refused("compare", runs, "--arm", file)
    assert "unknown key 'drive.geargear" in line
    assert len(line) < 1000 + len(str(file))


def test_an_arm_that_is_no_file_gets_one_line(flexarm, runs, tmp_path):
    (tmp_path / "binary.toml").write_bytes(bytes(range(256)))
    with open(tmp_path / "big.toml", "wb") as file:
        file.truncate(1 << 30)
    assert "did you mean 'thesis-fem'" in flexarm.refused("compare", runs, "--arm", "thesis-fm")
    for name in ("binary.toml", "big.toml", "no.toml", ""):
        flexarm.refused("compare", runs, "--arm", tmp_path / name)


def test_a_good_arm_file_is_taken(flexarm, identify, runs, tmp_path):
    (tmp_path / "arm.toml").write_text("\ufeff" + GOOD_ARM)  # as some editors save it
    assert flexarm("compare", runs, "--arm", tmp_path / "arm.toml") == 0


def test_bad_columns_get_one_line(flexarm, runs, tmp_path):
    file = tmp_path / "columns.toml"
    flexarm.refused("compare", runs, "--columns", file)
    file.write_text("[columns]\ntiem = {index = 0, unit = 's'}\n")
    assert "did you mean 'time'" in flexarm.refused("compare", runs, "--columns", file)
