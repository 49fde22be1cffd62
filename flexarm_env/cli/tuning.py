"""The command that tunes a controller."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import typer
from rich.console import RenderableType
from rich.text import Text

from flexarm_env.arm import Arm
from flexarm_env.cli.answers import hand_out
from flexarm_env.controllers.tuned import TunedController
from flexarm_env.terminal import tables
from flexarm_env.terminal.progress import progress
from flexarm_env.tuning.search import Budget, first_values, measured_margins, tune
from flexarm_env.tuning.spaces import nested, space_of

MARGINS = {
    "gain": ("gain may rise by", "×"),
    "less_gain": ("gain may fall to", "×"),
    "phase": ("phase margin", "°"),
    "delay": ("dead time that it stands", "s"),
    "modulus": ("least distance from −1", ""),
}


def run(
    controller: str,
    arm: Arm,
    named: str,
    budget: Budget,
    start: Path | None,
    places: tuple[Path | None, Path | None, Path | None],
) -> None:
    """Search, write the controller's file, and print what was found.

    Args:
        controller: name of the law.
        arm: on which it is tuned.
        named: the arm, as the user gave it.
        budget: of the search.
        start: file of the controller whose values are tried first; the law's own by default.
        places: for the file, for the journal, for the JSON.
    """
    save, journal, json = places
    begun = None if start is None else TunedController.load(start)
    before = first_values(controller, arm, space_of(controller), begun)
    with progress(f"tuning {controller}") as move:

        def report(done: int, least: float) -> None:
            if move is not None:
                move(done / budget.trials, f"{done} of {budget.trials}, {least:.3f}")

        found = tune(controller, arm, budget, journal, report, begun)
    if save is not None:
        found.save(save)
    old = measured_margins(controller, arm, nested(before))
    content = {"controller": controller, "options": found.options, "search": found.search, "margins": found.margins}
    hand_out("tune", named, [], budget.seed, json, content | {"margins_before": old}, _parts(found, before, old))
    if save is None:
        typer.echo("Not written; --save FILE.toml keeps the controller.", err=True)


def _parts(found: TunedController, before: dict[str, float], old: dict[str, Any]) -> list[RenderableType]:
    flat = {f"design.{name}": value for name, value in found.options.get("design", {}).items()}
    flat |= {name: value for name, value in found.options.items() if name != "design"}
    rows = [[name, f"{before[name]:.4g}", f"{value:.4g}"] for name, value in flat.items()]
    parts: list[RenderableType] = [tables.table("Options", ["", "before", "tuned"], rows)]
    rows = [
        [f"{label} [{unit}]" if unit else label, _number(old.get(name)), _number(found.margins.get(name))]
        for name, (label, unit) in MARGINS.items()
    ]
    parts.append(tables.table("Margins of the moving arm", ["", "before", "tuned"], rows))
    search = found.search
    line = f"Score {search['score_before']:.3f}, tuned {search['score']:.3f}: mean logarithm of settling time, error and strain"
    parts.append(Text(f"{line}, over {search['arms']} arms in each of {len(search['cells'])} cells and their worst tenth."))
    if not found.margins:
        parts.append(Text("The tuned loop is stable only with the arm's dry friction: it has no margins."))
    return parts


def _number(value: float | None) -> str:
    return "none" if value is None else f"{value:.4g}"
