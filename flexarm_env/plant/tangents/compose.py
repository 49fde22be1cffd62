"""The compiled kernel of derivatives, beside the plant's for the same laws: compiled where derivatives are asked for."""

from __future__ import annotations

import ast
import logging
from functools import lru_cache
from pathlib import Path
from types import ModuleType

import numba

from flexarm_env.generated import generated_module
from flexarm_env.plant.compose import IMPORTS, Compiled, plain

ENTRANCES = ("tangent_numbers", "tangent_rows", "steady_rows", "replay_with_lanes")
FILES = (
    "bundles.py",
    "response.py",
    "motion.py",
    "laws.py",
    "collocation.py",
    "steady.py",
    "events.py",
    "steps.py",
    "control_step.py",
    "replay.py",
)


@lru_cache(maxsize=8)
def tangent_kernel(kernel: ModuleType) -> ModuleType:
    """Compile the derivatives' kernel for a plant's, or load it from the cache where it has been compiled before."""
    here = Path(__file__).parent
    parts = [IMPORTS, f"from {kernel.__name__} import *", *(plain(here / file) for file in FILES)]
    text = "\n\n".join(parts) + "\n"
    own = Path(__file__).read_text(encoding="utf-8")
    return generated_module(
        "flexarm_tangents",
        f"{numba.__version__}\n{own}\n{text}",
        lambda: ast.unparse(Compiled(ENTRANCES).visit(ast.parse(text))),
        lambda: logging.getLogger(__name__).warning("Compiling the derivatives, once for these effects: about 90 s"),
    )
