"""The page of the gallery, written from its answers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from flexarm_env.pictures.words import number


def document(answers: Sequence[Mapping[str, Any]], pictures: str = "") -> str:
    """Write the table of all rigs, and a part on each.

    Args:
        answers: of the rigs, as plain data.
        pictures: the folder of their pictures with a slash, relative to the page.
    """
    return "\n".join([*summary(answers), "", *(line for one in answers for line in _section(one, pictures))])


def summary(answers: Sequence[Mapping[str, Any]]) -> list[str]:
    """Tabulate all rigs, a row each."""
    lines = [
        "| rig | measure | nominal | refitted | with effects | published | goal | missing |",
        "|---|---|---:|---:|---:|---:|---:|---|",
    ]
    for one in answers:
        figures, unit = one["figures"], one["unit"]
        values = [_value(figures[step], unit) for step in ("nominal", "refitted", "final")]
        best = _value(one["published"][-1]["value"], unit) if one["published"] else "–"
        goal = "–" if one["goal"] is None else f"{_value(one['goal'], unit)}{' ✓' if one['reached'] else ' ✗'}"
        found = ", ".join(f"`{name}`" for name in one["diagnosis"]["effects"]) or "nothing"
        row = [f"[{one['title']}](#{one['rig']})", one["metric"], *values, best, goal, found]
        lines.append(f"| {' | '.join(row)} |")
    return lines


def _section(one: Mapping[str, Any], pictures: str) -> list[str]:
    """Write the part on one rig."""
    found = one["diagnosis"]
    lines = [f"## {one['rig']}", "", f"{one['source']}. Arm `{one['arm']}`; verdict `{found['verdict']}`.", ""]
    lines += [f"- Diagnosed: {', '.join(one['training'])}.", f"- Held out: {', '.join(one['held_out'])}."]
    same = [group for group in found["equivalent"] if len(group) > 1]
    lines += [f"- These recordings cannot tell apart: {', '.join(f'`{name}`' for name in group)}." for group in same]
    lines += ["", f"| {one['metric']} | held out | in sample |", "|---|---:|---:|"]
    steps = {"nominal": "model as given", "refitted": "constants refitted", "final": "with effects"}
    for step, words in steps.items():
        values = [_value(one[part][step], one["unit"]) for part in ("figures", "in_sample")]
        lines.append(f"| {words} | {' | '.join(values)} |")
    lines += [f"| published: {each['model']} | {_value(each['value'], one['unit'])} | |" for each in one["published"]]
    lines += ["", "| constant | value | 90 % interval | unit |", "|---|---:|---:|---|"]
    for name, value in found["constants"].items():
        low, high = number(value["low"], 4), number(value["high"], 4)
        lines.append(f"| `{name}` | {number(value['value'], 4)} | {low} to {high} | {value.get('unit', '')} |")
    return [*lines, "", f"![{one['title']}]({pictures}{one['rig']}.png)", ""]


def _value(value: float | None, unit: str) -> str:
    return "–" if value is None else f"{number(value, 3)} {unit}"
