"""The bar on a terminal moves at least once a second with the time that is left, also while a stage is silent."""

from __future__ import annotations

import os
import pty
import re
import subprocess
import sys
from pathlib import Path

import pytest

import flexarm_env
from flexarm_env.terminal.progress import time_left

SILENT_STAGE = """
import time
from flexarm_env.terminal.progress import progress
with progress("diagnosing") as bar:
    bar(0.5, "screening")
    bar(0.25, "an earlier share")
    time.sleep(5.5)
"""


@pytest.mark.parametrize(
    ("elapsed", "done", "text"),
    [
        (1.9, 0.5, ""),
        (2.0, 0.5, "about 2 s left"),
        (10.0, 0.25, "about 30 s left"),
        (12.0, 0.25, "about 36 s left"),
        (600.0, 0.5, "about 10 min left"),
        (7.0, 0.0, "7 s so far"),
        (7.0, 1.0, "about 0 s left"),
    ],
)
def test_the_time_left_follows_the_share_that_is_done(elapsed, done, text):
    assert time_left(elapsed, done) == text


def test_a_silent_stage_moves_every_second():
    ours, theirs = pty.openpty()
    environment = os.environ | {"PYTHONPATH": str(Path(flexarm_env.__file__).parents[1]), "COLUMNS": "120", "TERM": "xterm"}
    with subprocess.Popen([sys.executable, "-c", SILENT_STAGE], stderr=theirs, env=environment):
        os.close(theirs)
        shown = b""
        while True:
            try:
                part = os.read(ours, 65536)
            except OSError:  # the other end is closed
                break
            shown += part
    os.close(ours)
    left = [int(seconds) for seconds in re.findall(rb"about (\d+) s left", shown)]
    assert left == sorted(left)
    assert len(set(left)) >= 3
    assert left[-1] <= 6, "the share never falls back"
