"""What all tests share: the measured recordings, the hypothesis profile, and slow tests last, of which the longest first."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import settings

PROJECT = Path(__file__).resolve().parent.parent

# Compiling a kernel breaks any deadline. CI must give the same verdict on the same commit.
settings.register_profile("flexarm", deadline=None, derandomize="CI" in os.environ, print_blob=True)
settings.load_profile("flexarm")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    items.sort(key=_order)


def _order(item: pytest.Item) -> tuple[bool, float]:
    slow = item.get_closest_marker("slow")
    return slow is not None, -slow.kwargs.get("minutes", 0.0) if slow else 0.0


@pytest.fixture(scope="session")
def measurements() -> Path:
    """The folder of recordings measured on real rigs, which lies beside the project and not in it."""
    folder = PROJECT.parent / "shared" / "measurements"
    if not folder.is_dir():
        pytest.skip(f"the measured recordings are not here: no folder {folder}")
    return folder
