"""The help pages of the effects."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rich.console import RenderableType
from rich.text import Text

from flexarm_env.effects import Catalogue, Effect, catalogue
from flexarm_env.effects.catalogue import LAW_PORTS, is_of_file, load_effect
from flexarm_env.pictures import words
from flexarm_env.terminal import tables
from flexarm_env.terminal.delivery import deliver

_FIELDS = ("equation", "looks_like", "confused_with", "source", "needs")


def show(name: str | None, json: Path | None) -> None:
    """Print the catalogue, or one effect; write it as JSON where a file is named."""
    known = catalogue()
    if name is not None and is_of_file(name):
        effect = load_effect(name)
        known, name = known.extended(effect), effect.name
    chosen = list(known.values()) if name is None else [known[name]]
    parts = [_table(known)] if name is None else _page(known[name])
    deliver(json, {effect.name: _plain(effect) for effect in chosen}, parts)


def _table(known: Catalogue) -> RenderableType:
    rows = [[name, effect.equation, effect.looks_like] for name, effect in known.items()]
    return tables.text_table("Effects (flexarm effects NAME shows one)", ["name", "equation", "looks like"], rows)


def _page(effect: type[Effect]) -> Sequence[RenderableType]:
    columns = ["parameter", "unit", "typical", "absent at", "from", "to", "meaning"]
    rows = [
        [
            key,
            words.plain_unit(p.unit) or words.NOTHING,
            f"{p.typical:g}",
            words.NOTHING if p.null is None else f"{p.null:g}",
            f"{p.low:g}",
            f"{p.high:g}",
            p.meaning,
        ]
        for key, p in effect.parameters.items()
    ]
    facts = [
        ("looks like", effect.looks_like),
        ("confused with", ", ".join(effect.confused_with)),
        ("needs", ", ".join(effect.needs)),
        ("source", effect.source),
    ]
    heading = Text.assemble((effect.name, "bold"), f"\n{(effect.__doc__ or effect.__name__).strip().splitlines()[0]}")
    return [
        heading,
        Text(f"    {effect.equation}"),
        tables.text_table("Parameters", columns, rows),
        Text("\n".join(f"{key + ':':<15}{fact}" for key, fact in facts if fact)),
    ]


def _plain(effect: type[Effect]) -> dict[str, Any]:
    ports = [port for port in ("structure", *LAW_PORTS) if effect.port(port) is not None]
    parameters = {key: vars(p) for key, p in effect.parameters.items()}
    return {field: getattr(effect, field) for field in _FIELDS} | {"ports": ports, "parameters": parameters}
