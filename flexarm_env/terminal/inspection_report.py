"""The page of an overview of recordings, written to a file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from flexarm_env.files import write_whole
from flexarm_env.identify.inspect.overview import Overview


def write_inspection(path: Path, found: Overview, provenance: Mapping[str, Any]) -> None:
    """Write the page, whole or not at all.

    Raises:
        InputError: if the file cannot be written.
    """
    from flexarm_env.pictures.inspection_page import inspection_page

    write_whole(path, inspection_page(found, provenance))
