"""An overview of recordings as short tables for a person."""

from __future__ import annotations

from rich.console import RenderableType
from rich.table import Table
from rich.text import Text

from flexarm_env.identify.inspect.overview import Overview
from flexarm_env.pictures import inspection_words
from flexarm_env.terminal.tables import table


def inspection(found: Overview) -> list[RenderableType]:
    """Make the tables of an overview: faults, recordings, signals, constants, effects."""
    lines = [Text(f"- {line}") for line in (*found.inspection.notes, *found.notes)]
    excited = found.excitation
    constants = table(
        "Constants: 90 % interval before and after a fit", inspection_words.CONSTANTS, inspection_words.constants(excited)
    )
    effects = table("Effects that the arm lacks", inspection_words.EFFECTS, inspection_words.effects(excited))
    return [
        Text(inspection_words.sentence(found), style="bold"),
        *([Text("\n").join(lines)] if lines else []),
        *(_facts(found) if found.recordings else []),
        *([_words(constants, 1, 3)] if excited.constants else []),
        *([_words(effects, 1, 4, 5)] if excited.effects else []),
        *map(Text, inspection_words.remarks(excited)),
    ]


def _facts(found: Overview) -> list[RenderableType]:
    extents, signals = (
        inspection_words.extents(found.recordings),
        inspection_words.signals(found.arm, found.recordings, found.inspection),
    )
    return [
        _words(table("Recordings", inspection_words.EXTENTS, extents), 4),
        _words(table("Signals", inspection_words.SIGNALS, signals), 1, 4),
    ]


def _words(made: Table, *columns: int) -> Table:
    """Align columns of words left."""
    for column in columns:
        made.columns[column].justify = "left"
    return made
