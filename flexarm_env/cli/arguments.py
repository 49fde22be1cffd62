"""The arguments that commands share, checked and turned into an arm and its recordings. Slow imports wait until needed."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from flexarm_env.arm_file import arm_path

if TYPE_CHECKING:
    from collections.abc import Sequence

    from flexarm_env.arm import Arm
    from flexarm_env.recordings.recording import Recording


def check(
    json: Path | None,
    *places: Path | None,
    read: Sequence[Path] = (),
    recording: Path | None = None,
    specs: Sequence[str] | None = None,
    pictures: bool = False,
) -> None:
    """Refuse places that cannot be written or that are read, and pictures without their packages.

    Args:
        json: for the JSON.
        places: for other files.
        read: files and folders that must not be written over.
        recording: for a recording.
        specs: effects of the user's own, as "FILE.py:Name", whose files are read.
        pictures: whether the command draws some.

    Raises:
        InputError: for such a place, and where a package is missing.
    """
    from flexarm_env.terminal import outputs

    files = [Path(spec.rpartition(":")[0]) for spec in specs or () if ":" in spec]
    outputs.check_places(json, *places, recording, read=[*read, *files])
    outputs.check_suffixes(json, *places, recording=recording)
    if pictures:
        outputs.need_plots()


@dataclass(frozen=True)
class Given:
    """The arm and the recordings that a command names.

    Attributes:
        recordings: files and folders.
        arm: a file, or the name of a shipped arm.
        columns: a file with a column map.
        effects: effects of the user's own, as "FILE.py:Name".
    """

    recordings: Sequence[Path]
    arm: str
    columns: Path | None
    effects: Sequence[str] | None

    def files(self, save: Path | None = None) -> list[Path]:
        """List the files that are read and must not be written; an arm's own file, but no shipped one, may be saved anew."""
        found = [*self.recordings, *([self.columns] if self.columns is not None else [])]
        return found if save == Path(self.arm) else [*found, *arm_files(self.arm)]

    def load(
        self, json: Path | None, report: Path | None = None, save: Path | None = None, next_run: Path | None = None
    ) -> tuple[Arm, list[Recording]]:
        """Check where the command writes, then read the arm and its recordings.

        Args:
            json: for the JSON.
            report: for the page.
            save: for the arm.
            next_run: for the input to record next.

        Raises:
            InputError: for a place that cannot be written, and for an arm or recordings that cannot be read.
        """
        from flexarm_env.terminal import inputs, outputs

        pictures = report is not None
        check(json, report, save, read=self.files(save), recording=next_run, specs=self.effects, pictures=pictures)
        arm = load_arm(self.arm, self.effects)
        outputs.check_places(json, report, save, next_run, read=inputs.files_read(arm, self.recordings, self.columns))
        return arm, self._recordings(arm)

    def read(self) -> tuple[Arm, list[Recording]]:
        """Read the arm and its recordings, of which there may be none."""
        arm = load_arm(self.arm, self.effects)
        return arm, self._recordings(arm) if self.recordings else []

    def _recordings(self, arm: Arm) -> list[Recording]:
        from flexarm_env.terminal import inputs

        recordings = inputs.read_recordings(arm, self.recordings, self.columns)
        show_notes(recordings)
        return recordings

    def command_line(self, name: str, seed: int | None = None, rate: float | None = None) -> dict[str, str]:
        """Write the command line that does this again, for the report."""
        from flexarm_env.terminal.provenance import command_line

        return {"command_line": command_line(name, self.recordings, self.arm, self.columns, self.effects or (), seed, rate)}


def required(recordings: Sequence[Path] | None, command: str) -> Sequence[Path]:
    """Refuse a command without recordings, where only an option of it does without.

    Raises:
        InputError: if there are none.
    """
    if not recordings:
        from flexarm_env.errors import InputError

        raise InputError(f"missing argument 'RECORDING…' (see flexarm {command} --help)")
    return recordings


def arm_files(name: str) -> list[Path]:
    """List the file of an arm, by its path or by the name of a shipped arm; none where there is none."""
    path = arm_path(name)
    return [] if path is None else [path]


def load_arm(name: str, specs: Sequence[str] | None) -> Arm:
    """Load an arm that may have effects of the user's own."""
    from flexarm_env.arm import Arm
    from flexarm_env.terminal import inputs

    return Arm.load(name, inputs.known_effects(specs or []))


def show_notes(recordings: Sequence[Recording]) -> None:
    """Print on stderr how files were read, where a person might expect otherwise."""
    from flexarm_env.errors import printable

    for recording in recordings:
        for note in recording.notes:
            typer.echo(printable(f"Note: {recording.source or recording.name}: {note}"), err=True)


def show_faults(faults: Sequence[str]) -> None:
    """Print the faults of recordings on stderr, where a command goes on with them."""
    for fault in faults:
        typer.echo(f"Note: {fault}", err=True)


def hint_at_save(save: Path | None) -> None:
    """Point to --save where the arm was not saved."""
    if save is None:
        typer.echo("Not saved; --save ARM.toml keeps the arm.", err=True)
