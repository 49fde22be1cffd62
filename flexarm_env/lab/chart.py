"""A Plotly figure that is created and removed with its place: Plotly fails to resize an invisible one."""

from __future__ import annotations

from typing import Any

import plotly.graph_objects as go
from nicegui import html, ui


class Chart:
    """A place for one figure."""

    def __init__(self) -> None:
        self._place = html.div()
        self._plot: Any = None
        self._ready = False

    def show(self, figure: go.Figure) -> None:
        """Draw a figure in place of the previous one."""
        if self._plot is None:
            with self._place:
                self._plot = ui.plotly(figure).classes("plot")
            self._plot.on("plotly_afterplot", self._drawn, args=[], throttle=1.0)
        else:
            self._plot.update_figure(figure)

    def restyle(self, *changes: Any) -> bool:
        """Change some traces, with the arguments of Plotly's restyle; return False if the browser has drawn none yet."""
        if self._ready:
            self._plot.run_plot_method("restyle", *changes)
        return self._ready

    def _drawn(self) -> None:
        self._ready = True

    def clear(self) -> None:
        """Remove the figure."""
        self._place.clear()
        self._plot, self._ready = None, False
