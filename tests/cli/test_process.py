"""The command as a process: how heavy it is, and what reaches the shell."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from cli_stand_ins import GOOD_ARM

import flexarm_env
from flexarm_env.arm_file import shipped_arms


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
    # gymnasium, and numpy with it, is there: importing the package registers the environments
    assert modules & {"numba", "scipy", "pint", "plotly", "matplotlib", "pandas", "pygame"} == set()
    assert "diagnose" in run.stdout


def test_help_names_every_shipped_arm():
    text = " ".join(process("compare", "--help", COLUMNS="200").stdout.split())
    assert set(text.partition("a shipped arm: ")[2].partition(".")[0].split(", ")) == set(shipped_arms())


def test_the_command_s_exit_codes_reach_the_shell():
    assert process("--version").stdout == f"flexarm {flexarm_env.__version__}\n"
    assert process().returncode == 0
    bad = process("compare", "no.csv")
    assert (bad.returncode, bad.stdout, len(bad.stderr.splitlines())) == (2, "", 1)
    plain = process("effects", "backlash", PYTHONIOENCODING="ascii", LC_ALL="C")
    assert plain.returncode == 0, plain.stderr


def test_the_module_runs_as_the_command():
    run = subprocess.run([sys.executable, "-m", "flexarm_env.cli", "--version"], capture_output=True, text=True, check=False)
    assert (run.returncode, run.stdout) == (0, process("--version").stdout)


def test_a_reader_that_leaves_early_is_no_error():
    program = "from flexarm_env.cli import main; main()"
    command = f"{sys.executable} -c '{program}' effects | head -1"
    environment = os.environ | {"PYTHONPATH": str(Path(flexarm_env.__file__).parents[1])}
    run = subprocess.run(command, shell=True, capture_output=True, text=True, env=environment, check=False)
    assert run.stderr == ""


def test_a_reader_that_leaves_early_loses_no_file(tmp_path):
    arm = tmp_path / "m.toml"
    arm.write_text(GOOD_ARM)
    made = tmp_path / "made.csv"
    assert process("simulate", "--arm", arm, "--duration", "2", "--rate", "100", "--save", made).returncode == 0
    reader, writer = os.pipe()
    os.close(reader)
    program = "from flexarm_env.cli import main; main()"
    files = ["--save", tmp_path / "x.toml", "--json", tmp_path / "x.json"]
    command = [sys.executable, "-c", program, *map(str, ["fit", made, "--arm", arm, *files])]
    environment = os.environ | {"PYTHONPATH": str(Path(flexarm_env.__file__).parents[1])}
    run = subprocess.run(command, stdout=writer, stderr=subprocess.PIPE, text=True, env=environment, check=False)
    os.close(writer)
    assert run.returncode == 0, run.stderr
    assert (tmp_path / "x.toml").is_file()
    assert (tmp_path / "x.json").is_file()
