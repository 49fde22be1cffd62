"""The command as a process: how heavy it is, and what reaches the shell."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from cli_stand_ins import GOOD_ARM
from processes import LISTED, command_line, descendants, is_alive, wait_for

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


@pytest.mark.parametrize("closed", [">&-", "2>&-", ">&- 2>&-", "<&-"])
def test_a_closed_stream_is_no_error(tmp_path, closed):
    program = "from flexarm_env.cli import main; main()"
    command = f"{sys.executable} -c '{program}' effects backlash --json {tmp_path / 'x.json'} {closed}"
    environment = os.environ | {"PYTHONPATH": str(Path(flexarm_env.__file__).parents[1])}
    run = subprocess.run(command, shell=True, capture_output=True, text=True, env=environment, check=False)
    assert (run.returncode, run.stderr) == (0, "")
    assert "backlash" in (tmp_path / "x.json").read_text()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no /dev/full")
@pytest.mark.parametrize("arguments", ["effects", "--version", "--help"])
@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_a_full_stdout_is_one_line(arguments, unbuffered):
    program = "from flexarm_env.cli import main; main()"
    command = f"{sys.executable} -c '{program}' {arguments} >/dev/full"
    environment = os.environ | {"PYTHONPATH": str(Path(flexarm_env.__file__).parents[1]), "PYTHONUNBUFFERED": unbuffered}
    run = subprocess.run(command, shell=True, capture_output=True, text=True, env=environment, check=False)
    assert (run.returncode, len(run.stderr.splitlines())) == (2, 1)


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


@LISTED
@pytest.mark.parametrize(
    ("number", "code", "age"),
    [
        pytest.param(signal.SIGINT, 130, 0.0, id="Ctrl-C while its workers start"),
        pytest.param(signal.SIGTERM, 143, 0.0, id="terminated while its workers start"),
        pytest.param(signal.SIGINT, 130, 2.0, id="Ctrl-C", marks=pytest.mark.slow(minutes=1)),
        pytest.param(signal.SIGTERM, 143, 2.0, id="terminated", marks=pytest.mark.slow(minutes=1)),
    ],
)
def test_a_stopped_diagnosis_ends_at_once_and_leaves_nothing(tmp_path, number, code, age):
    made, shared = tmp_path / "made.csv", tmp_path / "shared"
    shared.mkdir()
    assert process("simulate", "--input", "square", "--duration", "6", "--save", made).returncode == 0
    environment = os.environ | {"PYTHONPATH": str(Path(flexarm_env.__file__).parents[1]), "JOBLIB_TEMP_FOLDER": str(shared)}
    answering = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)"  # a shell's background jobs ignore it
    program = f"{answering}; from flexarm_env.cli import main; main()"
    command = [sys.executable, "-c", program, "diagnose", str(made), "--jobs", "2"]
    run = subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, env=environment, start_new_session=True)

    def workers() -> list[int]:
        return [child for child in descendants(run.pid) if "LokyProcess" in command_line(child)]

    wait_for(lambda: len(workers()) == 2 or run.poll() is not None, 240)
    wait_for(lambda: run.poll() is not None, age)
    helpers = descendants(run.pid)
    assert len(workers()) == 2
    reaches = os.killpg if number == signal.SIGINT else os.kill  # a terminal stops the whole group
    reaches(run.pid, number)
    _, errors = run.communicate(timeout=60)
    assert (run.returncode, errors.decode()) == (code, "flexarm: stopped\n")
    wait_for(lambda: not any(map(is_alive, helpers)), 10)
    assert not [helper for helper in helpers if is_alive(helper)]
    assert list(shared.iterdir()) == []
    assert not list(Path("/dev/shm").glob(f"sem.loky-{run.pid}-*"))
