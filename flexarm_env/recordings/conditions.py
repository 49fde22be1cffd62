"""Conditions of a run, such as its payload, in the remarks before a file's header."""

from __future__ import annotations

import difflib
import re

from flexarm_env import units
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.recordings.messages import quoted

CONDITIONS = {"payload": "kg", "start": "s"}

# Possessive throughout, so that no line takes time that grows faster than its length.
_CONDITION = re.compile(r"([A-Za-z_]\w*+)\s*+(?:\[([^\]]*+)\]\s*+)?([=:])\s*+(.*+)")
_STATEMENT = re.compile(r"([A-Za-z_]\w*+)\s*+(?:\[([^\]]*+)\]\s*+)?(?:(?:is|was|of|->)(?!\w)|[=:]++)?+\s*+(.*+)")
_VALUE = re.compile(r"([+-]?+(?:\d++(?:[.,]\d*+)?+|\.\d++)(?:[eE][+-]?+\d++)?+)\s*+([A-Za-zµμ]*+)(.*+)")
_LONGEST_UNIT = 10


def add_condition(line: str, conditions: dict[str, float]) -> str:
    """Add the condition that a line such as `# payload = 0.3 kg` or `# payload [kg]: 0.3` states. Other remarks are skipped.

    Args:
        line: the remark, with its mark.
        conditions: in SI by name; added to.

    Returns:
        A note on a line that may be meant as a condition and is none, else "".

    Raises:
        InputError: for a condition that comes twice, is misspelt, has no right unit, or is written as a remark.
    """
    text = line.lstrip("#").strip()
    match = _CONDITION.fullmatch(text)
    if match is None or (match[3] == ":" and match[1] not in CONDITIONS):
        _check_remark(text)
        return ""
    name, value = match[1], f"{match[4]} {match[2] or ''}".strip()
    if name in conditions:
        raise InputError(f"condition {quoted(name)} comes twice; keep one of the two")
    check_spelling(name)
    if name in CONDITIONS:
        conditions[name] = units.quantity(value, CONDITIONS[name])
    elif units.is_quantity(value):
        try:
            conditions[name] = units.base_value(value)
        except InputError as error:  # "# trial = 3 good" is a remark
            return f"{quoted(text)} is read as a remark: {error}"
    elif (number := _VALUE.fullmatch(value)) and number[2] and not re.search(r"\s", number[3]):
        return f"{quoted(text)} is read as a remark: unknown unit {quoted(number[2] + number[3])}"
    return ""


def unit_of(name: str, value: float) -> str:
    """Look up the unit of a condition, "" where none was stated."""
    return CONDITIONS.get(name, value.unit if isinstance(value, units.BaseValue) else "")


def check_spelling(name: str) -> None:
    """Refuse the name of a condition that misspells a known one, which would be lost.

    Raises:
        InputError: for such a name.
    """
    if name not in CONDITIONS and _near(name):
        raise InputError(f"unknown condition {quoted(name)}{did_you_mean(name.lower(), CONDITIONS)}")


def _check_remark(text: str) -> None:
    """Refuse a remark such as "payload 0.3 kg" or "tip payload: 0.3 kg", which would be lost as a condition."""
    _, _, later = text.partition(" ")
    for part in (text, later.lstrip()):
        match = _STATEMENT.fullmatch(part)
        name = _near(match[1]) if match else None
        value = _VALUE.fullmatch(f"{match[3]} {match[2] or ''}".strip()) if match and name else None
        if match is None or name is None or value is None:
            continue
        number, unit, rest = value[1].replace(",", "."), value[2], value[3]
        bare = not unit and not rest.strip() and match[1].lower() == name
        if bare or (0 < len(unit) < _LONGEST_UNIT and _measures(unit, CONDITIONS[name])):
            raise InputError(f"{quoted(part)} is a remark; did you mean '# {name} = {number} {unit or CONDITIONS[name]}'?")


def _near(name: str) -> str | None:
    """Find the condition that a name misspells."""
    return next(iter(difflib.get_close_matches(name.lower(), CONDITIONS, n=1, cutoff=0.8)), None)


def _measures(unit: str, target: str) -> bool:
    try:
        return units.converts(unit, target)
    except InputError:
        return False
