"""What pyproject.toml requires: Python, the direct requirements, and the extras that a run may leave out."""

from __future__ import annotations

from collections.abc import Collection
from itertools import chain
from pathlib import Path

from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.version import Version

from flexarm_env.errors import InputError
from flexarm_env.files import read_toml

PROJECT = Path(__file__).resolve().parents[2]


def direct_requirements(left_out: Collection[str] = ()) -> list[Requirement]:
    """List the requirements of the package and of its extras, without those of the extras left out.

    Raises:
        InputError: for an extra that pyproject.toml does not have.
    """
    project = _project()
    extras = project["optional-dependencies"]
    for name in left_out:
        if name not in extras:
            raise InputError(f"no extra {name!r}; pyproject.toml has {', '.join(extras)}")
    kept = chain.from_iterable(lines for name, lines in extras.items() if name not in left_out)
    found = [Requirement(line) for line in dict.fromkeys([*project["dependencies"], *kept])]
    return [each for each in found if each.name != project["name"]]


def oldest_python() -> Version:
    """Find the oldest version of Python that pyproject.toml allows."""
    (lowest,) = (each.version for each in SpecifierSet(_project()["requires-python"]) if each.operator == ">=")
    return Version(lowest)


def _project() -> dict:
    return read_toml(PROJECT / "pyproject.toml")["project"]
