"""The work behind the commands: call the identification with a progress bar, hand out the result."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.console import RenderableType
from rich.text import Text

import flexarm_env
from flexarm_env.arm import Arm
from flexarm_env.cli import outputs, tables
from flexarm_env.cli.progress import progress
from flexarm_env.effects.catalogue import load_effect
from flexarm_env.errors import InputError
from flexarm_env.identify.recording import Recording
from flexarm_env.pictures import words

if TYPE_CHECKING:
    from flexarm_env.identify.results import Addition, Comparison, Diagnosis, Fit


def compare(arm: Arm, recordings: Sequence[Recording]) -> Comparison:
    """Compare, with a progress bar."""
    with progress("comparing") as bar:
        return flexarm_env.compare(arm, list(recordings), progress=bar)


def fit(arm: Arm, recordings: Sequence[Recording], seed: int) -> Fit:
    """Refit the constants, with a progress bar."""
    with progress("fitting") as bar:
        return flexarm_env.fit(arm, list(recordings), progress=bar, seed=seed)


def add(effect: str, arm: Arm, recordings: Sequence[Recording], seed: int) -> Addition:
    """Add an effect, with a progress bar."""
    arm.with_effect(effect)  # refuses what cannot be added before a bar shows
    with progress(f"adding {effect}") as bar:
        return flexarm_env.add(effect, arm, list(recordings), progress=bar, seed=seed)


def diagnose(arm: Arm, recordings: Sequence[Recording], seed: int, jobs: int) -> Diagnosis:
    """Diagnose, with a progress bar."""
    with progress("diagnosing") as bar:
        return flexarm_env.diagnose(arm, list(recordings), progress=bar, seed=seed, jobs=jobs)


def own_name(spec: str) -> str:
    """Return the catalogue name of the effect in "FILE.py:Name"."""
    return load_effect(spec).name


def finish(
    command: str,
    arm: str,
    recordings: Sequence[Recording],
    seed: int | None,
    json: Path | None,
    content: dict[str, Any],
    parts: Sequence[RenderableType],
) -> None:
    """Print tables, to stderr if stdout is for JSON, and write the JSON with its provenance."""
    tables.show(tables.console(to_stderr=json == outputs.STDOUT), *parts)
    if json is not None:
        outputs.write_json(json, content | outputs.provenance(command, arm, recordings, seed))


def comparison_json(result: Comparison) -> dict[str, Any]:
    """Plain data of a comparison, without its curves."""
    return {
        "error": result.error,
        "free_run": result.free_run,
        "noise": result.noise,
        "rows": [vars(row) for row in result.rows],
        "notes": result.notes,
    }


def fit_json(result: Fit) -> dict[str, Any]:
    """Plain data of a fit."""
    return {
        "error": result.error,
        "free_run": result.free_run,
        "constants": {words.constant_name(e): e.as_json() for e in result.estimates},
        "seconds": round(result.seconds, 1),
    }


def addition_json(result: Addition) -> dict[str, Any]:
    """Plain data of an added effect."""
    prefix = f"effects.{result.effect}."
    own = [e for e in result.estimates if e.path.startswith(prefix)]
    others = [e for e in result.estimates if not e.path.startswith(prefix)]
    return {
        "effect": result.effect,
        "parameters": {e.path.removeprefix(prefix): e.as_json() for e in own},
        "error": result.error,
        "free_run": result.free_run,
        "constants": {words.constant_name(e): e.as_json() for e in others},
        "seconds": round(result.seconds, 1),
    }


def report(
    path: Path, recordings: Sequence[Recording], before: Comparison, diagnosis: Diagnosis | None, made: Mapping[str, Any]
) -> None:
    """Write the page, with a progress bar."""
    from flexarm_env.cli.report import write_report

    with progress("writing the report") as bar:
        write_report(path, recordings, before, diagnosis, made, bar)


def simulate(
    arm: Arm,
    name: str,
    source: str,
    settings: tuple[float, float, int, bool],
    columns: Path | None,
    save: Path,
    json: Path | None,
) -> None:
    """Make a recording and write it; `settings` are duration [s], rate [Hz], seed and whether there is noise."""
    from flexarm_env.cli.inputs import read_recordings
    from flexarm_env.identify.simulate import EXPERIMENTS

    played: str | Recording = source
    if source and source not in EXPERIMENTS and Path(source).exists():
        found = read_recordings(arm, [Path(source)], columns, measured=False)
        if len(found) != 1:
            raise InputError(f"{source}: holds {len(found)} recordings; name one")
        played = found[0]
    with progress("simulating"):
        made = flexarm_env.simulate(arm, played, *settings)
    made.write(save)
    reach = {signal: [float(values.min()), float(values.max())] for signal, values in made.signals.items()}
    rows = [[words.label_of(s), *map(words.number, ends), words.unit_of(s)] for s, ends in reach.items()]
    count = f"{len(made)} samples, {made.duration:g} s at {1.0 / made.sample_time:.4g} Hz"
    content = {"input": source, "samples": len(made), "range": reach}
    parts: list[RenderableType] = [
        Text(f"{count}, from arm '{arm.name}'."),
        tables.table("Signals", ["signal", "from", "to", "unit"], rows),
    ]
    given = [played] if isinstance(played, Recording) else []
    finish("simulate", name, given, settings[2], json, content, parts)


def bench(arguments: Sequence[str]) -> int:
    """Run the benchmarks of a source tree; return their exit code."""
    root = Path(__file__).resolve().parents[2]
    if not (root / "benchmarks" / "__main__.py").is_file():
        raise InputError("the benchmarks come with the source tree, not with the installed package")
    return subprocess.run([sys.executable, "-m", "benchmarks", *arguments], cwd=root, check=False).returncode
