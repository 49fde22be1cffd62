"""One compiled kernel from the plant's source and the laws of a catalogue of effects.

The text of the kernel and of every law goes into one generated module, named by the hash of that text: numba caches it
across processes, and a change in any of the sources gives another module, never yesterday's physics.

An index in a kernel counts from the front. numba would give a negative one Python's meaning, with a test and a
selection at each access (30 % of the time of a step); the generated module makes every computed index unsigned, so
numba adds neither.

A call hands over seven numbers for each array. Kernels that the way through a step calls from one place or two are
therefore `forceinline` (a quarter of the time of a step with an event); inlined everywhere they would make it slower.
"""

from __future__ import annotations

import ast
import inspect
import logging
import re
import textwrap
from collections.abc import Callable, Sequence
from functools import lru_cache
from pathlib import Path
from types import ModuleType

import numba

from flexarm_env.generated import generated_module, without_imports
from flexarm_env.plant.ports import DEFAULTS, PORT_ARGUMENTS

#: Types of the kernels' annotations. Without a signature numba compiles a kernel for every literal that it is given.
TYPES = {
    "float": "float64",
    "int": "int64",
    "bool": "boolean",
    "Numbers": "float64[::1]",
    "Places": "int64[::1]",
    "Samples": "float64[:, ::1]",
    "Gains": "float64[:, :, ::1]",
}
#: Imports of the generated module.
IMPORTS = """import math
from collections import namedtuple

import numpy as np
from numba import boolean, float64, int64, njit, uint64
from numba.core.types import BaseTuple

from flexarm_env.plant.inner_product import inner_product
"""
#: What numba does not write itself: the generated modules import it.
INNER_PRODUCT = Path(__file__).with_name("inner_product.py")
#: Suffix of a bundle's name for its type in the generated module.
TYPE = "Type"
#: Kernels own no array: Python holds all arrays. So none needs numba's counts of references (_nrt), which are atomic, take as
#: long as the physics of a quiet step, and would be contended by threads at every arm.
OPTIONS: dict[str, bool | str] = {"cache": True, "nogil": True, "error_model": "numpy", "_nrt": False}
NO_WRAPPERS: dict[str, bool | str] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}

#: Kernels that Python calls. The others get no wrapper, which is half the work of compiling a small one.
ENTRANCES = (
    "scratch_size",
    "prepare",
    "respond",
    "place_at",
    "to_physical",
    "measure",
    "drive_output",
    "control_step",
    "replay",
    "write_noiseless",
    "step_batch",
)

#: The kernel, each file after those that it calls.
FILES = (
    "bundles.py",
    "propagate.py",
    "trial_motion.py",
    "crossing.py",
    "modes.py",
    "friction.py",
    "forces.py",
    "stick_slip.py",
    "force_parabola.py",
    "event_free_table.py",
    "force_quartic.py",
    "event_free_step.py",
    "quiet_step.py",
    "events.py",
    "substep.py",
    "control_step.py",
    "readings.py",
    "replay.py",
    "truth.py",
    "batch.py",
)

#: Prefix of layout.py's places in the kernels; the generated module has their bare names.
PREFIX = re.compile(r"\bat\.(?=[A-Z])")

Law = tuple[str, str, Callable[..., float], tuple[str, ...]]  # port, effect, function, names of its parameters


def _law_source(name: str, function: Callable[..., float]) -> str:
    source = textwrap.dedent(vars(function).get("source") or inspect.getsource(function))
    body = source[source.index("def ") :]
    options = ", ".join(f"{name}={value!r}" for name, value in (OPTIONS | NO_WRAPPERS).items())
    return f"@njit({options})\n" + body.replace(f"def {function.__name__}(", f"def {name}(", 1)


def _switch(port: str, laws: Sequence[Law]) -> str:
    given, default = PORT_ARGUMENTS[port], DEFAULTS.get(port, "0.0")
    typed = ", ".join(f"{name}: {'bool' if name == 'at_rest' else 'float'}" for name in given)
    lines = [f"@njit\ndef {port}_law(kind: int, {typed}, d: Numbers, k: int):"]
    sources = []
    for kind, (law_port, effect, function, parameters) in enumerate(laws):
        if law_port != port:
            continue
        name = f"{port}_{effect}"
        sources.append(_law_source(name, function))
        wanted = inspect.signature(function).parameters
        passed = [a if a in given else f"d[k + {parameters.index(a)}]" for a in wanted]
        lines += [f"    if kind == {kind}:", f"        return {name}({', '.join(passed)})"]
    lines.append(f"    return {default}")
    return "\n\n".join([*sources, "\n".join(lines)])


def plain(path: Path) -> str:
    """Read a kernel file without its imports, which the generated module brings itself, and without `at.`."""
    return PREFIX.sub("", without_imports(path))


class Compiled(ast.NodeTransformer):
    """Turn the kernels' annotations into signatures, so that each is compiled once, and make their indices unsigned.

    Args:
        entrances: kernels that Python calls.
    """

    def __init__(self, entrances: Sequence[str]) -> None:
        self.entrances = entrances

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.FunctionDef:
        """Replace the bare decorator of a kernel."""
        decorator = node.decorator_list[0]
        options = list(decorator.keywords) if isinstance(decorator, ast.Call) else []
        given = [option.arg for option in options]
        if "cache" in given:  # a law: its types come from the kernel that calls it
            return node
        self.generic_visit(node)
        signature = [_signature(node)]  # this removes the annotations, too
        every = OPTIONS if node.name in self.entrances else OPTIONS | NO_WRAPPERS
        options += [ast.keyword(name, ast.Constant(value)) for name, value in every.items()]
        signatures = [] if "inline" in given else signature
        node.decorator_list = [ast.Call(ast.Name("njit", ast.Load()), signatures, options)]
        return node

    def visit_ClassDef(self, node: ast.ClassDef) -> list[ast.stmt]:
        """Replace a bundle by a named tuple and the type that signatures name."""
        fields = [field for field in node.body if isinstance(field, ast.AnnAssign)]
        names = tuple(ast.unparse(field.target) for field in fields)
        types = ", ".join(_type_of(field.annotation) for field in fields)
        text = f"{node.name} = namedtuple({node.name!r}, {names!r})\n"
        return ast.parse(text + f"{node.name}{TYPE} = BaseTuple.from_types(({types}), {node.name})").body

    def visit_Subscript(self, node: ast.Subscript) -> ast.Subscript:
        """Make an index unsigned if it is computed."""
        self.generic_visit(node)
        if isinstance(node.slice, ast.Tuple):
            node.slice.elts = [_unsigned(index) for index in node.slice.elts]
        else:
            node.slice = _unsigned(node.slice)
        return node


def _signature(node: ast.FunctionDef) -> ast.expr:
    types = ", ".join(_type_of(a.annotation) for a in node.args.args if a.annotation is not None)
    for argument in node.args.args:
        argument.annotation = None
    node.returns = None
    return ast.parse(f"({types},)", mode="eval").body


def _type_of(annotation: ast.expr) -> str:
    name = ast.unparse(annotation)
    return TYPES.get(name, f"{name}{TYPE}")


def _unsigned(index: ast.expr) -> ast.expr:
    fixed = isinstance(index, ast.Constant | ast.Slice) or (isinstance(index, ast.Name) and index.id.isupper())
    return index if fixed else ast.Call(ast.Name("uint64", ast.Load()), [index], [])


def source_of(laws: Sequence[Law]) -> str:
    """Compose the text of the kernel with these laws in its switches, before signatures and unsigned indices are added."""
    here = Path(__file__).parent
    parts = [IMPORTS, plain(here / "layout.py")]
    parts += [_switch(port, laws) for port in PORT_ARGUMENTS]
    parts += [plain(here / file) for file in FILES]
    text = "\n\n".join(parts) + "\n"
    return text


def compose(laws: Sequence[Law]) -> ModuleType:
    """Compile the kernel for a catalogue's laws, or load it from the cache where it has been compiled before.

    Args:
        laws: all laws of the catalogue; `kind` is a law's index here.
    """
    return _compose(tuple(laws))


@lru_cache(maxsize=8)
def _compose(laws: tuple[Law, ...]) -> ModuleType:
    return _module(source_of(laws))


@lru_cache(maxsize=8)
def _module(text: str) -> ModuleType:
    own = "".join(Path(file).read_text(encoding="utf-8") for file in (__file__, INNER_PRODUCT))
    return generated_module(
        "flexarm_kernel",
        f"{numba.__version__}\n{own}\n{text}",
        lambda: ast.unparse(Compiled(ENTRANCES).visit(ast.parse(text))),
        lambda: logging.getLogger(__name__).warning("Compiling the plant, once for these effects: about 30 s"),
    )
