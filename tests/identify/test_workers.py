"""Workers end with the process that started them, however that ends."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from joblib import parallel_config
from joblib._parallel_backends import ThreadingBackend
from processes import LISTED, descendants, is_alive, wait_for

import flexarm_env
from flexarm_env import InputError
from flexarm_env.identify.workers import Workers

PROGRAM = r"""
import os, sys, time
import numpy as np
from flexarm_env.identify.workers import Workers

def work(numbers):
    os.write(1, f"{os.getpid()}\n".encode())
    time.sleep(600)

list(Workers(3).map([(work, (np.zeros(10**6),))] * 2))
"""
PATIENCE = 30.0
#: With psutil joblib looks at a process's memory each second, and replaces one that grew by more than 300 MB.
GROWING = """
import time
import numpy as np
from flexarm_env.identify.workers import Workers

def grow(number):
    vars(time).setdefault("kept", []).append(np.ones(6 * 10**7))
    time.sleep(1.1)
    return number

print(*Workers(2, batch=1).map([(grow, (number,)) for number in range(8)]))
"""


@LISTED
def test_a_killed_process_leaves_no_worker_and_no_shared_memory(tmp_path):
    environment = os.environ | {"PYTHONPATH": str(Path(flexarm_env.__file__).parents[1]), "JOBLIB_TEMP_FOLDER": str(tmp_path)}
    main = subprocess.Popen([sys.executable, "-c", PROGRAM], stdout=subprocess.PIPE, text=True, env=environment)
    assert main.stdout is not None
    workers = {int(main.stdout.readline()) for _ in range(2)}
    helpers = {*workers, *descendants(main.pid)}
    assert len(helpers) > len(workers) + 1, "the tracker of shared memory is a process, too, and so is a worker without a task"
    assert list(tmp_path.iterdir()), "the arrays are large enough to be shared"
    main.send_signal(signal.SIGKILL)
    main.wait()
    main.stdout.close()
    wait_for(lambda: not any(map(is_alive, helpers)), PATIENCE)
    assert not [helper for helper in helpers if is_alive(helper)]
    assert list(tmp_path.iterdir()) == []


def test_a_killed_worker_is_one_line():
    """And the next tasks have new workers."""
    with pytest.raises(InputError, match=r"a worker process was killed; was there memory enough\? try --jobs 1$"):
        list(Workers(2).map([(signal.raise_signal, (signal.SIGKILL,))] * 2))
    assert list(Workers(2).map([(abs, (-1,)), (abs, (-2,))])) == [1, 2]


def test_a_worker_that_grew_is_replaced_though_warnings_are_errors():
    pytest.importorskip("psutil")
    program = [sys.executable, "-W", "error::UserWarning", "-c", GROWING]
    run = subprocess.run(program, capture_output=True, text=True, timeout=4.0 * PATIENCE, check=True)
    assert (run.stdout, run.stderr) == ("0 1 2 3 4 5 6 7\n", "")


@pytest.mark.parametrize("jobs", [0, -1, True, 1.0, "2", None])
def test_workers_are_a_whole_number(jobs):
    with pytest.raises(InputError, match=r"jobs is .*; give a whole number from 1 up"):
        Workers(jobs)


class Engine(ThreadingBackend):
    """Like Dask's, it takes tasks for all of its workers, whatever the number of jobs."""

    def effective_n_jobs(self, n_jobs: int) -> int:
        return 4


def test_one_job_is_done_here_though_an_engine_of_several_is_around() -> None:
    with parallel_config(backend=Engine()):
        places = list(Workers(1).map([(threading.get_ident, ())] * 8))
    assert set(places) == {threading.get_ident()}
