"""The answer of a command: tables for a person, JSON for a program, an arm file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import typer
from rich.console import RenderableType

from flexarm_env.arm import Arm
from flexarm_env.files import write_whole
from flexarm_env.identify.conclude import at_fault
from flexarm_env.identify.inspect.overview import overview_of_restart
from flexarm_env.identify.inspect.restart import restart
from flexarm_env.identify.results import Diagnosis
from flexarm_env.identify.settings import SETTINGS
from flexarm_env.recordings.clock import RestartError
from flexarm_env.recordings.recording import Recording
from flexarm_env.terminal import tables
from flexarm_env.terminal.delivery import File, deliver
from flexarm_env.terminal.inspection_report import write_inspection
from flexarm_env.terminal.inspection_tables import inspection
from flexarm_env.terminal.provenance import provenance


def hand_out(
    command: str,
    arm: str,
    recordings: Sequence[Recording],
    seed: int | None,
    json: Path | None,
    content: dict[str, Any],
    parts: Sequence[RenderableType],
    files: Sequence[File] = (),
) -> None:
    """Write files, the JSON with its provenance among them, then print tables."""
    made = {} if json is None else provenance(command, arm, recordings, seed)
    deliver(json, content | made, parts, files)


def findings(result: Diagnosis, save: Path | None, next_run: Path | None) -> list[File]:
    """List the files of a diagnosis: the corrected arm and the input to record next, as far as there are any.

    Args:
        result: of the diagnosis.
        save: for the arm.
        next_run: for the input.
    """
    found: list[File] = [] if result.recordings else [(save, result.arm.save)]
    if result.next_run is not None:
        text = result.next_run.as_csv()
        found.append((next_run, lambda path: write_whole(path, text)))
    return found


def note_missing(result: Diagnosis, save: Path | None, next_run: Path | None) -> None:
    """Print on stderr what a diagnosis does not write. Arguments as `findings`."""
    if next_run is not None and result.next_run is None:
        typer.echo(f"No next run is proposed, so {next_run} is not written.", err=True)
    if save is not None and result.recordings:
        typer.echo(f"The arm was not judged by these recordings, so {save} is not written.", err=True)


def diagnose_restart(error: RestartError, arm: Arm, named: str, seed: int, json: Path | None, report: Path | None) -> Diagnosis:
    """Diagnose a recording that holds several runs: there is nothing to replay, but a fault to name.

    Args:
        error: of the file.
        arm: the model.
        named: its file or name.
        seed: recorded with the result.
        json: for the JSON.
        report: for the page.
    """
    result = at_fault(arm, [restart(error)], SETTINGS)

    def write_faults(path: Path) -> None:
        from flexarm_env.pictures.page import page_of_faults

        write_whole(path, page_of_faults(result))

    hand_out("diagnose", named, [], seed, json, result.as_json(), tables.diagnosis(result), [(report, write_faults)])
    return result


def inspect_restart(
    error: RestartError, arm: Arm, named: str, json: Path | None, report: Path | None, line: dict[str, str]
) -> None:
    """Name the fault of a recording that holds several runs.

    Args:
        error: of the file.
        arm: the model.
        named: its file or name.
        json: for the JSON.
        report: for the page.
        line: the command line, for the page.
    """
    found = overview_of_restart(arm, error)
    made = line | provenance("inspect", named, [], None)
    files: list[File] = [(report, lambda path: write_inspection(path, found, made))]
    hand_out("inspect", named, [], None, json, found.as_json(), inspection(found), files)
