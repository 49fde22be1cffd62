"""Long work in a process of its own: how far it is, what it found, how it fails, and that it stops."""

from __future__ import annotations

import os
import subprocess
import threading
import time

import pytest

from flexarm_env.errors import InputError
from flexarm_env.lab.job import Job

LIMIT = 60.0


def until(job: Job, state: str) -> None:
    end = time.monotonic() + LIMIT
    while job.state == "running" and time.monotonic() < end:
        job.poll()
        time.sleep(0.01)
    assert job.state == state, job.text


def gone(process: int) -> bool:
    """Whether a process has ended within a few seconds; one that nobody has waited for yet has ended, too."""
    for _ in range(1000):
        state = subprocess.run(["ps", "-o", "stat=", "-p", str(process)], capture_output=True, text=True, check=False).stdout
        if not state.strip() or state.startswith("Z"):
            return True
        time.sleep(0.01)
    return False


def test_it_tells_how_far_it_is_and_what_it_found():
    def work(say):
        say(0.5, "half")
        time.sleep(0.3)
        return {"answer": 42}

    job, heard = Job("Testing", work), []
    end = time.monotonic() + LIMIT
    while job.state == "running" and time.monotonic() < end:
        if job.poll():
            heard.append((job.share, job.text))
    assert job.state == "done"
    assert job.result == {"answer": 42}
    assert (0.5, "half") in heard


@pytest.mark.parametrize(
    ("error", "words"), [(InputError("one line"), "one line"), (ZeroDivisionError("x"), "a fault of the program")]
)
def test_a_failure_is_one_line(error, words):
    def work(say):
        raise error

    job = Job("Testing", work)
    until(job, "failed")
    assert job.text.startswith(words)


def test_a_process_that_dies_is_a_failure():
    job = Job("Testing", lambda say: os._exit(3))
    until(job, "failed")
    assert "without a word" in job.text


def test_stop_ends_it_and_its_children_at_once(tmp_path, capfd, monkeypatch):
    note = tmp_path / "children"

    def work(say):
        child = subprocess.Popen(["sleep", "100"])
        note.write_text(f"{os.getpid()} {child.pid}")
        say(0.1, "started")
        child.wait()

    job = Job("Testing", work)
    end = time.monotonic() + LIMIT
    while job.text != "started" and time.monotonic() < end:
        job.poll()
    stopped, in_time, reap = threading.Event(), [], job._reap

    def reap_after_stop():
        in_time.append(stopped.wait(LIMIT))
        reap()

    monkeypatch.setattr(job, "_reap", reap_after_stop)
    job.stop()  # the page waits for this, and it must not wait for the process
    stopped.set()
    assert job.state == "stopped"
    leader, child = map(int, note.read_text().split())
    assert gone(leader)
    assert gone(child)
    assert in_time == [True]
    assert capfd.readouterr().err == ""
