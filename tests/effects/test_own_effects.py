"""An effect of one's own, in a file: it joins the catalogue, or is refused by what it lacks."""

from __future__ import annotations

import importlib
import subprocess
import sys
from dataclasses import replace

import cloudpickle
import pytest
from soft_stop import soft_stop

from flexarm_env.arm import Arm
from flexarm_env.effects import catalogue
from flexarm_env.effects.catalogue import load_effect
from flexarm_env.errors import InputError
from flexarm_env.experiments.simulate import simulate

OWN = '''
from flexarm_env.effects import Effect
from flexarm_env.effects.base import torque_size


class Spring(Effect):
    """A spring that hardens."""

    name = "hard_spring"
    equation = "T = -k angle**3"
    parameters = {"stiffness": torque_size("k", 0.1)}
    looks_like = "it pulls back, the more the further"

    @staticmethod
    def torque(angle, stiffness):
        return -stiffness * angle**3
'''


def test_an_effect_of_one_s_own_joins_the_catalogue(tmp_path):
    known = catalogue().extended(soft_stop(tmp_path))
    assert "soft_stop" in known
    assert "soft_stop" not in catalogue()
    mine = replace(Arm.load("thesis-fem"), known=known)
    runs = [simulate(a, "pulse", duration=2.0, noise=False) for a in (mine, mine.with_effect("soft_stop"))]
    ends = [run.signals["arm_angle"][-1] for run in runs]
    assert ends[1] < ends[0] - 0.1
    # Its module is the file: the catalogue's own files are named as their effects are.
    assert importlib.import_module("flexarm_env.effects.coulomb").Coulomb is catalogue()["coulomb"]


def test_an_effect_of_one_s_own_is_composed_where_it_is_unpickled(tmp_path):
    file = tmp_path / "mine.py"
    file.write_text(OWN)
    pickled = tmp_path / "laws"
    pickled.write_bytes(cloudpickle.dumps(catalogue().extended(load_effect(f"{file}:Spring")).laws))
    program = (
        "import pickle, sys; from pathlib import Path; from flexarm_env.plant.compose import source_of;"
        "print(source_of(pickle.loads(Path(sys.argv[1]).read_bytes())))"
    )
    made = subprocess.run([sys.executable, "-c", program, str(pickled)], capture_output=True, text=True, check=True)
    assert "return -stiffness * angle**3" in made.stdout


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('    equation = "T = -k angle**3"\n', "", "effect Spring lacks 'equation'"),
        ('    looks_like = "it pulls back, the more the further"\n', "", "effect Spring lacks 'looks_like'"),
        ('    parameters = {"stiffness": torque_size("k", 0.1)}\n', "", "effect Spring lacks 'parameters'"),
        ('{"stiffness": torque_size("k", 0.1)}', '[("stiffness", 0.1)]', r"parameters is \[.*; give a dict"),
        ("def torque", "def force", "effect Spring has no port: give it one of structure, friction"),
        ("(angle, stiffness)", "(structure, stiffness)", "torque takes 'structure'"),
        (
            "def torque(angle, stiffness)",
            "def structure(structure, stifness)",
            "structure takes 'stifness'; did you mean 'stiffness'",
        ),
        ("    @staticmethod\n", "    @classmethod\n", "torque is no function of its own; write it with @staticmethod"),
        ("return -stiffness", "return return", "does not load: SyntaxError"),
    ],
)
def test_an_effect_of_one_s_own_that_is_not_whole_is_refused(tmp_path, old, new, words):
    assert old in OWN
    file = tmp_path / "mine.py"
    file.write_text(OWN.replace(old, new))
    with pytest.raises(InputError, match=words):
        load_effect(f"{file}:Spring")


def test_an_effect_in_a_file_that_is_no_program_is_refused(tmp_path):
    file = tmp_path / "mine.txt"
    file.write_text(OWN)
    for spec, words in (
        (f"{file}:Spring", "is no Python file"),
        (f"{tmp_path}:Spring", "no effect in"),
        (str(file), "no effect in"),
    ):
        with pytest.raises(InputError, match=words):
            load_effect(spec)


def test_a_phase_that_is_no_parameter_is_refused(tmp_path):
    file = tmp_path / "mine.py"
    file.write_text(OWN.replace("    looks_like", '    scan_phase = "stifness"\n    looks_like'))
    with pytest.raises(InputError, match="scan_phase is 'stifness'; did you mean 'stiffness'"):
        load_effect(f"{file}:Spring")
