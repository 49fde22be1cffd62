"""The Pythons of this machine, as far as they are on the path or named by the user."""

from __future__ import annotations

import os
import re
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

from benchmarks.versions.requirements import oldest_python
from flexarm_env.errors import InputError


def oldest_on_path() -> str:
    """Name the oldest Python that pyproject.toml allows.

    Raises:
        InputError: if the path has none that runs.
    """
    name = f"python{oldest_python()}"
    if _runs(name):
        return name
    raise InputError(f"no {name} on the path; name one: make versions OLDEST=python")


def newest_on_path() -> str:
    """Find the newest Python on the path that runs and that pyproject.toml allows.

    Raises:
        InputError: if there is none.
    """
    least = oldest_python().minor
    for minor in sorted(set(_minors()), reverse=True):
        if minor >= least and _runs(f"python3.{minor}"):
            return f"python3.{minor}"
    raise InputError(f"no python3.{least} or newer on the path; name one: make versions NEWEST=python")


def _minors() -> Iterator[int]:
    for folder in os.get_exec_path():
        for file in Path(folder).glob("python3.*"):
            if match := re.fullmatch(r"python3\.(\d+)", file.name):
                yield int(match[1])


def _runs(name: str) -> bool:
    """Check that it starts: a version manager puts names on the path that start nothing."""
    try:
        return subprocess.run([name, "--version"], capture_output=True, check=False).returncode == 0
    except OSError:
        return False


FIND: dict[str, Callable[[], str]] = {"oldest": oldest_on_path, "newest": newest_on_path}
