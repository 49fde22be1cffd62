"""Workers end with the process that started them, however that ends."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import flexarm_env

PROGRAM = """
import os, sys, time
import numpy as np
from flexarm_env.identify.workers import Workers

def work(numbers):
    print(os.getpid(), flush=True)
    time.sleep(600)

list(Workers(2).map([(work, (np.zeros(10**6),))] * 2))
"""
PATIENCE = 30.0


def is_alive(process: int) -> bool:
    try:
        state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state != "Z"


def descendants(process: int) -> list[int]:
    """List the processes that a process has started, and those that these have started."""
    try:
        own = [int(child) for child in Path(f"/proc/{process}/task/{process}/children").read_text().split()]
    except OSError:
        own = []
    return [found for child in own for found in (child, *descendants(child))]


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="this system does not list processes in /proc")
def test_a_killed_process_leaves_no_worker_and_no_shared_memory(tmp_path):
    environment = os.environ | {"PYTHONPATH": str(Path(flexarm_env.__file__).parents[1]), "JOBLIB_TEMP_FOLDER": str(tmp_path)}
    main = subprocess.Popen([sys.executable, "-c", PROGRAM], stdout=subprocess.PIPE, text=True, env=environment)
    assert main.stdout is not None
    workers = {int(main.stdout.readline()) for _ in range(2)}
    helpers = {*workers, *descendants(main.pid)}
    assert len(helpers) > len(workers), "the tracker of shared memory is a process, too"
    assert list(tmp_path.iterdir()), "the arrays are large enough to be shared"
    main.send_signal(signal.SIGKILL)
    main.wait()
    main.stdout.close()
    until = time.monotonic() + PATIENCE
    while any(map(is_alive, helpers)) and time.monotonic() < until:
        time.sleep(0.1)
    assert not [helper for helper in helpers if is_alive(helper)]
    assert list(tmp_path.iterdir()) == []
