"""Learning curves of stored policies, as a picture."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from agents.learning.artefact import Artefact
from flexarm_env.files import write_whole


def draw_curves(policies: Mapping[str, Sequence[Artefact]], path: Path) -> None:
    """Draw the mean return against actions, one panel for each configuration: every run, and the middle one thick."""
    from matplotlib.figure import Figure

    columns = min(len(policies), 3)
    rows = -(-len(policies) // columns)
    figure = Figure(figsize=(4.2 * columns, 2.9 * rows), layout="constrained")
    panels = np.atleast_1d(figure.subplots(rows, columns, squeeze=False)).ravel()
    for panel, (name, runs) in zip(panels, policies.items(), strict=False):
        curves = [np.array(run.run["curve"], dtype=float).reshape(-1, 2) for run in runs]
        for curve in curves:
            panel.plot(curve[:, 0] / 1e6, curve[:, 1], color="#7aa6d6", linewidth=0.8)
        grid = max(curves, key=len)[:, 0]
        middle = np.median([np.interp(grid, curve[:, 0], curve[:, 1]) for curve in curves], axis=0)
        panel.plot(grid / 1e6, middle, color="#12395b", linewidth=2.0)
        panel.set_title(f"{name}: {len(runs)} run{'s' if len(runs) > 1 else ''}", fontsize=10)
        panel.set_xlabel("actions [10⁶]")
        panel.set_ylabel("mean return of an episode")
        panel.grid(alpha=0.3)
    for panel in panels[len(policies) :]:
        panel.remove()
    picture = io.BytesIO()
    figure.savefig(picture, dpi=110, metadata={"Software": None})
    write_whole(path, picture.getvalue())
