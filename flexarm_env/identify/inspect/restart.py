"""A clock that starts again within a file, which therefore cannot be read as one recording."""

from __future__ import annotations

from pathlib import Path

from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.recordings.clock import RestartError


def restart(error: RestartError) -> Fault:
    """Make the fault of a file that was refused because its clock starts again."""
    name, source = Path(error.source).stem, error.source
    message = str(error).removeprefix(f"{source}: ")
    return Fault(name, source, "time", "restart", error.before, "s", message, rows=(error.sample,), share=0.0)
