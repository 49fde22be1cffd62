"""What the commands make of the arguments that they share; what is slow to import is imported when it is needed."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from collections.abc import Sequence

    from flexarm_env.arm import Arm
    from flexarm_env.recordings.recording import Recording


def check(
    json: Path | None,
    *places: Path | None,
    read: Sequence[Path] = (),
    specs: Sequence[str] | None = None,
    pictures: bool = False,
) -> None:
    """Refuse places that cannot be written or that are read, and pictures without their packages."""
    from flexarm_env.cli import outputs

    files = [Path(spec.rpartition(":")[0]) for spec in specs or () if ":" in spec]
    outputs.check_places(json, *places, read=[*read, *files])
    if pictures:
        outputs.need_plots()


def read_by(recordings: Sequence[Path], columns: Path | None, arm: str, save: Path | None = None) -> list[Path]:
    """Return what a command reads and must not write; the arm's own file may be saved anew."""
    found = [*recordings, *([columns] if columns is not None else [])]
    return [*found, Path(arm)] if Path(arm).is_file() and save != Path(arm) else found


def command_line(
    name: str,
    recordings: Sequence[Path],
    arm: str,
    columns: Path | None,
    specs: Sequence[str] | None,
    seed: int | None = None,
) -> dict[str, str]:
    """Return the command line that does this again, for the report."""
    import shlex

    words = ["flexarm", name, *map(str, recordings), "--arm", arm]
    words += ["--columns", str(columns)] if columns is not None else []
    words += [word for spec in specs or () for word in ("--effects", spec)]
    words += ["--seed", str(seed)] if seed is not None else []
    return {"command_line": shlex.join(words)}


def load_arm(name: str, specs: Sequence[str] | None) -> Arm:
    """Return an arm that may have effects of the user's own."""
    from flexarm_env.arm import Arm
    from flexarm_env.cli import inputs

    return Arm.load(name, inputs.known_effects(specs or []))


def load(paths: list[Path], name: str, columns: Path | None, specs: Sequence[str] | None) -> tuple[Arm, list[Recording]]:
    """Return an arm, and recordings of it."""
    from flexarm_env.cli import inputs

    arm = load_arm(name, specs)
    recordings = inputs.read_recordings(arm, paths, columns)
    show_notes(recordings)
    return arm, recordings


def show_notes(recordings: Sequence[Recording]) -> None:
    """Say on stderr how files were read, where a person might expect otherwise."""
    for recording in recordings:
        for note in recording.notes:
            typer.echo(f"Note: {recording.source}: {note}", err=True)


def save_arm(arm: Arm, path: Path | None, hint: bool = False) -> None:
    """Save an arm, or say how to if asked for a hint."""
    if path is not None:
        arm.save(path)
    elif hint:
        typer.echo("Not saved; --save ARM.toml keeps the arm.", err=True)
