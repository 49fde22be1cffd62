"""The command line: exit codes, one clear line for bad input, whole outputs, what it calls."""

from __future__ import annotations

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import flexarm_env
from flexarm_env import cli
from flexarm_env.arm import Arm
from flexarm_env.effects import catalogue
from flexarm_env.errors import InputError
from flexarm_env.identify.recording import Recording
from flexarm_env.identify.results import Addition, Candidate, Comparison, Diagnosis, Estimate, Fit, Replay, Row
from flexarm_env.identify.simulate import simulate
from flexarm_env.pictures import words

HEADER = "time [s],current [A],arm_angle [rad]\n"
ROWS = "0,1,0\n0.1,1,0.1\n0.2,0,0.2\n"
OWN = '''
from flexarm_env.effects import Effect
from flexarm_env.effects.base import torque_size


class Mine(Effect):
    """A torque of my own."""

    name = "my_torque"
    equation = "T = a"
    parameters = {"size": torque_size("a", 0.1)}
    looks_like = "a constant error"

    @staticmethod
    def torque(size):
        return size
'''
PLOTS = importlib.util.find_spec("plotly") is not None and importlib.util.find_spec("matplotlib") is not None
needs_plots = pytest.mark.skipif(not PLOTS, reason="the extra plots is not installed")


class Call:
    """Runs a command line in this process; afterwards it knows what came out."""

    def __init__(self, capsys):
        self.capsys = capsys

    def __call__(self, *arguments) -> int:
        self.code = cli.run([str(a) for a in arguments])
        self.out, self.err = self.capsys.readouterr()
        return self.code

    def refused(self, *arguments) -> str:
        """Run what must be refused; return the one line on stderr."""
        assert self(*arguments) == 2, self.out + self.err
        assert self.out == ""
        assert self.err.startswith("flexarm: ")
        assert self.err.endswith("\n")
        assert len(self.err.splitlines()) == 1
        assert "Traceback" not in self.err
        return self.err


@pytest.fixture
def flexarm(capsys) -> Call:
    return Call(capsys)


@pytest.fixture(scope="module")
def arm() -> Arm:
    return Arm.load("thesis")


@pytest.fixture(scope="module")
def runs(arm, tmp_path_factory) -> Path:
    """A folder with two short recordings."""
    folder = tmp_path_factory.mktemp("runs")
    for name in ("pulse", "square"):
        simulate(arm, name, duration=1.0, rate=200.0).write(folder / f"{name}.csv")
    return folder


# Results made by hand, in the place of the identification


def estimate(path: str, value: float, half: float, unit: str, nominal: float = 0.0) -> Estimate:
    return Estimate(path, value, value - half, value + half, unit, nominal)


GAP = estimate("effects.backlash.gap", 0.0612, 0.003, "rad")
KPHI = estimate("drive.torque_constant", 0.3312, 0.0021, "Nm/A", 0.33)


def fake_compare(arm, recordings, progress=None):
    def replay(r: Recording) -> Replay:
        model = {s: v - 0.1 * (v - v.mean()) for s, v in r.signals.items()}
        return Replay(r.name, r.time, r.signals, model, model, np.zeros(len(r), dtype=np.int64))

    nan = float("nan")
    rows = [
        Row("all", "arm_angle", "all", 1.5, 12.0, 98.7, 200),
        Row("all", "arm_angle", "stuck", nan, nan, nan, 0),
        Row("all", "arm_angle", "0-2 Hz", 1.4, nan, nan, 200),
        Row("all", "all", "all", 1.5, 12.0, nan, 200),
    ]
    noise = {signal: 0.01 for signal in recordings[0].signals}
    return Comparison(arm, rows, [replay(r) for r in recordings], noise, 1.5, 12.0, ["pulse: the motor saturates"])


def fake_diagnosis(arm, verdict="effects", effects=("backlash",), seed=0):
    ranking = [Candidate("backlash", 0.93, bool(effects), [GAP]), Candidate("stribeck", 0.04, False, [])]
    error = {"nominal": 4.1, "refitted": 3.7, "final": 1.02 if effects else 3.7, **dict.fromkeys(effects, 1.02)}
    better = arm.with_effect("backlash", gap=0.0612) if effects else arm
    return Diagnosis(
        verdict,
        list(effects),
        [["backlash", "gear_compliance"]] if effects else [],
        ranking,
        error,
        {key: 10 * value for key, value in error.items()},
        {"torque_constant": KPHI},
        better,
        arm,
        arm,
        ["A slow ramp would settle it."],
        1.23,
        seed,
    )


@pytest.fixture
def identify(monkeypatch) -> SimpleNamespace:
    """Quick stand-ins for the identification, which record what they were called with."""
    calls = SimpleNamespace(log=[], verdict="effects", effects=("backlash",), final=1.02)

    def compare(arm, recordings, progress=None):
        calls.log.append(("compare", arm, recordings))
        return fake_compare(arm, recordings)

    def diagnose(arm, recordings, progress=None, seed=0, jobs=2):
        calls.log.append(("diagnose", arm, recordings, seed, jobs))
        return fake_diagnosis(arm, calls.verdict, calls.effects, seed)

    def add(effect, arm, recordings, progress=None, seed=0):
        calls.log.append(("add", effect, arm, recordings, seed))
        error = {"nominal": 4.1, "refitted": 3.7, "final": calls.final}
        return Addition(arm.with_effect(effect), effect, [GAP, KPHI], error, error, 1.0)

    def fit(arm, recordings, progress=None, seed=0):
        calls.log.append(("fit", arm, recordings, seed))
        error = {"nominal": 4.1, "refitted": 3.7}
        return Fit(arm.with_values({"drive.torque_constant": 0.3312}), [KPHI], error, error, 1.0)

    for function in (compare, diagnose, add, fit):
        monkeypatch.setitem(vars(flexarm_env), function.__name__, function)
    return calls


# What is refused


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
        (HEADER + "0,1,0\n0.1,,0.1\n", "row 3"),
        (HEADER + "0,1,0\n0.1,1,NaN\n", "row 3"),
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


GOOD_ARM = """
[drive]
torque_constant = 0.33
gear_ratio = 1.5
motor_inertia = 0.00193
[hub]
inertia = 0.13
[sensors.arm_angle]
noise = "0.1 deg"
[effects.coulomb]
torque = "0.2 Nm"
"""


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
    ],
)
def test_a_bad_arm_file_gets_one_line(flexarm, runs, tmp_path, old, new, words):
    file = tmp_path / "arm.toml"
    assert old in GOOD_ARM
    file.write_text(GOOD_ARM.replace(old, new, 1))
    line = flexarm.refused("compare", runs, "--arm", file)
    assert str(file) in line
    assert words in line


def test_an_arm_that_is_no_file_gets_one_line(flexarm, runs, tmp_path):
    (tmp_path / "binary.toml").write_bytes(bytes(range(256)))
    with open(tmp_path / "big.toml", "wb") as file:
        file.truncate(1 << 30)
    assert "did you mean 'thesis-fem'" in flexarm.refused("compare", runs, "--arm", "thesis-fm")
    for name in ("binary.toml", "big.toml", "no.toml", ""):
        flexarm.refused("compare", runs, "--arm", tmp_path / name)


def test_a_good_arm_file_is_taken(flexarm, identify, runs, tmp_path):
    (tmp_path / "arm.toml").write_text(GOOD_ARM)
    assert flexarm("compare", runs, "--arm", tmp_path / "arm.toml") == 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["compar"], "did you mean 'compare'"),
        (["--arms"], "--arms"),
        (["compare"], "RECORDING"),
        (["compare", "x.csv", "--arms", "thesis"], "did you mean '--arm'"),
        (["compare", "x.csv", "--arm"], "--arm"),
        (["diagnose", "x.csv", "--seed", "one"], "--seed"),
        (["diagnose", "x.csv", "--seed", "-1"], "--seed"),
        (["diagnose", "x.csv", "--jobs", "0"], "--jobs"),
        (["add"], "EFFECT"),
        (["add", "backlash"], "RECORDING"),
        (["simulate"], "--save"),
        (["simulate", "--save", "x.csv", "--rate", "fast"], "--rate"),
        (["effects", "backlas"], "did you mean 'backlash'"),
        (["effects", "a", "b"], "b"),
        (["effects", "no.py:Name"], "no.py"),
    ],
)
def test_a_mistyped_command_gets_one_line(flexarm, tmp_path, monkeypatch, arguments, words):
    monkeypatch.chdir(tmp_path)
    assert words in flexarm.refused(*arguments)


@pytest.mark.parametrize("option", ["--json", "--save", "--report"])
def test_places_that_cannot_be_written_are_refused_before_the_work(flexarm, identify, runs, tmp_path, option):
    (tmp_path / "file").write_text("")
    for place in (tmp_path, tmp_path / "no" / "x", tmp_path / "file" / "x"):
        assert "cannot write" in flexarm.refused("diagnose", runs, option, place)
    assert identify.log == []


def test_an_effect_that_cannot_be_added_is_refused(flexarm, identify, runs, tmp_path):
    file = tmp_path / "mine.py"
    assert "did you mean 'backlash'" in flexarm.refused("add", "backlas", runs)
    assert "exists" in flexarm.refused("add", f"{file}:Mine", runs)
    file.write_text(OWN)
    assert "did you mean 'Mine'" in flexarm.refused("add", f"{file}:Mien", runs)
    file.write_text("import nothing_of_the_sort")
    assert "ModuleNotFoundError" in flexarm.refused("add", f"{file}:Mine", runs)
    file.write_text("def :")
    assert "SyntaxError" in flexarm.refused("diagnose", runs, "--effects", f"{file}:Mine")
    file.write_text(OWN.replace("equation", "formula"))
    assert "equation" in flexarm.refused("diagnose", runs, "--effects", f"{file}:Mine")


def test_bad_columns_get_one_line(flexarm, runs, tmp_path):
    file = tmp_path / "columns.toml"
    flexarm.refused("compare", runs, "--columns", file)
    file.write_text("[columns]\ntiem = {index = 0, unit = 's'}\n")
    assert "did you mean 'time'" in flexarm.refused("compare", runs, "--columns", file)


@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (InputError("the recordings\nare too short"), 2, "the recordings are too short"),
        (KeyboardInterrupt(), 130, "stopped"),
        (OSError(28, "No space left on device", "x.csv"), 2, "No space left"),
        (np.linalg.LinAlgError("Singular matrix"), 2, "fault of the program"),
    ],
)
def test_whatever_goes_wrong_is_one_line(flexarm, identify, runs, monkeypatch, error, code, words):
    def fail(*args, **kwargs):
        raise error

    monkeypatch.setitem(vars(flexarm_env), "compare", fail)
    assert flexarm("compare", runs) == code
    assert len(flexarm.err.splitlines()) == 1
    assert words in flexarm.err


# What is done


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
        ("parameters", (), 0, "constants were off"),
        ("nothing_missing", (), 0, "Nothing is missing"),
        ("unknown", (), 1, "nothing in the catalogue explains"),
        ("insufficient_data", (), 1, "cannot tell"),
    ],
)
def test_diagnose_says_its_verdict(flexarm, identify, runs, verdict, effects, code, sentence):
    identify.verdict, identify.effects = verdict, effects
    assert flexarm("diagnose", runs, "--seed", 5, "--jobs", 1) == code
    assert sentence in flexarm.out
    assert "A slow ramp would settle it." in flexarm.out
    assert identify.log[0][3:] == (5, 1)
    if effects:
        assert "cannot tell backlash from gear_compliance" in flexarm.out
        assert "4.10 → 3.70 → 1.02" in flexarm.out


def test_diagnose_writes_what_the_contract_says(flexarm, identify, runs, tmp_path):
    assert flexarm("diagnose", runs, "--json", tmp_path / "d.json", "--save", tmp_path / "arm.toml") == 0
    found = json.loads((tmp_path / "d.json").read_text())
    for key in ("verdict", "effects", "equivalent", "ranking", "error", "free_run", "constants", "seconds", "seed"):
        assert key in found
    assert found["ranking"][0]["parameters"]["gap"]["unit"] == "rad"
    assert found["version"] == flexarm_env.__version__
    assert found["arm"] == "thesis"
    sums = [Recording.read(runs / f"{name}.csv").sha256 for name in ("pulse", "square")]
    assert [r["sha256"] for r in found["recordings"]] == sums
    assert Arm.load(tmp_path / "arm.toml").effects["backlash"]["gap"] == 0.0612
    assert sorted(p.name for p in tmp_path.iterdir()) == ["arm.toml", "d.json"]


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


def test_an_arm_s_columns_and_volts_serve_its_recordings(flexarm, identify, tmp_path):
    text = GOOD_ARM.replace('noise = "0.1 deg"', 'noise = "0.1 deg"\nper_volt = "2 rad/V"')
    text += "[columns]\ntime = {index = 0, unit = 'ms'}\ncurrent = {index = 1, unit = 'A'}\n"
    text += "arm_angle = {index = 2, unit = 'V', sign = -1}\n"
    (tmp_path / "arm.toml").write_text(text)
    (tmp_path / "foreign.csv").write_text("t,i,pot\n0,1,0\n10,1,0.5\n20,1,0.6\n")
    (tmp_path / "native.csv").write_text(HEADER.replace("rad", "V") + ROWS)
    assert flexarm("compare", tmp_path / "foreign.csv", "--arm", tmp_path / "arm.toml") == 0
    assert identify.log[0][2][0].signals["arm_angle"].tolist() == [0.0, -1.0, -1.2]
    assert identify.log[0][2][0].time[1] == pytest.approx(0.01)
    assert flexarm("compare", tmp_path / "native.csv", "--arm", tmp_path / "arm.toml") == 0
    assert identify.log[1][2][0].signals["arm_angle"].tolist() == [0.0, 0.2, 0.4]


def test_effects_shows_the_catalogue_and_each_page(flexarm):
    assert flexarm("effects") == 0
    for name in catalogue():
        assert name in flexarm.out
    for name, effect in catalogue().items():
        assert flexarm("effects", name) == 0
        shown = " ".join(flexarm.out.split())
        assert all(key in shown for key in effect.parameters)
        assert " ".join(effect.looks_like.split())[:40] in shown


@needs_plots
def test_reports_are_whole_pages_without_a_network(flexarm, identify, runs, tmp_path):
    for command in ("compare", "diagnose"):
        page = tmp_path / f"{command}.html"
        assert flexarm(command, runs, "--report", page) == 0
        text = page.read_text()
        assert text.rstrip().endswith("</html>")
        assert text.count("<script src=") == 0
        assert "Recording square" in text
        assert text.count("Plotly.newPlot(") >= 2


def test_a_missing_library_for_pictures_is_one_line(flexarm, identify, runs, tmp_path, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    assert "flexarm-env[plots]" in flexarm.refused("compare", runs, "--report", tmp_path / "r.html")
    assert "flexarm-env[plots]" in flexarm.refused("demo", "--output", tmp_path)


@needs_plots
def test_the_demo_draws_its_pictures(flexarm, identify, tmp_path):
    assert flexarm("demo", "--output", tmp_path / "demo") == 0
    made = {p.name for p in (tmp_path / "demo").iterdir()}
    assert {"loop.png", "loop.svg", "overlay.png", "waterfall.svg", "report.html", "demo.json"} <= made
    assert "0.06 rad" in flexarm.out
    (tmp_path / "file").write_text("")
    flexarm.refused("demo", "--output", tmp_path / "file")


def test_bench_says_where_it_is(flexarm, monkeypatch):
    from flexarm_env.cli import work

    monkeypatch.setattr(work, "__file__", "/nowhere/flexarm_env/cli/work.py")
    assert "source tree" in flexarm.refused("bench")


# The process


def process(*arguments, **changes) -> subprocess.CompletedProcess[str]:
    program = "from flexarm_env.cli import main; main()"
    environment = os.environ | {"PYTHONPATH": str(Path(flexarm_env.__file__).parents[1])} | changes
    command = [sys.executable, "-c", program, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, env=environment, check=False)


def test_help_is_light():
    program = "import sys; from flexarm_env.cli import run; run(['--help']); print(*sorted(sys.modules))"
    environment = os.environ | {"PYTHONPATH": str(Path(flexarm_env.__file__).parents[1])}
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True, env=environment)
    modules = set(run.stdout.split())
    assert modules & {"numpy", "numba", "scipy", "pint", "plotly", "matplotlib", "pandas", "gymnasium"} == set()
    assert "diagnose" in run.stdout


def test_the_command_s_exit_codes_reach_the_shell():
    assert process("--version").stdout == f"flexarm {flexarm_env.__version__}\n"
    assert process().returncode == 0
    bad = process("compare", "no.csv")
    assert (bad.returncode, bad.stdout, len(bad.stderr.splitlines())) == (2, "", 1)
    plain = process("effects", "backlash", PYTHONIOENCODING="ascii", LC_ALL="C")
    assert plain.returncode == 0, plain.stderr


def test_a_reader_that_leaves_early_is_no_error():
    program = "from flexarm_env.cli import main; main()"
    command = f"{sys.executable} -c '{program}' effects | head -1"
    environment = os.environ | {"PYTHONPATH": str(Path(flexarm_env.__file__).parents[1])}
    run = subprocess.run(command, shell=True, capture_output=True, text=True, env=environment, check=False)
    assert run.stderr == ""


# Numbers for a person


@pytest.mark.parametrize(
    ("value", "half", "text"),
    [
        (0.061234, 0.003, "0.0612"),
        (0.061234, 0.00031, "0.06123"),
        (7.911324, 0.02, "7.911"),
        (123456.0, 2000.0, "123456"),
        (1.0, 5.0, "1.0"),
        (0.0, 0.1, "0"),
        (2.5e-7, 1e-8, "2.50e-07"),
        (float("nan"), 1.0, "–"),
        (0.5, float("inf"), "0.5000"),
    ],
)
def test_a_value_has_the_digits_that_its_interval_leaves(value, half, text):
    assert words.rounded(value, value - half, value + half) == text


def test_steps_name_each_effect_once():
    error = {"nominal": 4.0, "refitted": 3.0, "backlash": 2.0, "stribeck": 1.0, "final": 1.0}
    names = [name for name, _ in words.steps_of(error, ["backlash", "stribeck"])]
    assert names == ["as given", "constants refitted", "+ backlash", "+ stribeck"]
    assert [v for _, v in words.steps_of({"nominal": 4.0, "refitted": 3.0, "final": 3.0})] == [4.0, 3.0]
    assert words.arrows({"nominal": 4.0, "refitted": 3.0, "final": 1.0}, ["backlash"]) == "4.00 → 3.00 → 1.00"
