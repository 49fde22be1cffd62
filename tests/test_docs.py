"""The documentation does what it says: every command and every snippet runs, and what it names is there."""

from __future__ import annotations

import contextlib
import csv
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
import tomllib
import urllib.error
import urllib.request
from pathlib import Path

import pytest
from documents import BLOCK, DOCUMENTS, PROJECT, README, Block, blocks_of, name_of

LINK = re.compile(r"!?\[[^\]]*\]\(([^)#]*)(?:#([^)]*))?\)")
#: A path from the root of the project, and one within identify, as the page on `diagnose` and its figure write it.
PATH = re.compile(r"(?<![\w/.-])(?:flexarm_env|tests|docs|benchmarks|agents|configs)/[\w./-]*\w")
WITHIN_IDENTIFY = re.compile(r"(?<![\w/.-])(?:replay|inspect|calibrate|select|explain)/\w+\.py|(?<=[`>])\w+\.py(?=[`,])")
#: What in a block needs the extra train.
TRAINS = re.compile(r"stable_baselines3|agents\.(?:dataset|learning|train)\b")
TIME_LIMIT = 900
SERVES = "flexarm lab"


def has_slow(document: Path) -> bool:
    return any(block.slow for block in blocks_of(document))


every_document = pytest.mark.parametrize("document", DOCUMENTS, ids=name_of)


# What the documents say is run


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """An empty folder beside which the command flexarm is found, whether the package is installed or not."""
    command = tmp_path / "bin" / "flexarm"
    command.parent.mkdir()
    program = "from flexarm_env.cli import main; main()"
    command.write_text(f"#!/bin/sh\nexec '{sys.executable}' -c '{program}' \"$@\"\n")
    command.chmod(0o755)
    folder = tmp_path / "work"
    folder.mkdir()
    return folder


def environment(folder: Path) -> dict[str, str]:
    path = os.pathsep.join([str(folder.parent / "bin"), str(Path(sys.executable).parent), os.environ["PATH"]])
    threads = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MPLBACKEND": "Agg", "PYTHONUTF8": "1"}
    paths = os.pathsep.join(filter(None, [str(PROJECT), os.environ.get("PYTHONPATH")]))
    return {**os.environ, **threads, "PATH": path, "PYTHONPATH": paths}


def call(document: Path, block: Block, folder: Path, arguments: list[str]) -> None:
    run = subprocess.run(
        arguments, cwd=folder, env=environment(folder), capture_output=True, text=True, timeout=TIME_LIMIT, check=False
    )
    where = f"{name_of(document)}, line {block.line}"
    assert run.returncode == 0, f"{where}: exit code {run.returncode}\n{block.text}\n{run.stdout}{run.stderr}"


def run_block(document: Path, block: Block, folder: Path) -> None:
    if block.file:
        (folder / block.file).write_text(block.text, encoding="utf-8")
    if block.language == "bash":
        made = [line for line in block.text.splitlines() if line.startswith("make ")]
        served = [line for line in block.text.splitlines() if line.startswith(SERVES)]
        rest = "\n".join(line for line in block.text.splitlines() if line not in [*made, *served])
        for line in made:  # what a target runs is tested elsewhere; here, that there is one
            call(document, block, folder, ["make", "-n", "-C", str(PROJECT), *line.split()[1:]])
        for line in served:
            serve(document, block, folder, line)
        if rest.strip():
            call(document, block, folder, ["bash", "-euc", rest])
    elif block.language == "python" and not block.file:
        script = folder.parent / "snippet.py"
        script.write_text(block.text, encoding="utf-8")
        call(document, block, folder, [sys.executable, str(script)])


def serve(document: Path, block: Block, folder: Path, line: str) -> None:
    """Run a command that serves for ever until it answers, then end it with Ctrl-C."""
    where = f"{name_of(document)}, line {block.line}"
    command = [*shlex.split(line), "--no-show", "--port", "0"]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen(command, cwd=folder, env=environment(folder), text=True, **pipes) as process:
        try:
            said = process.stdout.readline()
            assert "http://" in said, f"{where}: {said}{process.stderr.read()}"
            address = re.search(r"http://\S+", said)[0]
            for _ in range(600):
                with contextlib.suppress(urllib.error.URLError), urllib.request.urlopen(address) as answer:
                    assert answer.status == 200, where
                    break
                time.sleep(0.1)
            else:
                pytest.fail(f"{where}: nothing answers at {address}")
            process.send_signal(signal.SIGINT)
            assert process.wait(60.0) == 0, f"{where}: {process.stderr.read()}"
        finally:
            process.kill()


def recordings_of_the_demo(folder: Path) -> None:
    """The folder of recordings that README.md takes for granted."""
    (folder / "runs").mkdir()
    for file in (PROJECT / "flexarm_env" / "demo").glob("*.csv"):
        shutil.copy(file, folder / "runs")


def recordings_of_the_bench(folder: Path) -> None:
    """Recordings of the arm of docs/your-arm.md with Coulomb friction, as its data logger writes them."""
    from flexarm_env.arm import Arm
    from flexarm_env.experiments.simulate import simulate

    document = PROJECT / "docs" / "your-arm.md"
    block = next(block for block in blocks_of(document) if block.file == "bench.toml")
    (folder / block.file).write_text(block.text, encoding="utf-8")
    arm = Arm.load(folder / block.file).with_effect("coulomb", torque=0.1)
    (folder / "runs").mkdir()
    for seed, name in enumerate(("monday", "tuesday")):
        made = simulate(arm, "pulse", duration=8.0, rate=250.0, seed=seed)
        angle, strain = made.signals["arm_angle"], made.signals["strain_base"]
        columns = {"t": made.time * 1e3, "I": made.command * 1e3, "encoder": -angle * 57.29577951, "gage": strain * 1e3}
        with (folder / "runs" / f"{name}.csv").open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, delimiter=";")
            writer.writerow(columns)
            writer.writerows([f"{x:.6f}".replace(".", ",") for x in row] for row in zip(*columns.values(), strict=True))


PREPARE = {
    "README.md": recordings_of_the_demo,
    "docs/lab.md": recordings_of_the_demo,
    "docs/your-arm.md": recordings_of_the_bench,
}


def prepare(document: Path, folder: Path, blocks: list[Block]) -> None:
    if any(TRAINS.search(block.text) for block in blocks):
        pytest.importorskip("stable_baselines3")
    PREPARE.get(name_of(document), lambda folder: None)(folder)


@every_document
def test_commands_and_snippets_run(document, place):
    blocks = [block for block in blocks_of(document) if not block.slow]
    prepare(document, place, blocks)
    for block in blocks:
        run_block(document, block, place)


@pytest.mark.slow(minutes=3)
@pytest.mark.parametrize("document", [d for d in DOCUMENTS if has_slow(d)], ids=name_of)
def test_slow_commands_and_snippets_run(document, place):
    blocks = blocks_of(document)
    prepare(document, place, blocks)
    for block in blocks:
        run_block(document, block, place)


@every_document
def test_every_block_is_one_that_is_run_or_read(document):
    text = document.read_text(encoding="utf-8")
    assert len(re.findall("^```", text, re.MULTILINE)) == 2 * len(blocks_of(document))
    for block in blocks_of(document):
        assert block.language in ("bash", "python", "toml"), f"line {block.line}"
        if block.language == "toml":
            tomllib.loads(block.text)


# What they name is there


def anchors(document: Path) -> set[str]:
    heads = re.findall(r"^#+ (.*)$", BLOCK.sub("", document.read_text(encoding="utf-8")), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}


@every_document
def test_links_lead_somewhere(document):
    for target, anchor in LINK.findall(document.read_text(encoding="utf-8")):
        file = (document.parent / target).resolve() if target else document
        assert file.is_file(), f"{target} is not there; `make demo` makes results/demo"
        assert not anchor or anchor in anchors(file), f"{target} has no heading #{anchor}"


@every_document
def test_paths_are_there(document):
    written = {block.file for block in blocks_of(document) if block.file}
    for path in PATH.findall(document.read_text(encoding="utf-8")):
        assert Path(path).name in written or (PROJECT / path).exists(), path


@pytest.mark.parametrize("name", ["how-diagnose-works.md", "how-diagnose-works.svg"])
def test_modules_of_identify_are_there(name):
    paths = WITHIN_IDENTIFY.findall((PROJECT / "docs" / name).read_text(encoding="utf-8"))
    assert len(paths) > 5
    for path in paths:
        assert (PROJECT / "flexarm_env" / "identify" / path).is_file(), path


@every_document
def test_no_path_of_one_machine(document):
    assert not re.search(r"(^|[\s`\"'(])/(tmp|home|work|root|usr|Users)/", document.read_text(encoding="utf-8"))


def column(heading: str) -> list[str]:
    """First cells of the table under a heading of README.md, without quotes of code."""
    section = README.read_text(encoding="utf-8").split(f"\n## {heading}\n")[1].split("\n## ")[0]
    return re.findall(r"^\| `([^`]+)`", section, re.MULTILINE)


def test_readme_names_every_command():
    from flexarm_env.cli.app import app

    known = {command.name or command.callback.__name__ for command in app.registered_commands}
    if not (PROJECT / "benchmarks" / "__main__.py").is_file():
        known -= {"bench"}
    assert {line.split()[1] for line in column("Commands")} == known


def test_readme_names_every_shipped_arm():
    from flexarm_env.arm_file import shipped_arms

    assert set(column("Arms")) == set(shipped_arms())


def test_environments_describes_tasks_as_they_are():
    from flexarm_env.tasks import TASKS

    rows = {f"| `FlexArm/{task.title}-v0` | {task.summary} | {task.duration:g} s |" for task in TASKS.values()}
    text = (PROJECT / "docs" / "environments.md").read_text(encoding="utf-8")
    written = re.findall(r"^\| `FlexArm/.*$", text, re.MULTILINE)
    assert len(written) >= 3
    assert set(written) <= rows


def test_readme_is_short():
    assert len(README.read_text(encoding="utf-8").splitlines()) <= 160


def test_an_effect_of_one_s_own_takes_under_forty_lines():
    (block,) = [b for b in blocks_of(PROJECT / "docs" / "your-effect.md") if b.file]
    assert len(block.text.splitlines()) < 40


def test_your_arm_names_every_verdict():
    from flexarm_env.pictures import words

    text = (PROJECT / "docs" / "your-arm.md").read_text(encoding="utf-8").split("## Verdicts")[1]
    named = set(re.findall(r"^\| `([a-z_]+)`", text, re.MULTILINE))
    source = Path(words.__file__).read_text(encoding="utf-8")
    assert named == set(re.findall(r'diagnosis\.verdict == "(\w+)"', source)) | {"effects"}
