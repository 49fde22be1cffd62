"""The gallery: all rigs of a folder examined, one file and one picture each; an interrupted run resumes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from flexarm_env.errors import InputError
from flexarm_env.files import read_json
from flexarm_env.identify.explain.compare import compare
from flexarm_env.identify.progress import Progress, ProgressCallback
from flexarm_env.pictures import curves
from flexarm_env.rigs.examine import Examined, Posed, as_json, examine, pose
from flexarm_env.rigs.rig import Rig
from flexarm_env.rigs.table import RIGS
from flexarm_env.terminal.outputs import write_json
from flexarm_env.terminal.provenance import provenance

#: Called with each rig's answer, and whether it was there before.
Answered = Callable[[dict[str, Any], bool], None]


def rigs_in(folder: Path, names: Sequence[str] = ()) -> list[Rig]:
    """List the rigs whose recordings lie in a folder of measurements.

    Args:
        folder: of the measurements.
        names: of the rigs wanted; all by default.

    Raises:
        InputError: for a name that is none, one whose recordings are not all there, and a folder with those of no rig.
    """
    known = [rig.name for rig in RIGS]
    for name in names:
        if name not in known:
            raise InputError(f"unknown rig '{name}'; there are {', '.join(known)}")
    wanted = [rig for rig in RIGS if not names or rig.name in names]
    found = [rig for rig in wanted if rig.is_in(folder)]
    if names and len(found) < len(wanted):
        rig = next(rig for rig in wanted if rig not in found)
        lacks = next(record.file for record in (*rig.training, *rig.held_out) if not (folder / record.file).is_file())
        raise InputError(f"{folder}: lacks {lacks} of rig '{rig.name}'; put it there, or leave the rig out")
    if not found:
        first = RIGS[0].training[0].file
        raise InputError(f"{folder}: has the recordings of no rig; name the folder in which {first} lies")
    return found


def run(
    rigs: Sequence[Rig],
    folder: Path,
    output: Path,
    jobs: int = 1,
    progress: ProgressCallback | None = None,
    answered: Answered | None = None,
) -> list[dict[str, Any]]:
    """Examine rigs; write `NAME.json`, `NAME.toml` and `NAME.png` of each. Answers that still hold are kept.

    Args:
        rigs: to examine.
        folder: of the measurements.
        output: folder of the answers, which exists.
        jobs: processes.
        progress: called with the share done and a text.
        answered: called after each rig.

    Returns:
        The answers, as plain data.
    """
    answers = []
    for rig, part in zip(rigs, Progress.to(progress).split(*[1] * len(rigs)), strict=True):
        posed = pose(rig, folder)
        part.at(0.0, f"diagnosing {rig.name}")
        kept = stored(output, posed)
        answer = kept or _answer(posed, output, jobs, part)
        if answered:
            answered(answer, kept is not None)
        answers.append(answer)
    return answers


def stored(output: Path, posed: Posed) -> dict[str, Any] | None:
    """Read the answer on a rig that an earlier run wrote; None if there is none of this arm and these recordings."""
    path = output / f"{posed.rig.name}.json"
    try:
        answer = read_json(path, "delete it")
    except InputError:
        return None
    return answer if answer.get("key") == posed.key else None


def _answer(posed: Posed, output: Path, jobs: int, progress: Progress) -> dict[str, Any]:
    """Examine a rig and write its files, the answer last, because a run resumes by it."""
    found = examine(posed, jobs, progress.at)
    answer = as_json(found) | {"made": provenance("rigs", posed.rig.arm, [*posed.training, *posed.held_out], None)}
    name = posed.rig.name
    found.diagnosis.arm.save(output / f"{name}.toml")
    _draw(found, output / name)
    write_json(output / f"{name}.json", answer)
    return answer


def _draw(found: Examined, stem: Path) -> None:
    """Draw the first held-out recording, with the arm as given and the corrected one."""
    run = found.posed.held_out[0]
    before, after = (compare(found.arms[step], [run]) for step in ("nominal", "final"))
    added = found.diagnosis.effects
    names = ("model as given", f"with {' and '.join(added)}" if added else "refitted")
    curves.save(curves.overlay(before, after, run.name, names), stem, ["png"])
