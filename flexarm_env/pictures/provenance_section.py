"""The section of a page that says how to make it again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from flexarm_env.pictures import words
from flexarm_env.pictures.document import paragraph, section, table
from flexarm_env.recordings.recording import Recording


def reproduce(made: Mapping[str, Any], recordings: Sequence[Recording], *more: str) -> str:
    """Format the command line, version, commit and seed of a result, and the sums of its files.

    Args:
        made: "command_line", "version", "commit" and "seed", as far as they are known.
        recordings: of the machine.
        more: parts before the sums.
    """
    files = [[r.name, r.sha256 or words.NOTHING] for r in recordings]
    facts = [f"FlexArm {made['version']}" if "version" in made else "", f"commit {made['commit']}" if made.get("commit") else ""]
    facts += [f"seed {made['seed']}" if made.get("seed") is not None else ""]
    command = f"<pre tabindex=0>{escape(str(made['command_line']))}</pre>" if made.get("command_line") else ""
    text = paragraph(", ".join(fact for fact in facts if fact))
    sums = table(["recording", "SHA-256 of its file"], files, words=2, code=(1,))
    return section("How to reproduce it", command, text, *more, sums)
