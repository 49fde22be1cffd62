"""Places that are written: refused before the work where they cannot be, and nothing that is read is written over."""

from __future__ import annotations

import pytest
from cli_stand_ins import GOOD_ARM, HEADER, MAP, ROWS

from flexarm_env import arm_file


@pytest.mark.parametrize("option", ["--json", "--save", "--report"])
def test_places_that_cannot_be_written_are_refused_before_the_work(flexarm, identify, runs, tmp_path, option):
    (tmp_path / "file").write_text("")
    for place in (tmp_path, tmp_path / "no" / "x", tmp_path / "file" / "x"):
        assert "cannot write" in flexarm.refused("diagnose", runs, option, place)
    assert identify.log == []


@pytest.mark.parametrize("option", ["--json", "--save", "--report", "--next-run"])
def test_a_place_that_ends_in_a_slash_is_a_folder(flexarm, identify, runs, tmp_path, option):
    line = f"'{option}': {tmp_path}/new/ is a folder; name a file in it"
    assert line in flexarm.refused("diagnose", runs, option, f"{tmp_path}/new/")
    assert f"{tmp_path}/new/ is a folder" in flexarm.refused("simulate", "--save", f"{tmp_path}/new/")
    assert identify.log == []
    assert not list(tmp_path.glob("new*"))


@pytest.mark.parametrize("suffix", [".mat", ".parquet", ".PDF", ".png", ".xlsx", ".gz"])
@pytest.mark.parametrize("option", ["--json", "--save", "--report"])
def test_a_suffix_of_another_form_is_refused_before_the_work(flexarm, identify, runs, tmp_path, option, suffix):
    assert f"would be no {suffix} file" in flexarm.refused("diagnose", runs, option, tmp_path / f"out{suffix}")
    assert f"would be no {suffix} file" in flexarm.refused("simulate", "--save", tmp_path / f"out{suffix}")
    assert identify.log == []
    assert not list(tmp_path.glob("out*"))


def test_nothing_that_is_read_or_written_is_written_over(flexarm, identify, runs, tmp_path):
    one, other = runs / "pulse.csv", tmp_path / "out.toml"
    before = one.read_bytes()
    (tmp_path / "link.json").symlink_to(one)
    for words in (
        ["compare", one, "--json", one],
        ["compare", runs, "--json", one],
        ["compare", one, "--json", tmp_path / "link.json"],
        ["diagnose", one, "--save", one],
        ["diagnose", one, "--save", other, "--json", other],
        ["simulate", "--input", one, "--save", one],
        ["simulate", "--save", tmp_path / "a.csv", "--json", tmp_path / "a.csv"],
    ):
        assert "already" in flexarm.refused(*words)
    assert "stdout" in flexarm.refused("simulate", "--save", "-")
    assert one.read_bytes() == before
    assert identify.log == []


def test_no_arm_that_is_read_is_written_over(flexarm, identify, runs, tmp_path, monkeypatch):
    """A shipped one is read by its name, and not saved anew without its path being named."""
    (tmp_path / "arms").mkdir()
    place = tmp_path / "arms" / "ours.toml"
    place.write_text(GOOD_ARM)
    monkeypatch.setattr(arm_file, "config_folders", lambda kind: [tmp_path / kind])
    for named in ("ours", place):
        for words in (
            ["simulate", "--arm", named, "--json", place, "--save", tmp_path / "new.csv"],
            ["fit", runs, "--arm", named, "--json", place],
            ["tune", "pd", "--arm", named, "--save", place],
            ["envs", "--arm", named, "--json", place],
        ):
            assert "already" in flexarm.refused(*words), words
        assert f"cannot write {place}: " in flexarm.refused("simulate", "--arm", named, "--save", place)
    for words in (["fit", runs], ["add", "backlash", runs], ["diagnose", runs]):
        assert "already" in flexarm.refused(*words, "--arm", "ours", "--save", place)
    assert place.read_text() == GOOD_ARM
    assert identify.log == []


@pytest.mark.parametrize("suffix", [".toml", ".json", ".html", ".py"])
def test_a_recording_is_not_written_as_what_is_read_as_something_else(flexarm, identify, runs, tmp_path, suffix):
    place = tmp_path / f"run{suffix}"
    for words in (["simulate", "--save", place], ["diagnose", runs, "--next-run", place]):
        assert f"cannot write {place}: a recording is no {suffix} file; end it in .csv" in flexarm.refused(*words)
    assert identify.log == []
    assert not place.exists()


JOINED = """
[columns]
time = {column = "t", unit = "s"}
current = {file = "*_command.csv", column = "i", unit = "A"}
arm_angle = {file = "*_encoder.csv", column = "phi", unit = "rad"}
"""


@pytest.mark.parametrize("of_the_arm", [False, True])
def test_no_file_that_belongs_to_a_recording_is_written_over(flexarm, identify, tmp_path, monkeypatch, of_the_arm):
    """It is not on the command line: conditions beside a recording, and the other files of a joined one."""
    (tmp_path / "run.csv").write_text(HEADER + ROWS)
    (tmp_path / "m_command.csv").write_text("t,i\n0,1\n1,1\n2,0\n")
    (tmp_path / "m_encoder.csv").write_text("t,phi\n0,0\n1,1\n2,2\n")
    for name in ("run", "m", "m_encoder"):
        (tmp_path / f"{name}.toml").write_text("[conditions]\npayload = '0.3 kg'\n")
    (tmp_path / "map.toml").write_text(JOINED)
    (tmp_path / "arm.toml").write_text(GOOD_ARM + JOINED)
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    how = ("--arm", "arm.toml") if of_the_arm else ("--columns", "map.toml")
    monkeypatch.chdir(tmp_path)
    for words in (
        ["fit", "run.csv", "--save", "run.toml"],
        ["compare", "run.csv", "--json", "run.toml"],
        ["simulate", "--input", "run.csv", "--save", "new.csv", "--json", "run.toml"],
        ["compare", "m_command.csv", *how, "--json", "m_encoder.csv"],
        ["compare", "m_encoder.csv", *how, "--json", "m_command.csv"],
        ["fit", "m_command.csv", *how, "--save", "m.toml"],
        ["fit", "m_command.csv", *how, "--save", "m_encoder.toml"],
        ["simulate", "--input", "m_command.csv", *how, "--save", "m_encoder.csv"],
    ):
        assert "already" in flexarm.refused(*words), words
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before
    assert identify.log == []


def test_the_info_of_a_data_set_is_not_written_over(flexarm, identify, tmp_path):
    """It is found from the file, three folders above it."""
    pytest.importorskip("pyarrow")
    for folder in ("data/chunk-000", "meta"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "map.toml").write_text(MAP)
    (tmp_path / "meta/info.json").write_text("{}")
    file = tmp_path / "data/chunk-000/file-000.parquet"
    file.write_text("not read before the places are checked")
    for named in (file, tmp_path):
        words = ["compare", named, "--columns", tmp_path / "map.toml", "--json", tmp_path / "meta/info.json"]
        assert "already" in flexarm.refused(*words)


def test_an_arm_beside_a_recording_may_be_saved_anew(flexarm, identify, tmp_path):
    (tmp_path / "run.csv").write_text(HEADER + ROWS)
    for _ in range(2):
        assert flexarm("fit", tmp_path / "run.csv", "--save", tmp_path / "run.toml") == 0


def test_an_arm_may_be_saved_in_its_own_file(flexarm, identify, runs, tmp_path):
    arm = tmp_path / "arm.toml"
    arm.write_text(GOOD_ARM)
    assert flexarm("fit", runs, "--arm", arm, "--save", arm) == 0
    assert "already" in flexarm.refused("fit", runs, "--arm", arm, "--json", arm)
