"""The page of an overview: faults on top, then the signals, then what the recordings can show."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.overview import Overview
from flexarm_env.pictures import inspection_figures, inspection_words, words
from flexarm_env.pictures.document import bullets, document, figure, paragraph, section, table
from flexarm_env.pictures.provenance_section import reproduce


def inspection_page(found: Overview, provenance: Mapping[str, Any]) -> str:
    """Build the page's HTML.

    Args:
        found: on the recordings.
        provenance: "command_line", "version" and "commit", which reproduce the page.
    """
    faults, recordings = found.inspection.faults, found.recordings
    parts = [
        paragraph(inspection_words.sentence(found), "verdict"),
        section("Faults of the recordings", faults_table(faults)) if faults else "",
        bullets(found.notes),
        _facts(found) if recordings else "",
        _constants(found),
        _effects(found),
        reproduce(provenance, recordings),
    ]
    of = words.counted(len(recordings), "recording") if recordings else "A recording at fault"
    return document(f"{of} for arm {found.arm.name}", parts)


def faults_table(faults: Sequence[Fault]) -> str:
    """Format the faults, each with its size and the line that mends it."""
    return table(words.FAULT_COLUMNS, words.fault_rows(faults), words=len(words.FAULT_COLUMNS), code=(5,))


def _facts(found: Overview) -> str:
    signals = inspection_words.signals(found.arm, found.recordings, found.inspection)
    extents = table(inspection_words.EXTENTS, inspection_words.extents(found.recordings))
    listed = table(inspection_words.SIGNALS, signals, words=2)
    return section("Recordings", extents) + section("Signals", listed, *_recordings(found))


def _recordings(found: Overview) -> list[str]:
    parts = []
    for one in found.recordings:
        drawn = inspection_figures.signals(one, found.inspection.faults)
        parts.append(f"<h3>Recording {escape(one.name)}</h3>{figure(drawn, f'recording-{one.name}')}")
    return parts


def _constants(found: Overview) -> str:
    constants = found.excitation.constants
    if not constants:
        return ""
    caption = "Grey: before a fit. Blue circles: after it, where the recordings show the constant. Orange crosses: where not."
    drawn = figure(inspection_figures.constants(constants), "constants", "", caption)
    rows = table(inspection_words.CONSTANTS, inspection_words.constants(found.excitation), words=2)
    return section("Constants that a fit would show", bullets(inspection_words.remarks(found.excitation)), drawn, rows)


def _effects(found: Overview) -> str:
    effects = found.excitation.effects
    if not effects:
        return ""
    caption = "Left of the dotted line, an effect of typical size shows. Effects that are not excited are in the table alone."
    drawn = figure(inspection_figures.effects(effects), "effects", "", caption)
    rows = table(inspection_words.EFFECTS, inspection_words.effects(found.excitation), words=2)
    return section("Effects that would show", drawn, rows)
