"""Libraries that only some formats need."""

from __future__ import annotations

import importlib
from typing import Any

from flexarm_env.errors import InputError


def library(name: str, kind: str) -> Any:
    """Import a module of the extra `logs`.

    Args:
        name: of the module.
        kind: of the file that needs it, for the message.

    Raises:
        InputError: where it is not installed.
    """
    try:
        return importlib.import_module(name)
    except ImportError:
        package = name.partition(".")[0]
        raise InputError(f"a {kind} is read by {package}, which is not installed; pip install 'flexarm-env[logs]'") from None
