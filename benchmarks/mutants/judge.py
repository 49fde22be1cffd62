"""Put a mutant to its tests, in a copy of the project."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from benchmarks.mutants.mutant import Mutant
from benchmarks.mutants.reach import PROJECT

#: What the tests of a part need.
COPIED = ("flexarm_env", "tests", "configs", "agents", "benchmarks", "docs", "pyproject.toml", "README.md")
#: Tests are chosen by their time, so that the project's own choice of fast ones would leave out some of them.
SLOW_TOO = ("-m", "slow or not slow")
#: Seconds that all tests of a mutant may take. Most of it goes by in compiling.
LONGEST = 600.0


@dataclass(frozen=True)
class Outcome:
    """What the tests said: `killed` if one failed, `hung` if they took too long, else `survived`; and the test that failed."""

    verdict: str
    tests: int
    by: str

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data."""
        return asdict(self)


def judged(mutant: Mutant, tests: Sequence[str], cache: Path) -> Outcome:
    """Run tests on a copy of the project with a fault in it.

    Args:
        mutant: the fault.
        tests: the ids of tests.
        cache: of compiled kernels; each is named by all that it is made of, so mutants share it.
    """
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder) / "project"
        _copy(root)
        (root / mutant.file).write_text(mutant.source(), encoding="utf-8")
        paths = {"PYTHONPATH": str(root), "FLEXARM_CACHE": str(cache), "PYTHONDONTWRITEBYTECODE": "1", "TMPDIR": folder}
        command = [sys.executable, "-m", "pytest", "-x", "-q", "-n", "0", "-p", "no:cacheprovider", *SLOW_TOO, *tests]
        # A session of its own: what the tests have started ends with them.
        process = subprocess.Popen(
            command, cwd=root, env=os.environ | paths, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True
        )
        try:
            output = process.communicate(timeout=LONGEST)[0].decode(errors="replace")
        except subprocess.TimeoutExpired:
            return Outcome("hung", len(tests), "")
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
    failed = [line for line in output.splitlines() if line.startswith(("FAILED ", "ERROR "))]
    if process.returncode == 0:
        return Outcome("survived", len(tests), "")
    return Outcome("killed", len(tests), failed[0].split()[1] if failed else output.strip().splitlines()[-1][:200])


def _copy(root: Path) -> None:
    root.mkdir()
    for name in COPIED:
        if (PROJECT / name).is_dir():
            shutil.copytree(PROJECT / name, root / name, ignore=shutil.ignore_patterns("__pycache__", "*.nbi", "*.nbc"))
        else:
            shutil.copy(PROJECT / name, root / name)
    measurements = PROJECT.parent / "shared"
    if measurements.exists():
        (root.parent / "shared").symlink_to(measurements.resolve())
