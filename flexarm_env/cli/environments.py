"""The list of the registered environments."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rich.console import RenderableType
from rich.text import Text

from flexarm_env.arm import Arm
from flexarm_env.env.setup import Setup
from flexarm_env.env.variation import Variation, find_variation
from flexarm_env.errors import InputError
from flexarm_env.parameters import INPUTS
from flexarm_env.pictures import words
from flexarm_env.registration import IDS, SHAPED, VARIANTS
from flexarm_env.tasks import CONTROL_RATE
from flexarm_env.terminal import tables
from flexarm_env.terminal.delivery import deliver

_COLUMNS = ("id", "task", "drawn for each episode", "episode")


def show(arm_name: str, json: Path | None) -> None:
    """Print the environments that an arm can have; write them as JSON where a file is named.

    Raises:
        InputError: for an arm that can have none.
    """
    arm = Arm.load(arm_name)
    found: dict[str, dict[str, Any]] = {}
    refused: dict[str, InputError] = {}
    for id in sorted(IDS, key=lambda id: (IDS[id][1], id)):
        try:
            found[id] = _facts(id, arm)
        except InputError as error:
            refused[id] = error
    if not found:
        raise next(iter(refused.values()))
    rows = [
        [id, facts["task"], _drawn(facts["drawn"]), f"{facts['seconds']:g} s, {facts['steps']} steps"]
        for id, facts in found.items()
    ]
    parts: list[RenderableType] = [tables.text_table("Environments", _COLUMNS, rows), _common(next(iter(found.values())))]
    parts += [Text(f"Not with this arm: {', '.join(refused)} ({error})") for error in list(refused.values())[:1]]
    deliver(json, found, parts)


def _facts(id: str, arm: Arm) -> dict[str, Any]:
    task, variant = IDS[id]
    drawn, variation = find_variation(arm, VARIANTS[variant].get("randomise"), None)
    setup = Setup(task, drawn, variation)
    return {
        "task": task.summary,
        "arm": arm.name,
        "drawn": _ranges(drawn, variation) | _goals(VARIANTS[variant].get("goals")),
        "observation": [*arm.signals, "target"],
        "action": {"quantity": arm.input, "limit": setup.arm.constants["drive"]["limit"], "unit": INPUTS[arm.input]},
        "rate": CONTROL_RATE,
        "seconds": task.duration,
        "steps": setup.samples,
    }


def _ranges(arm: Arm, variation: Variation) -> dict[str, dict[str, Any]]:
    return {
        path.removeprefix("effects."): {"from": low, "to": high, "unit": arm.parameter(path).under(arm.input).unit}
        for path, low, high in variation.ranges
    }


def _goals(goals: tuple[float, float] | None) -> dict[str, dict[str, Any]]:
    return {} if goals is None else {"target": {"from": goals[0], "to": goals[1], "unit": "rad"}}


def _drawn(ranges: Mapping[str, Mapping[str, Any]]) -> str:
    each = [f"{path} {end['from']:.3g} to {end['to']:.3g} {words.plain_unit(end['unit'])}" for path, end in ranges.items()]
    return ", ".join(each) or words.NOTHING


def _common(facts: Mapping[str, Any]) -> Text:
    """Write down what all environments of an arm have in common."""
    action = facts["action"]
    lines = {
        "arm": facts["arm"],
        "observation": f"({len(facts['observation'])},): {', '.join(facts['observation'])}",
        "action": f"(1,): {action['quantity']}, from -1 to 1 for ±{action['limit']:g} {action['unit']}",
        "steps": f"{facts['rate']:g} per second",
        "as trained": f"{', '.join(SHAPED)}: observation, action and reward of the shipped policies",
    }
    return Text("\n".join(f"{name + ':':<13}{line}" for name, line in lines.items()))
