"""How a result was made: command, version, commit, arm and recordings."""

from __future__ import annotations

import shlex
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import flexarm_env
from flexarm_env.recordings.recording import Recording


def provenance(command: str, arm: str, recordings: Sequence[Recording], seed: int | None) -> dict[str, Any]:
    """Gather the facts that a reader needs in order to trust or redo a result."""
    made: dict[str, Any] = {
        "command": command,
        "version": flexarm_env.__version__,
        "commit": commit(),
        "arm": arm,
        "files": [{"name": r.name, "sha256": r.sha256} for r in recordings],
    }
    return made if seed is None else made | {"seed": seed}


def command_line(
    command: str,
    recordings: Sequence[str | Path],
    arm: str,
    columns: Path | None = None,
    effects: Sequence[str] = (),
    seed: int | None = None,
    rate: float | None = None,
) -> str:
    """Write the command line that makes a result again.

    Args:
        command: "compare" or "diagnose".
        recordings: files and folders.
        arm: a file, or the name of a shipped arm.
        columns: a file with a column map.
        effects: effects of the user's own, as "FILE.py:Name".
        seed: of the method; None if it has none.
        rate: samples per second that are kept [Hz], if the user set it.
    """
    words = ["flexarm", command, *map(str, recordings), "--arm", arm]
    words += ["--columns", str(columns)] if columns is not None else []
    words += [word for spec in effects for word in ("--effects", spec)]
    words += ["--rate", f"{rate:g}"] if rate is not None else []
    words += ["--seed", str(seed)] if seed is not None else []
    return shlex.join(words)


def commit() -> str | None:
    """Find the commit of this source tree, with "+" if files differ from it; None where it is no checkout."""
    here = Path(__file__).resolve().parent.parent

    def git(*arguments: str) -> str:
        run = subprocess.run(["git", "-C", here, *arguments], capture_output=True, text=True, timeout=5, check=True)
        return run.stdout.strip()

    try:
        git("ls-files", "--error-unmatch", "__init__.py")
        return git("rev-parse", "HEAD") + ("+" if git("status", "--porcelain", "--untracked-files=no", ".") else "")
    except (OSError, subprocess.SubprocessError):
        return None
