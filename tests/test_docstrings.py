"""The examples in docstrings run."""

from __future__ import annotations

import doctest
import importlib
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parent.parent
WITH_EXAMPLES = [
    file.relative_to(PROJECT).with_suffix("")
    for file in sorted((PROJECT / "flexarm_env").rglob("*.py"))
    if ">>> " in file.read_text(encoding="utf-8")
]


@pytest.mark.parametrize("file", WITH_EXAMPLES, ids=Path.as_posix)
def test_the_examples_run(file: Path) -> None:
    module = importlib.import_module(".".join(file.parts).removesuffix(".__init__"))
    assert doctest.testmod(module).failed == 0
