"""Generated modules: one for one text, whoever asks at once."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

from flexarm_env.generated import generated_module

SOURCE = """
import time
from collections import namedtuple

time.sleep(0.05)
Bundle = namedtuple("Bundle", "value")
"""


def test_threads_that_need_a_module_at_once_get_one(tmp_path, monkeypatch):
    monkeypatch.setenv("FLEXARM_CACHE", str(tmp_path))
    with ThreadPoolExecutor(8) as threads:
        found = list(threads.map(lambda _: generated_module("flexarm_try", SOURCE, lambda: SOURCE), range(8)))
    assert len({id(module.Bundle) for module in found}) == 1
    assert [path.suffix for path in tmp_path.glob("flexarm_try*")] == [".py"]
