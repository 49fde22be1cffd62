"""The examples in docstrings run as they stand."""

from __future__ import annotations

import doctest
import importlib
from pathlib import Path

import pytest

import flexarm_env

ROOT = Path(flexarm_env.__file__).parent
FILES = [file for file in sorted(ROOT.rglob("*.py")) if ">>> " in file.read_text(encoding="utf-8")]
#: Files whose import needs a library of an extra.
NEED = {"sb3.py": "stable_baselines3"}
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.relative_to(ROOT).as_posix())
def test_examples_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, file: Path) -> None:
    if file.name in NEED:
        pytest.importorskip(NEED[file.name])
    monkeypatch.chdir(tmp_path)  # examples write files
    name = ".".join(file.relative_to(ROOT.parent).with_suffix("").parts).removesuffix(".__init__")
    result = doctest.testmod(importlib.import_module(name), optionflags=FLAGS)
    assert not result.failed


def test_what_is_public_has_an_example() -> None:
    methods = ("from_arrays", "read", "read_all", "write", "part")
    functions = (flexarm_env.simulate, flexarm_env.compare, flexarm_env.fit, flexarm_env.add, flexarm_env.diagnose)
    public = [*functions, *(getattr(flexarm_env.Recording, name) for name in methods)]
    for function in public:
        assert ">>> " in (function.__doc__ or ""), function.__qualname__
