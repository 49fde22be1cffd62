"""The place of a case: a seed and an index, which determine it."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class Place:
    """The place of a case; a subclass poses the case.

    Attributes:
        seed: of the benchmark.
        index: from 0.
    """

    seed: int
    index: int

    @property
    def name(self) -> str:
        """Name of the case's file."""
        return f"{self.index:04d}"

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data."""
        return asdict(self) | {"name": self.name}
