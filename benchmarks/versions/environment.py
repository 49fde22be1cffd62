"""An environment with the oldest or with the newest versions, and the versions in it."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from packaging.requirements import Requirement

from benchmarks.versions.requirements import PROJECT
from flexarm_env.errors import InputError

INSTALLED = "import sys, json, importlib.metadata as m; print(json.dumps({n: m.version(n) for n in sys.argv[1:]}))"
PYTHON = "import platform; print(platform.python_version())"


@dataclass(frozen=True)
class Environment:
    """A virtual environment of its own, in a folder beside the project's .venv."""

    side: str
    requirements: tuple[Requirement, ...]

    @property
    def folder(self) -> Path:
        return PROJECT / f".venv-{self.side}"

    @property
    def python(self) -> str:
        return str(self.folder / "bin" / "python")

    def make(self, interpreter: str) -> None:
        """Make the environment anew and install the versions of its side.

        Raises:
            InputError: if the interpreter does not start, or something cannot be installed.
        """
        _do([interpreter, "-m", "venv", "--clear", str(self.folder)])
        wanted = [str(each) for each in self.requirements]
        lowest = ["--constraint", str(self._lowest(wanted))] if self.side == "oldest" else []
        self._pip(*lowest, *wanted, "--editable", str(PROJECT))

    def versions(self) -> dict[str, str]:
        """Gather the installed version of every direct requirement."""
        return json.loads(_do([self.python, "-c", INSTALLED, *(each.name for each in self.requirements)]))

    def python_version(self) -> str:
        return _do([self.python, "-c", PYTHON]).strip()

    def _lowest(self, wanted: Sequence[str]) -> Path:
        """Write a file with the lowest version of every direct requirement, and with versions that go with them.

        uv only resolves, and pip installs: pip's settings hold, such as where it finds large packages.
        """
        self._pip("uv")
        place = self.folder / "lowest.txt"
        command = [self.python, "-m", "uv", "pip", "compile", "--quiet", "--resolution", "lowest-direct", "--python", self.python]
        _do([*command, "--output-file", str(place), "-"], "\n".join(wanted))
        return place

    def _pip(self, *arguments: str) -> None:
        _do([self.python, "-m", "pip", "install", "--quiet", "--quiet", "--disable-pip-version-check", *arguments])


def _do(command: list[str], text: str = "") -> str:
    """Run a command and return its output; its errors are shown as they come."""
    try:
        done = subprocess.run(command, input=text, stdout=subprocess.PIPE, text=True, check=False)
    except OSError as error:
        raise InputError(f"{command[0]}: {error.strerror}; name a Python that starts") from None
    if done.returncode:
        raise InputError(f"exit code {done.returncode} of: {' '.join(command)[:300]}")
    return done.stdout
