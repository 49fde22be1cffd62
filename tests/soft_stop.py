"""The effect of one's own of docs/your-effect.md. Tests that simulate one take this one: a kernel is compiled once for all."""

from __future__ import annotations

from pathlib import Path

from documents import PROJECT, blocks_of

from flexarm_env.effects.base import Effect
from flexarm_env.effects.catalogue import load_effect


def soft_stop(folder: Path) -> type[Effect]:
    """Write the effect's file into a folder, and load it."""
    file = folder / "soft_stop.py"
    (text,) = (block.text for block in blocks_of(PROJECT / "docs" / "your-effect.md") if block.file == file.name)
    file.write_text(text, encoding="utf-8")
    return load_effect(f"{file}:SoftStop")
