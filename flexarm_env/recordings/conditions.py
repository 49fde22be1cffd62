"""Conditions of a run, such as its payload, in the remarks before a file's header."""

from __future__ import annotations

import re

from flexarm_env import units
from flexarm_env.errors import InputError, nearest
from flexarm_env.recordings.messages import quoted

CONDITIONS = {"payload": "kg", "start": "s"}

# Possessive throughout, so that no line takes time that grows faster than its length.
_CONDITION = re.compile(r"([A-Za-z_]\w*+)\s*+(?>(?:\[([^\]]*+)\]\s*+|\(([^()]*+)\)\s*+)?)([=:])\s*+(.*+)")
_STATEMENT = re.compile(
    r"([A-Za-z_]\w*+)\s*+(?>(?:[\[(,;/]\s*+([A-Za-zµμ][^\]),;=:]*+)[\])]?+\s*+)?)"
    r"(?>(?:(?:is|was|of|->)(?!\w)|[=:,;]++)?)\s*+(.*+)"
)
_VALUE = re.compile(r"([+-]?+(?:\d++(?>(?:\.\d*+|,\d++)?)|\.\d++)(?>(?:[eE][+-]?+\d++)?))[\s,;]*+([A-Za-zµμ]*+)(.*+)")
#: What may follow a condition's name: "payload mass".
_ADDITION = re.compile(r"\A([A-Za-z]++)[\s_-]++(?:mass|weight)(?![A-Za-z])", re.IGNORECASE)
#: What follows the number of a date, a time, a version or a share.
_OF_A_DATE = re.compile(r"[-:./]\d")
_LONGEST_UNIT = 10
_MASS = r"(?:[km]?g|lbs?|oz)"
#: A payload with its mass anywhere in a remark, the unit after the number or before it.
_PAYLOAD = re.compile(rf"payload(?:\D{{0,30}}+\d[\d.,]*+\s*+{_MASS}\b|\W{{1,5}}{_MASS}\W{{1,5}}\d)", re.IGNORECASE)


def add_condition(line: str, conditions: dict[str, float]) -> dict[str, str]:
    """Add the condition that a line such as `# payload = 0.3 kg` or `# payload [kg]: 0.3` states. Other remarks are skipped.

    A unit stands in brackets or parentheses before the number, 1 for none. Empty cells at the end are a spreadsheet's padding.

    Args:
        line: the remark, with its mark.
        conditions: in SI by name; added to.

    Returns:
        By its name, a note on a condition that may be meant and cannot be read; nothing for other lines.

    Raises:
        InputError: for a condition that comes twice, is misspelt, has no right unit, or is written as a remark.
    """
    text = line.lstrip("#").rstrip(",; \t").strip()
    match = _CONDITION.fullmatch(text)
    if match is None or (match[4] == ":" and match[1] not in CONDITIONS):
        _check_remark(text)
        return _mentioned(text)
    name, unit = match[1], (match[2] or match[3] or "").strip()
    value = match[5] if unit in ("", "1") else f"{match[5]} {unit}"
    if name in conditions:
        raise InputError(f"condition {quoted(name)} comes twice; keep one of the two")
    check_spelling(name)
    if name in CONDITIONS and unit and not units.is_unit(unit) and units.is_quantity(match[5]) and units.split(match[5])[1]:
        raise InputError(f"{quoted(text)}: {quoted(unit)} is no unit; write '# {name} = {match[5]}'")
    if name in CONDITIONS:
        conditions[name] = units.quantity(value, CONDITIONS[name])
    elif units.is_quantity(value):
        try:
            conditions[name] = units.base_value(value)
        except InputError as error:  # "# trial = 3 good" is a remark
            return {name: f"{quoted(text)} is read as a remark: {error}"}
    elif fault := _fault(value.strip("\"'")):
        return {name: f"{quoted(text)} is read as a remark: {fault}"}
    else:
        return _mentioned(text)
    return {}


def _mentioned(text: str) -> dict[str, str]:
    """Make a note on a remark that tells of a payload amid other words, by its name."""
    if _PAYLOAD.search(text) is None:
        return {}
    return {"payload": f"{quoted(text)} is read as a remark: write '# payload = 0.3 kg' in a line of its own if it states it"}


def _fault(value: str) -> str:
    """Say why a value that begins as a quantity is none; "" for prose, a date or a time, which are no condition."""
    match = _VALUE.fullmatch(value)
    if match is None:
        return ""
    number, unit, rest = match.groups()
    if unit and not re.search(r"\s", rest) and "," not in number:
        return f"unknown unit {quoted(unit + rest)}"
    if (unit and not units.is_unit(unit)) or (not unit and _OF_A_DATE.match(rest)):
        return ""
    return (
        "it has a decimal comma; write a point" if "," in number else "write a number, with or without a unit, and nothing else"
    )


def unit_of(name: str, value: float) -> str:
    """Look up the unit of a condition, "" where none was stated."""
    return CONDITIONS.get(name, value.unit if isinstance(value, units.BaseValue) else "")


def check_spelling(name: str) -> None:
    """Refuse the name of a condition that misspells a known one, which would be lost.

    Raises:
        InputError: for such a name.
    """
    meant = None if name in CONDITIONS else _near(_ADDITION.sub(r"\1", name))
    if meant is not None:
        raise InputError(f"unknown condition {quoted(name)}; did you mean {quoted(meant)}?")


def _check_remark(text: str) -> None:
    """Refuse a remark such as "payload 0.3 kg" or "tip payload: 0.3 kg", which would be lost as a condition."""
    _, _, later = text.partition(" ")
    for part in (text, later.lstrip()):
        match = _STATEMENT.fullmatch(_ADDITION.sub(r"\1", part))
        name = _near(match[1]) if match else None
        value = _VALUE.fullmatch(f"{match[3]} {match[2] or ''}".strip()) if match and name else None
        if match is None or name is None or value is None:
            continue
        number, unit, rest = value[1].replace(",", "."), value[2], value[3]
        bare = not unit and not rest.strip(" ,;") and match[1].lower() == name
        if bare or (0 < len(unit) < _LONGEST_UNIT and _measures(unit, CONDITIONS[name])):
            raise InputError(f"{quoted(part)} is a remark; did you mean '# {name} = {number} {unit or CONDITIONS[name]}'?")


def _near(name: str) -> str | None:
    """Find the condition that a name misspells."""
    return nearest(name.lower(), CONDITIONS, cutoff=0.8)


def _measures(unit: str, target: str) -> bool:
    try:
        return units.converts(unit, target)
    except InputError:
        return False
