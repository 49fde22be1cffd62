"""How programs end that a shell starts: `flexarm`, `python -m agents.…` and `python -m benchmarks…`."""

from __future__ import annotations

import argparse
import contextlib
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from documents import PROJECT
from processes import LISTED, command_line, descendants, is_alive, wait_for

from flexarm_env.errors import InputError
from flexarm_env.terminal.program import LONGEST_LINE, Program

MODULES = sorted(
    ".".join(file.relative_to(PROJECT).with_suffix("").parts)
    for folder in ("agents", "benchmarks")
    for file in (PROJECT / folder).rglob("*.py")
    if '\nif __name__ == "__main__":' in file.read_text(encoding="utf-8")
)


def test_all_programs_are_found():
    assert {"agents.train", "agents.film", "benchmarks.__main__", "benchmarks.fuzz.__main__"} < set(MODULES)


@pytest.mark.parametrize("module", MODULES)
def test_ctrl_c_is_one_line_in_every_program(module, monkeypatch, capsys):
    def stop(parser: argparse.ArgumentParser, arguments: object = None) -> None:
        signal.raise_signal(signal.SIGINT)

    main = pytest.importorskip(module, exc_type=ImportError).main
    monkeypatch.setattr(argparse.ArgumentParser, "parse_args", stop)
    assert main([]) == 130
    out, err = capsys.readouterr()
    assert (out, err.strip().count("\n")) == ("", 0)
    assert err.strip().startswith("stopped")
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.parametrize("module", MODULES)
@pytest.mark.parametrize("arguments", [["--save", ""], ["--save="], ["--save", " "], [""]])
def test_an_empty_argument_is_refused_in_every_program(module, arguments, capsys):
    assert pytest.importorskip(module, exc_type=ImportError).main(arguments) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert ("argument 1 is empty" if arguments == [""] else "the value of --save is empty") in err


def swallow(error: type[Exception]) -> None:
    """Turn Ctrl-C into another error, as compiled code does that calls back."""
    try:
        signal.raise_signal(signal.SIGINT)
    except KeyboardInterrupt:
        raise error("no compiled object yet") from None


@pytest.mark.parametrize("error", [RuntimeError, ValueError, BrokenPipeError])
def test_ctrl_c_that_became_another_error_is_ctrl_c(error, capsys):
    assert Program("it").run(lambda arguments: swallow(error), []) == 130
    assert capsys.readouterr().err == "it: stopped\n"


def test_a_thread_that_ctrl_c_broke_off_is_silent(capsys):
    def stop(arguments):
        def end():
            raise KeyError("a task that is no longer there")

        try:
            signal.raise_signal(signal.SIGINT)
        finally:
            thread = threading.Thread(target=end)
            thread.start()
            thread.join()

    before = threading.excepthook
    assert Program("it").run(stop, []) == 130
    assert capsys.readouterr().err == "it: stopped\n"
    assert threading.excepthook is before


def test_a_line_stays_one_of_bounded_length(capsys):
    def fail(arguments):
        raise InputError(f"no arm '{100_000 * 'x'}\nthere\u202e'")

    assert Program("it").run(fail, []) == 2
    err = capsys.readouterr().err
    assert (err.count("\n"), len(err) <= LONGEST_LINE + 10) == (1, True)
    assert err.rstrip("\n").isprintable()


def test_an_error_without_ctrl_c_is_none(capsys):
    def fail(arguments):
        raise RuntimeError("no compiled object yet")

    assert Program("it").run(fail, []) == 2
    assert "a fault of the program" in capsys.readouterr().err


def test_a_second_termination_does_not_break_off_the_cleanup_of_the_first(capsys):
    cleaned = []

    def end(arguments):
        try:
            signal.raise_signal(signal.SIGTERM)
        finally:
            signal.raise_signal(signal.SIGTERM)
            cleaned.append(True)

    assert Program("it").run(end, []) == 143
    assert cleaned == [True]
    assert capsys.readouterr().err == "it: stopped\n"


def test_a_program_that_ignores_ctrl_c_goes_on_ignoring_it():
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        assert Program("it").run(lambda arguments: signal.raise_signal(signal.SIGINT), []) == 0
    finally:
        signal.signal(signal.SIGINT, before)


@LISTED
@pytest.mark.parametrize(
    ("number", "code", "module"),
    [
        pytest.param(signal.SIGINT, 130, "agents.evaluate", id="Ctrl-C"),
        pytest.param(signal.SIGTERM, 143, "agents.evaluate", id="terminated"),
        pytest.param(signal.SIGINT, 130, "agents.tune", id="Ctrl-C while modules are imported"),
    ],
)
def test_a_stopped_program_leaves_one_line_and_no_process(tmp_path, number, code, module):
    options = ["lqg"] if module == "agents.tune" else ["--jobs", "2"]
    environment = os.environ | {"PYTHONPATH": str(PROJECT), "JOBLIB_TEMP_FOLDER": str(tmp_path)}
    command = [sys.executable, "-m", module, *options, "--save", str(tmp_path / "results")]
    run = subprocess.Popen(
        command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, env=environment, cwd=PROJECT, start_new_session=True
    )

    def workers() -> list[int]:
        return [child for child in descendants(run.pid) if "LokyProcess" in command_line(child)]

    if module == "agents.tune":  # in the middle of its imports
        wait_for(lambda: "llvmlite" in libraries(run.pid), 60)
    else:
        wait_for(lambda: len(workers()) == 2 or run.poll() is not None, 120)
        assert len(workers()) == 2
    helpers = descendants(run.pid)
    reaches = os.killpg if number == signal.SIGINT else os.kill  # a terminal stops the whole group
    reaches(run.pid, number)
    _, errors = run.communicate(timeout=60)
    assert run.returncode == code
    assert errors.decode().strip().splitlines()[-1].startswith("stopped")
    assert "Traceback" not in errors.decode()
    wait_for(lambda: not any(map(is_alive, helpers)), 10)
    assert not [helper for helper in helpers if is_alive(helper)]


def test_a_stopped_program_ends_though_nobody_reads_what_it_still_says():
    reading, writing = os.pipe()
    os.set_blocking(writing, False)
    with contextlib.suppress(BlockingIOError):
        while True:
            os.write(writing, b" ")
    os.set_blocking(writing, True)
    said = "print('still in the buffer'); print(file=sys.stderr, flush=True); time.sleep(100)"
    imports = "import sys, time\nfrom flexarm_env.terminal.program import Program"
    program = f"{imports}\ndef main(_): {said}\nsys.exit(Program('it')(main)())"
    environment = os.environ | {"PYTHONPATH": str(PROJECT), "PYTHONUNBUFFERED": ""}
    with subprocess.Popen([sys.executable, "-c", program], stderr=subprocess.PIPE, stdout=writing, env=environment) as run:
        try:
            run.stderr.readline()
            run.send_signal(signal.SIGINT)
            _, errors = run.communicate(timeout=20)
        finally:
            run.kill()
            os.close(reading)
            os.close(writing)
    assert (run.returncode, errors.decode()) == (130, "it: stopped\n")


def libraries(process: int) -> str:
    """The libraries that a process has loaded."""
    return Path(f"/proc/{process}/maps").read_text()
