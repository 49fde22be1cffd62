"""Files of effects that are refused: one line each, whatever they hold."""

from __future__ import annotations

import pytest
from cli_stand_ins import OWN

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError

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
