"""Copies of a recording, which would count as evidence twice."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from flexarm_env.recordings.recording import Recording


def with_copies_noted(recordings: Sequence[Recording]) -> list[Recording]:
    """Note on each recording that has the commands and readings of an earlier one; those in which nothing changes say nothing.

    Args:
        recordings: of one machine.
    """
    first: dict[bytes, str] = {}
    noted = []
    for one in recordings:
        earlier = first.setdefault(_digest(one), one.name) if _changes(one) else one.name
        note = f"has every row of '{earlier}', and counts beside it: is it a copy? leave one out"
        noted.append(one if earlier == one.name else replace(one, notes=(*one.notes, note)))
    return noted


def _changes(recording: Recording) -> bool:
    """Whether any signal has two different readings."""
    return any(len(known) and np.ptp(known) > 0.0 for known in (v[np.isfinite(v)] for v in recording.signals.values()))


def _digest(recording: Recording) -> bytes:
    """Compute the checksum of commands and readings, in the order of the signals' names."""
    found = hashlib.sha256(recording.command.tobytes())
    for signal, values in sorted(recording.signals.items()):
        found.update(signal.encode())
        found.update(values.tobytes())
    return found.digest()
