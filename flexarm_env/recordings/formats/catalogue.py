"""Which formats exist: the modules of this folder that have a `FORMAT`."""

from __future__ import annotations

import importlib
import pkgutil
from functools import lru_cache
from pathlib import Path

from flexarm_env.recordings.formats.base import Format


@lru_cache(maxsize=1)
def formats() -> tuple[Format, ...]:
    """List the formats, by the names of their modules."""
    package = importlib.import_module("flexarm_env.recordings.formats")
    names = (module.name for module in pkgutil.iter_modules(package.__path__))
    modules = [importlib.import_module(f"{package.__name__}.{name}") for name in names if name != "catalogue"]
    return tuple(module.FORMAT for module in modules if hasattr(module, "FORMAT"))


def format_of(path: Path) -> Format:
    """Find the format of a file by its suffix; a suffix that no format has is one of text."""
    suffix = path.suffix.lower() if path.suffix.lower() in suffixes() else ".csv"
    return next(one for one in formats() if suffix in (*one.suffixes, *one.also))


def folder_suffixes() -> list[str]:
    """List the suffixes of the files that a folder stands for."""
    return sorted(suffix for one in formats() for suffix in one.suffixes)


def suffixes() -> list[str]:
    """List the suffixes that any format's file may have."""
    return sorted(suffix for one in formats() for suffix in (*one.suffixes, *one.also))
