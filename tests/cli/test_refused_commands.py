"""Commands that are refused or fail: one line each, and the exit code that says which."""

from __future__ import annotations

import os

import numpy as np
import pytest
from cli_stand_ins import GOOD_ARM, HEADER, OWN, ROWS

import flexarm_env
from flexarm_env import arm_file
from flexarm_env.arm import Arm
from flexarm_env.errors import InputError

MAP = """
[columns]
time = {index = 0, unit = 's'}
current = {index = 1, unit = 'A'}
arm_angle = {index = 2, unit = 'rad'}
"""
SIZE = '{"size": Parameter("N*m/rad", 0.0, 1.0, 0.1, null=0.0)}'
PORT = """    @staticmethod
    def torque(angle, size):
        return -size * angle
"""
WHOLE = f"""
import math
from flexarm_env.effects import Effect
from flexarm_env.parameters import Parameter


class Mine(Effect):
    name = "mine"
    equation = "τ = -k θ"
    parameters = {SIZE}
    looks_like = "a spring"

{PORT}"""


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


@pytest.mark.parametrize(
    ("arguments", "allowed"),
    [
        (["compare", "x.csv", "--rate", "abc"], "valid"),
        (["simulate", "--save", "x.csv", "--duration", "long"], "valid"),
        (["diagnose", "x.csv", "--jobs", "0"], "1"),
        (["diagnose", "x.csv", "--jobs", "257"], "256"),
        (["diagnose", "x.csv", "--jobs", "1.5"], "valid"),
        (["fit", "x.csv", "--seed", "-1"], "0"),
    ],
)
def test_a_number_that_is_refused_is_named_beside_what_is_allowed(flexarm, arguments, allowed):
    option, came = arguments[-2:]
    _, _, words = flexarm.refused(*arguments).partition(f"invalid value for '{option}': ")
    assert words.lstrip("'").startswith(came)
    assert allowed in words.partition(came)[2].partition("(see")[0]


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


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_pipes_are_refused_and_not_waited_for(flexarm, runs, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "arm.toml").write_text(GOOD_ARM + MAP)
    for words in (
        ["compare", tmp_path / "pipe", "--arm", tmp_path / "arm.toml"],
        ["compare", runs, "--columns", tmp_path / "pipe"],
        ["effects", "coulomb", "--json", tmp_path / "pipe"],
    ):
        assert "regular file" in flexarm.refused(*words)
    assert "neither a file" in flexarm.refused("compare", runs, "--arm", tmp_path / "pipe")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("import math", "import sys\nsys.exit(0)", "SystemExit"),
        ('name = "mine"', 'name = "my-effect"', "letters, digits and _"),
        ('name = "mine"', "name = 5", "letters, digits and _"),
        (SIZE, "{}", "one Parameter at least"),
        (SIZE, '{"size": 0.1}', "write Parameter"),
        (SIZE, SIZE.replace("N*m/rad", "furlungs"), "unknown unit 'furlungs'"),
        ("def torque(angle, size)", "def torque(hub_angle, size)", "did you mean 'angle'"),
        (PORT, "    torque = lambda angle, size: 0.0", "def"),
        ('"a spring"', '"a spring"\n    confused_with = "backlash"', "a tuple of other effects' names"),
        ('"a spring"', '"a spring"\n    confused_with = ("mine",)', "a tuple of other effects' names"),
    ],
)
def test_an_effect_that_is_not_whole_is_refused(flexarm, runs, tmp_path, old, new, words):
    assert old in WHOLE
    (tmp_path / "mine.py").write_text(WHOLE.replace(old, new))
    assert words in flexarm.refused("compare", runs, "--effects", f"{tmp_path / 'mine.py'}:Mine")


@pytest.mark.parametrize("base", ["BaseException", "SystemExit", "GeneratorExit", "RecursionError"])
def test_whatever_a_file_of_effects_raises_is_one_line(flexarm, runs, tmp_path, base):
    (tmp_path / "mine.py").write_text(f"class Odd({base}): pass\nraise Odd('why')\n")
    for words in (["compare", runs, "--effects"], ["effects"]):
        assert "mine.py does not load: Odd: why" in flexarm.refused(*words, f"{tmp_path / 'mine.py'}:Mine")


def test_ctrl_c_while_a_file_of_effects_runs_stops_the_command(flexarm, runs, tmp_path):
    (tmp_path / "mine.py").write_text("raise KeyboardInterrupt\n")
    assert flexarm("compare", runs, "--effects", f"{tmp_path / 'mine.py'}:Mine") == 130
    assert flexarm.err == "flexarm: stopped\n"


def test_an_effect_without_a_docstring_has_a_page(flexarm, tmp_path):
    (tmp_path / "mine.py").write_text(WHOLE)
    assert flexarm("effects", f"{tmp_path / 'mine.py'}:Mine") == 0
    assert "Mine" in flexarm.out


NO_EFFECTS = """
from flexarm_env.effects import Effect
number = 5
class Other: pass
class Bare(Effect): pass
"""


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("Nope", "has no effect 'Nope'"),
        ("", "has no effect ''"),
        ("Other", "'Other' is no effect; write class Other(Effect)"),
        ("number", "'number' is no effect"),
        ("Effect", "'Effect' is no effect"),
        ("Bare", "effect Bare lacks 'name'"),
    ],
)
def test_a_class_that_is_no_effect_is_refused_wherever_one_is_named(flexarm, runs, tmp_path, name, words):
    (tmp_path / "mine.py").write_text(NO_EFFECTS)
    spec = f"{tmp_path / 'mine.py'}:{name}"
    named = ("--effects", spec)
    places = [
        ("effects", spec),
        ("add", spec, runs),
        ("compare", runs, *named),
        ("diagnose", runs, *named),
        ("inspect", runs, *named),
    ]
    places += [("fit", runs, *named), ("simulate", "--save", tmp_path / "x.csv", *named), ("tune", "lqg", *named)]
    for arguments in places:
        assert words in flexarm.refused(*arguments), arguments


def test_a_file_of_effects_without_a_class_is_no_name_of_the_catalogue(flexarm, runs, tmp_path):
    file = tmp_path / "mine.py"
    file.write_text(OWN)
    for arguments in (("effects", file), ("add", file, runs), ("compare", runs, "--effects", file)):
        assert "write FILE.py:Name" in flexarm.refused(*arguments)
    with pytest.raises(InputError, match="is of a file, which is not loaded here"):
        Arm.load("thesis").with_effect(f"{file}:Mine", size=0.1)


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


@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (InputError("the recordings\nare too short"), 2, r"the recordings\nare too short"),
        (KeyboardInterrupt(), 130, "stopped"),
        (OSError(28, "No space left on device", "x.csv"), 2, "No space left"),
        (np.linalg.LinAlgError("Singular matrix"), 2, "fault of the program"),
        (BaseException("odd"), 2, "fault of the program"),
    ],
)
def test_whatever_goes_wrong_is_one_line(flexarm, identify, runs, monkeypatch, error, code, words):
    def fail(*args, **kwargs):
        raise error

    monkeypatch.setitem(vars(flexarm_env), "compare", fail)
    assert flexarm("compare", runs) == code
    assert len(flexarm.err.splitlines()) == 1
    assert words in flexarm.err
