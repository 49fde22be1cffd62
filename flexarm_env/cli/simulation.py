"""The command that makes a recording."""

from __future__ import annotations

from pathlib import Path

from rich.console import RenderableType
from rich.text import Text

import flexarm_env
from flexarm_env.arm import Arm
from flexarm_env.cli.answers import hand_out
from flexarm_env.cli.arguments import show_notes
from flexarm_env.errors import InputError
from flexarm_env.experiments.plans import EXPERIMENTS
from flexarm_env.pictures import words
from flexarm_env.recordings.recording import Recording
from flexarm_env.terminal import tables
from flexarm_env.terminal.inputs import files_read, read_recordings
from flexarm_env.terminal.outputs import check_places
from flexarm_env.terminal.progress import progress


def simulate(
    arm: Arm,
    name: str,
    source: str,
    settings: tuple[float, float, int, bool],
    columns: Path | None,
    save: Path,
    json: Path | None,
) -> None:
    """Make a recording and write it.

    Args:
        arm: that is simulated.
        name: of the arm, as the user gave it.
        source: an experiment, or a file of commands to play.
        settings: duration [s], rate [Hz], seed, and whether there is noise.
        columns: a column map for the file of commands.
        save: where the recording goes.
        json: where the numbers go.

    Raises:
        InputError: for a source that is neither, or that holds several recordings.
    """
    played: str | Recording = source
    if source and source not in EXPERIMENTS and Path(source).exists():
        check_places(json, save, read=files_read(arm, [Path(source)], columns, require_signal=False))
        found = read_recordings(arm, [Path(source)], columns, require_signal=False)
        show_notes(found)
        if len(found) != 1:
            raise InputError(f"{source}: holds {len(found)} recordings; name one")
        played = found[0]
    with progress("simulating"):
        made = flexarm_env.simulate(arm, played, *settings)
    made.write(save)
    show_notes([made])
    reach = {signal: [float(values.min()), float(values.max())] for signal, values in made.signals.items()}
    rows = [[words.label_of(s), *map(words.number, ends), words.unit_of(s)] for s, ends in reach.items()]
    count = f"{len(made)} samples, {made.duration:g} s at {1.0 / made.sample_time:.4g} Hz"
    parts: list[RenderableType] = [
        Text(f"{count}, from arm '{arm.name}'."),
        tables.table("Signals", ["signal", "from", "to", "unit"], rows),
    ]
    given = [played] if isinstance(played, Recording) else []
    hand_out("simulate", name, given, settings[2], json, {"input": source, "samples": len(made), "range": reach}, parts)
