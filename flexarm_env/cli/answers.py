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
from flexarm_env.terminal import outputs, tables
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
) -> None:
    """Print tables, to stderr if stdout is for JSON, and write the JSON with its provenance."""
    tables.show(tables.console(to_stderr=json == outputs.STDOUT), *parts)
    if json is not None:
        outputs.write_json(json, content | provenance(command, arm, recordings, seed))


def save_findings(result: Diagnosis, save: Path | None, next_run: Path | None) -> None:
    """Write the corrected arm and the input to record next, and print on stderr what there is none of.

    Args:
        result: of the diagnosis.
        save: for the arm.
        next_run: for the input.
    """
    if next_run is not None and result.next_run is not None:
        write_whole(next_run, result.next_run.as_csv())
    elif next_run is not None:
        typer.echo(f"No next run is proposed, so {next_run} is not written.", err=True)
    if save is not None and result.recordings:
        typer.echo(f"The arm was not judged by these recordings, so {save} is not written.", err=True)
    elif save is not None:
        result.arm.save(save)


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
    hand_out("diagnose", named, [], seed, json, result.as_json(), tables.diagnosis(result))
    if report is not None:
        from flexarm_env.pictures.page import page_of_faults

        write_whole(report, page_of_faults(result))
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
    hand_out("inspect", named, [], None, json, found.as_json(), inspection(found))
    if report is not None:
        write_inspection(report, found, line | provenance("inspect", named, [], None))
