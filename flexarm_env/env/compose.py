"""One compiled kernel from the environment's source and the terms of a task's reward."""

from __future__ import annotations

import ast
import inspect
import textwrap
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numba

from flexarm_env.env import layout as at
from flexarm_env.errors import InputError
from flexarm_env.generated import generated_module, without_imports
from flexarm_env.plant import truth
from flexarm_env.tasks.reward import RewardTerm, Sample

#: The kernel, each file after those that it calls; the terms of the reward come before the last.
HERE = Path(__file__).parent
FILES = (Path(truth.__file__), HERE / "draws.py", HERE / "layout.py", HERE / "sensing.py")
LAST = HERE / "kernel.py"
#: Rows of the outcome that an info reports, by name; those of the reward's terms follow.
INFO = {
    "hub_angle": at.HUB_ANGLE,
    "hub_speed": at.HUB_SPEED,
    "tip_deflection": at.TIP_DEFLECTION,
    "stuck": at.STUCK,
    "target": at.TARGET,
    "command": at.COMMAND,
}
DECORATOR = '@njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)'


@lru_cache(maxsize=32)
def environment_kernel(terms: tuple[RewardTerm, ...]) -> Any:
    """Compile the kernel of tasks with these terms, or take it from the cache.

    Returns:
        A module with the kernels after_step, after_reset and request, the rows of an info by name, and info_of, which makes one.
    """
    return _module(_source(terms))


@lru_cache(maxsize=32)
def _module(text: str) -> ModuleType:
    return generated_module("flexarm_environment", f"{numba.__version__}\n{text}", lambda: text)


def _source(terms: tuple[RewardTerm, ...]) -> str:
    imports = ["import math", "from collections import namedtuple", "import numpy as np", "from numba import njit"]
    sample = f"Sample = namedtuple('Sample', {Sample._fields})"
    parts = [*imports, sample, *(without_imports(file) for file in FILES)]
    parts += [*map(_term, terms), _write_terms(terms), without_imports(LAST), _info_of(terms)]
    return "\n\n".join(parts) + "\n"


def _write_terms(terms: tuple[RewardTerm, ...]) -> str:
    """Write the function in the place of placeholder.write_terms: the weighted sum of these terms."""
    lines = [DECORATOR, "def write_terms(a, weights, row, row_each, sample):", "    reward = 0.0"]
    for i, term in enumerate(terms):
        given = ", ".join(f"sample.{quantity}" for quantity in term.quantities)
        lines += [
            f"    term = term_{term.name}({given}) * a[weights + {i}]",
            f"    a[row + {i} * row_each] = term",
            "    reward += term",
        ]
    return "\n".join([*lines, "    return reward"])


def _info_of(terms: tuple[RewardTerm, ...]) -> str:
    """Write the function that makes the info of one arm; written out, since it is called in every step."""
    rows = INFO | {f"reward_{term.name}": at.TERMS + i for i, term in enumerate(terms)}
    items = [f"{name!r}: outcome[{row}]{' > 0.0' if name == 'stuck' else ''}" for name, row in rows.items()]
    return "\n".join([f"INFO_ROWS = {rows}", "def info_of(outcome):", f"    return {{{', '.join(items)}}}"])


def _term(term: RewardTerm) -> str:
    """Write the function of a term under a name of its own, the numbers of its file in the place of their names.

    Raises:
        InputError: for a function without source.
    """
    try:
        source = textwrap.dedent(vars(term.function).get("source") or inspect.getsource(term.function))
    except OSError:
        raise InputError(f"reward term '{term.name}' has no source to compile: write its function in a file") from None
    (function,) = ast.parse(source).body
    assert isinstance(function, ast.FunctionDef)
    function.name, function.decorator_list, function.returns = f"term_{term.name}", [], None
    for argument in function.args.args:
        argument.annotation = None
    return f"{DECORATOR}\n{ast.unparse(_Numbers(term.numbers).visit(function))}"


class _Numbers(ast.NodeTransformer):
    """Put numbers in the place of names."""

    def __init__(self, numbers: dict[str, float]) -> None:
        self.numbers = numbers

    def visit_Name(self, node: ast.Name) -> ast.expr:
        """Replace a name that stands for a number."""
        return ast.Constant(self.numbers[node.id]) if node.id in self.numbers else node
