"""Time of the import and of the first simulation, each in fresh processes."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

TIMES = 5
IMPORT = "import time; t = time.perf_counter(); import flexarm_env; print(time.perf_counter() - t)"
FIRST = """
import time
t = time.perf_counter()
import flexarm_env
flexarm_env.simulate(flexarm_env.Arm.load("thesis"), "pulse")
print(time.perf_counter() - t)
"""


def measure(say: Callable[[str], None]) -> dict[str, Any]:
    """Time fresh processes, the shortest of several: the first may compile; Python's own start does not count."""
    say("import and first simulation in fresh processes")
    seconds = {name: [_run(script) for _ in range(TIMES)] for name, script in (("import", IMPORT), ("first", FIRST))}
    return {"import_s": min(seconds["import"]), "first_simulation_s": min(seconds["first"][1:])}


def _run(script: str) -> float:
    root = Path(__file__).resolve().parent.parent
    path = os.pathsep.join([str(root), *filter(None, [os.environ.get("PYTHONPATH")])])
    environment = os.environ | {"PYTHONPATH": path}
    done = subprocess.run(
        [sys.executable, "-c", script],
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    return float(done.stdout.split()[-1])
