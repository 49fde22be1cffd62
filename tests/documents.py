"""The project's documents and the fenced blocks in them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

PROJECT = Path(__file__).resolve().parent.parent
README = PROJECT / "README.md"
DOCUMENTS = [README, PROJECT / "CONTRIBUTING.md", *sorted((PROJECT / "docs").glob("*.md"))]

# A comment before a block says that it takes long; a first line "# name.ext" makes it a file that later blocks use.
BLOCK = re.compile(r"^(<!-- slow -->\n)?```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FILE = re.compile(r"# ([\w-]+\.\w+)\n")


@dataclass(frozen=True)
class Block:
    """A fenced block: its language, text and first line's number; whether it is slow; the file that it is, or ""."""

    language: str
    text: str
    line: int
    slow: bool
    file: str


def blocks_of(document: Path) -> list[Block]:
    text = document.read_text(encoding="utf-8")
    found = []
    for match in BLOCK.finditer(text):
        name = FILE.match(match[3])
        line = text.count("\n", 0, match.start(3)) + 1
        found.append(Block(match[2], match[3], line, bool(match[1]), name[1] if name else ""))
    return found


def name_of(document: Path) -> str:
    return document.relative_to(PROJECT).as_posix()
