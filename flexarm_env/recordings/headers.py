"""The columns of a header: FlexArm's own, as it is or refined by a column map, or any other by a map."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from flexarm_env import units
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.recordings.cells import cut
from flexarm_env.recordings.columns import ColumnMap, Source, native_sources
from flexarm_env.recordings.messages import quoted

_MOST_SHOWN = 6


def header_sources(header: Sequence[str], layout: ColumnMap, row: str = "") -> dict[str, Source]:
    """Find the sources in a header, with column numbers as their places.

    Args:
        header: its cells; [] where a map of column numbers needs none.
        layout: the file's column map; without sources for FlexArm's own header.
        row: the header's place for messages, such as "row 1"; "" where a format has no rows.

    Raises:
        InputError: for a header that is not FlexArm's own where the map gives no places, and for a column that it lacks.
    """
    at = f"{row}, " if row else ""
    if layout.refines:
        return _refined(header, layout, at)
    texts = [cell.strip() for cell in header]
    sources: dict[str, Source] = {}
    for name, source in layout.sources.items():
        place = source.place
        if isinstance(place, str):
            if texts.count(place.strip()) > 1:
                raise InputError(f"{at}column '{name}': the header has {quoted(place)} twice; use 'index'")
            if place.strip() not in texts:
                raise InputError(f"{at}column '{name}': no {quoted(place)} in the header{absence(place, texts)}")
            place = texts.index(place.strip())
        twin = next((other for other in sources if sources[other].place == place), None)
        if twin:
            raise InputError(f"columns '{twin}' and '{name}': both map to column {place}; correct one of them")
        sources[name] = replace(source, place=place, key="index")
    return sources


def states_units(line: str, header: Sequence[str], row: int, layout: ColumnMap) -> bool:
    """Whether the line under a header has a unit, in brackets or not, in every cell that is not empty.

    Args:
        line: of the file.
        header: its cells.
        row: the header's line in the file, counted from 1.
        layout: the file's column map.

    Raises:
        InputError: for a unit that is not that of the column map.
    """
    cells = [cell.strip(" \t[]()") for cell in cut(line, layout.delimiter)]
    if not any(cells) or any(cell not in ("", "-") and not units.is_unit(cell) for cell in cells):
        return False
    for name, source in header_sources(header, layout, f"row {row}").items():
        place = int(source.place)
        stated = cells[place] if place < len(cells) else ""
        if stated not in ("", "-", source.unit) and not units.are_equal(stated, source.unit):
            raise InputError(
                f"row {row + 1}, column '{name}': the file states {quoted(stated)}, but [columns] has {quoted(source.unit)}; "
                "correct the one that is wrong"
            )
    return True


def _refined(header: Sequence[str], layout: ColumnMap, at: str) -> dict[str, Source]:
    """Read FlexArm's own header, and replace in it the units, signs and scales that a map gives."""
    own = native_sources(header)
    for name, source in layout.sources.items():
        if name not in own:
            raise InputError(f"{at}no column '{name}', which [columns] refines; the header has {', '.join(own)}")
        own[name] = replace(source, place=own[name].place, unit=source.unit or own[name].unit, key="index")
    return own


def absence(text: str, texts: Sequence[str]) -> str:
    """Say what a header has in place of a text: the nearest, or the first ones."""
    if len(texts) == 1:
        return f", which is one column, {quoted(texts[0])}: is the delimiter right?"
    near = did_you_mean(text, [other[:40] for other in texts[:20]])
    if "did you mean" in near:
        return near
    more = f" and {len(texts) - _MOST_SHOWN} more" if len(texts) > _MOST_SHOWN else ""
    return f", which has {', '.join(map(quoted, texts[:_MOST_SHOWN]))}{more}"
