"""What all tests share: the measured recordings, the hypothesis profile, and slow tests last."""

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
    items.sort(key=lambda item: item.get_closest_marker("slow") is not None)


@pytest.fixture(scope="session")
def measurements() -> Path:
    """The folder of recordings measured on real rigs, which lies beside the project and not in it."""
    folder = PROJECT.parent / "shared" / "measurements"
    if not folder.is_dir():
        pytest.skip(f"the measured recordings are not here: no folder {folder}")
    return folder
