"""Display of results in a notebook. Figures lie in a higher layer and are imported when one is drawn."""

from __future__ import annotations

import importlib
from typing import Any

from flexarm_env.errors import InputError

_PICTURES = "flexarm_env.pictures.notebook"


class Shown:
    """Base of results with a table in a notebook and a figure by `plot`."""

    def _repr_html_(self) -> str:
        return str(importlib.import_module(_PICTURES).as_html(self))

    def plot(self) -> Any:
        """Draw a Plotly figure, which a notebook displays.

        Raises:
            InputError: where Plotly is not installed.
        """
        try:
            importlib.import_module("plotly")
        except ImportError:
            raise InputError("figures need plotly; pip install 'flexarm-env[plots]'") from None
        return importlib.import_module(f"{_PICTURES}_figures").figure_of(self)
