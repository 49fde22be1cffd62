"""What each command does, prints and writes."""

from __future__ import annotations

import json

import pytest
from cli_stand_ins import GOOD_ARM, HEADER, OWN, ROWS

import flexarm_env
from flexarm_env.arm import Arm
from flexarm_env.effects import catalogue
from flexarm_env.experiments.simulate import simulate
from flexarm_env.recordings.recording import Recording


def test_compare_shows_tables_and_exits_0(flexarm, identify, runs):
    assert flexarm("compare", runs) == 0
    for text in ("arm angle", "1.50", "12.0", "0-2 Hz", "stuck", "–", "the motor saturates"):
        assert text in flexarm.out
    (_, arm, recordings) = identify.log[0]
    assert arm.name == "thesis"
    assert [r.name for r in recordings] == ["pulse", "square"]
    assert flexarm.err == ""


@pytest.mark.parametrize(
    ("verdict", "effects", "code", "sentence"),
    [
        ("effects", ("backlash",), 0, "Missing: backlash, gap = 0.0612 rad (0.0582 to 0.0642)"),
        ("partly", ("backlash",), 1, "Partly explained. Missing: backlash, gap = 0.0612 rad (0.0582 to 0.0642)"),
        ("parameters", (), 0, "constants were wrong"),
        ("nothing_missing", (), 0, "No effect is missing"),
        ("unknown", (), 1, "none of the catalogue explains"),
        ("insufficient_data", (), 1, "insufficient for a diagnosis"),
    ],
)
def test_diagnose_says_its_verdict(flexarm, identify, runs, verdict, effects, code, sentence):
    identify.verdict, identify.effects = verdict, effects
    assert flexarm("diagnose", runs, "--seed", 5, "--jobs", 1) == code
    assert sentence in flexarm.out
    assert "A slow ramp would settle it." in flexarm.out
    assert identify.log[0][3:] == (5, 1)
    if effects:
        assert "cannot distinguish backlash from gear_compliance" in flexarm.out
        assert "4.10 → 3.70 → 1.02" in flexarm.out


def test_diagnose_writes_what_the_contract_says(flexarm, identify, runs, tmp_path):
    assert flexarm("diagnose", runs, "--json", tmp_path / "d.json", "--save", tmp_path / "arm.toml") == 0
    found = json.loads((tmp_path / "d.json").read_text())
    for key in (
        "verdict",
        "effects",
        "equivalent",
        "probability",
        "ranking",
        "error",
        "free_run",
        "constants",
        "seconds",
        "seed",
    ):
        assert key in found
    assert found["ranking"][0]["parameters"]["gap"]["unit"] == "rad"
    assert found["version"] == flexarm_env.__version__
    assert found["arm"] == "thesis"
    sums = [Recording.read(runs / f"{name}.csv").sha256 for name in ("pulse", "square")]
    assert [r["sha256"] for r in found["files"]] == sums
    assert Arm.load(tmp_path / "arm.toml").effects["backlash"]["gap"] == 0.0612
    assert sorted(p.name for p in tmp_path.iterdir()) == ["arm.toml", "d.json"]


def test_diagnose_says_where_there_is_no_next_run_to_write(flexarm, identify, runs, tmp_path):
    assert flexarm("diagnose", runs, "--next-run", tmp_path / "next.csv") == 0
    assert "No next run is proposed" in flexarm.err
    assert not (tmp_path / "next.csv").exists()


def test_json_to_stdout_stands_alone(flexarm, identify, runs):
    for command in (["compare", runs], ["diagnose", runs], ["add", "backlash", runs], ["fit", runs], ["effects"]):
        assert flexarm(*command, "--json", "-") == 0
        found = json.loads(flexarm.out)
        assert found
        assert "NaN" not in flexarm.out


@pytest.mark.parametrize(("final", "code"), [(1.02, 0), (3.7, 1), (float("nan"), 1)])
def test_add_says_whether_the_error_falls(flexarm, identify, runs, tmp_path, final, code):
    identify.final = final
    assert flexarm("add", "backlash", runs, "--save", tmp_path / "arm.toml", "--seed", 3) == code
    assert identify.log[0][1] == "backlash"
    assert identify.log[0][4] == 3
    assert "backlash_gap" in flexarm.out
    assert (tmp_path / "arm.toml").exists()


def test_add_takes_an_effect_of_one_s_own(flexarm, identify, runs, tmp_path):
    (tmp_path / "mine.py").write_text(OWN)
    spec = f"{tmp_path / 'mine.py'}:Mine"
    assert flexarm("add", spec, runs, "--save", tmp_path / "arm.toml") == 0
    assert identify.log[0][1] == "my_torque"
    assert flexarm("diagnose", runs, "--arm", tmp_path / "arm.toml", "--effects", spec) == 0
    assert "my_torque" in identify.log[1][1].known
    assert "my_torque" in flexarm.refused("diagnose", runs, "--arm", tmp_path / "arm.toml")
    assert flexarm("effects", spec) == 0
    assert "A torque of my own." in flexarm.out


def test_fit_saves_the_arm_and_says_when_it_does_not(flexarm, identify, runs, tmp_path):
    assert flexarm("fit", runs, "--save", tmp_path / "arm.toml") == 0
    assert Arm.load(tmp_path / "arm.toml").value("drive.torque_constant") == 0.3312
    assert flexarm("fit", runs) == 0
    assert "--save" in flexarm.err


def test_simulate_writes_a_recording(flexarm, arm, tmp_path):
    place = tmp_path / "run.csv"
    options = ("--input", "square", "--duration", 0.5, "--rate", 200, "--seed", 7, "--json", tmp_path / "run.json")
    assert flexarm("simulate", "--save", place, *options) == 0
    made, expected = Recording.read(place), simulate(arm, "square", 0.5, 200.0, 7)
    assert all((made.signals[s] == expected.signals[s]).all() for s in arm.signals)
    assert json.loads((tmp_path / "run.json").read_text())["seed"] == 7
    assert flexarm("simulate", "--save", tmp_path / "again.csv", "--input", place, "--no-noise") == 0
    again = Recording.read(tmp_path / "again.csv")
    assert (again.command == made.command).all()
    assert "did you mean 'pulse'" in flexarm.refused("simulate", "--save", place, "--input", "puls")


def test_simulate_plays_commands_without_signals(flexarm, arm, tmp_path):
    (tmp_path / "commands.csv").write_text("time [s],current [A]\n0,3\n0.1,3\n0.2,0\n0.3,0\n")
    (tmp_path / "foreign.csv").write_text("t;i\n0;3000\n100;3000\n200;0\n300;0\n")
    (tmp_path / "map.toml").write_text(
        "[columns]\ndelimiter = ';'\ntime = {column = 't', unit = 'ms'}\ncurrent = {column = 'i', unit = 'mA'}\n"
    )
    made = []
    for name, options in (("commands.csv", ()), ("foreign.csv", ("--columns", tmp_path / "map.toml"))):
        assert flexarm("simulate", "--save", tmp_path / "run.csv", "--input", tmp_path / name, "--no-noise", *options) == 0
        made.append(Recording.read(tmp_path / "run.csv"))
    assert made[0].command.tolist() == made[1].command.tolist() == [3.0, 3.0, 0.0, 0.0]
    assert list(made[0].signals) == arm.signals
    assert made[0].signals["arm_angle"][-1] > made[0].signals["arm_angle"][0] == 0.0
    assert "no measured signal" in flexarm.refused("compare", tmp_path / "commands.csv")
    (tmp_path / "volts.csv").write_text("time [s],voltage [V]\n0,3\n0.1,3\n")
    assert "--arm" in flexarm.refused("simulate", "--save", tmp_path / "run.csv", "--input", tmp_path / "volts.csv")


@pytest.mark.parametrize("per_volt", [2.0, 1.0])
def test_an_arm_s_columns_and_volts_serve_its_recordings(flexarm, identify, tmp_path, per_volt):
    text = GOOD_ARM.replace('noise = "0.1 deg"', f'noise = "0.1 deg"\nper_volt = "{per_volt} rad/V"')
    text += "[columns]\ntime = {index = 0, unit = 'ms'}\ncurrent = {index = 1, unit = 'A'}\n"
    text += "arm_angle = {index = 2, unit = 'V', sign = -1}\n"
    (tmp_path / "arm.toml").write_text(text)
    (tmp_path / "foreign.csv").write_text("t,i,pot\n0,1,0\n10,1,0.5\n20,1,0.6\n")
    (tmp_path / "native.csv").write_text(HEADER.replace("rad", "V") + ROWS)
    assert flexarm("compare", tmp_path / "foreign.csv", "--arm", tmp_path / "arm.toml") == 0
    assert identify.log[0][2][0].signals["arm_angle"].tolist() == [0.0, -0.5 * per_volt, -0.6 * per_volt]
    assert identify.log[0][2][0].time[1] == pytest.approx(0.01)
    assert flexarm("compare", tmp_path / "native.csv", "--arm", tmp_path / "arm.toml") == 0
    assert identify.log[1][2][0].signals["arm_angle"].tolist() == [0.0, 0.1 * per_volt, 0.2 * per_volt]


def test_effects_shows_the_catalogue_and_each_page(flexarm):
    assert flexarm("effects") == 0
    for name in catalogue():
        assert name in flexarm.out
    for name, effect in catalogue().items():
        assert flexarm("effects", name) == 0
        shown = " ".join(flexarm.out.split())
        assert all(key in shown for key in effect.parameters)
        assert " ".join(effect.looks_like.split())[:40] in shown


def test_bench_says_where_it_is(flexarm, monkeypatch):
    from flexarm_env.cli import benchmarks

    monkeypatch.setattr(benchmarks, "__file__", "/nowhere/flexarm_env/cli/benchmarks.py")
    assert "source tree" in flexarm.refused("bench")


def test_a_note_stays_one_line_whatever_the_path(flexarm, identify, tmp_path):
    folder = tmp_path / "one\ntwo"
    folder.mkdir()
    (folder / "run.csv").write_text(HEADER + ROWS)
    (folder / "run.toml").write_text("[conditions]\nkp = 3\n")
    assert flexarm("compare", folder / "run.csv") == 0
    (note,) = (line for line in flexarm.err.splitlines() if "run.toml" in line)
    assert note == rf"Note: {tmp_path}/one\ntwo/run.csv: run.toml states kp = 3"
