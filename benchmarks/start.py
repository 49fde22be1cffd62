"""Time of the import, of the first simulation, of reading a recording and of the lab's replays, in fresh processes."""

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

#: 5000 rows of four signals.
READ = """
import tempfile, time
from pathlib import Path
import flexarm_env
run = flexarm_env.simulate(flexarm_env.Arm.load("thesis"), "square", duration=10.0, rate=500.0)
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "run.csv"
    run.write(path)
    taken = []
    for _ in range(5):
        t = time.perf_counter()
        flexarm_env.Recording.read(path)
        taken.append(time.perf_counter() - t)
print(1000 * min(taken))
"""
#: The shipped recordings, as a slider of the lab moves.
LAB = """
import time
import flexarm_env.demo
from flexarm_env import Arm, Recording
from flexarm_env.lab.live import Live
arm = Arm.load("thesis-fem")
live = Live(arm, Recording.read_all(flexarm_env.demo.__path__[0]))
taken = []
for step in range(15):
    changed = arm.with_effect("backlash", gap=0.02 + 0.004 * step)
    t = time.perf_counter()
    live.simulate(changed)
    taken.append(time.perf_counter() - t)
print(1000 * min(taken))
"""


def measure(say: Callable[[str], None]) -> dict[str, Any]:
    """Time fresh processes, the shortest of several: the first may compile; Python's own start does not count."""
    say("import and first simulation in fresh processes")
    seconds = {name: [_run(script) for _ in range(TIMES)] for name, script in (("import", IMPORT), ("first", FIRST))}
    say("reading a recording, and replays as a slider moves")
    return {
        "import_s": min(seconds["import"]),
        "first_simulation_s": min(seconds["first"][1:]),
        "reading_ms": _run(READ),
        "lab_replays_ms": _run(LAB),
    }


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
