"""The command that runs the benchmarks."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from flexarm_env.errors import InputError


def run(arguments: Sequence[str]) -> int:
    """Run the benchmarks of a source tree; return their exit code.

    Raises:
        InputError: where there is no source tree.
    """
    root = Path(__file__).resolve().parents[2]
    if not (root / "benchmarks" / "__main__.py").is_file():
        raise InputError("the benchmarks come with the source tree, not with the installed package")
    return subprocess.run([sys.executable, "-m", "benchmarks", *arguments], cwd=root, check=False).returncode
