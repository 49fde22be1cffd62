"""The table: the share of servos whose compliance is named, and whose constants are found, against the goals."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from benchmarks.answers.figures import Answer, Figure, first, median, share
from benchmarks.answers.tables import against_goals, made_by, origin
from flexarm_env.files import write_whole

#: Largest deviations that count as right: of the resonance, of the delay [s], and of Coulomb friction.
RESONANCE, DELAY, FRICTION = 0.02, 1e-3, 0.1


def names_compliance(answer: Answer) -> bool:
    """Whether the gears' compliance is named first."""
    return first(answer) == "gear_compliance"


def found_value(answer: Answer, name: str) -> float:
    """Look up a constant of the corrected arm; NaN where it has none."""
    found = answer["found"]["constants"].get(name)
    return math.nan if found is None else float(found["value"])


def resonance_off(answer: Answer) -> float:
    """Compute the relative deviation of the frequency at which the link rings on its gears; NaN without a compliance."""
    stiffness, inertia = (found_value(answer, name) for name in ("gear_compliance_stiffness", "hub_inertia"))
    return abs(math.sqrt(stiffness / inertia) / (2.0 * math.pi) / answer["case"]["machine"]["resonance"] - 1.0)


def delay_off(answer: Answer) -> float:
    """Compute the deviation of the delay [s]."""
    return abs(found_value(answer, "input_delay_delay") - answer["case"]["machine"]["delay"])


def friction_off(answer: Answer) -> float:
    """Compute the relative deviation of Coulomb friction."""
    return abs(found_value(answer, "coulomb_torque") / answer["case"]["machine"]["coulomb"] - 1.0)


def figures(answers: Sequence[Answer]) -> list[Figure]:
    """Compute the lines of the table."""
    return [
        share("`gear_compliance` first", 0.95, answers, names_compliance),
        share("resonance within 2 %", 0.95, answers, lambda a: resonance_off(a) <= RESONANCE),
        share("delay within 1 ms", 0.95, answers, lambda a: delay_off(a) <= DELAY),
        share("Coulomb friction within 10 %", 0.95, answers, lambda a: friction_off(a) <= FRICTION),
        median("time of one core, median", "≤ 120 s", [a["cpu_seconds"] for a in answers], lambda v: v <= 120.0, "s"),
    ]


def misses(answers: Sequence[Answer]) -> list[str]:
    """Format the servos that were not found in all respects, as the lines of a table."""
    lines = ["| case | verdict | named | error | resonance off | delay off | friction off |", "|---|---|---|---:|---:|---:|---:|"]
    for answer in answers:
        found, off = answer["found"], (resonance_off(answer), delay_off(answer), friction_off(answer))
        if not (names_compliance(answer) and off[0] <= RESONANCE and off[1] <= DELAY and off[2] <= FRICTION):
            cells = (f"{100 * off[0]:.1f} %", f"{1e3 * off[1]:.2f} ms", f"{100 * off[2]:.1f} %")
            error = f"{found['error']['nominal']:.3g} → {found['error']['final']:.3g}"
            row = (answer["case"]["name"], found["verdict"], ", ".join(found["effects"]), error, *cells)
            lines.append(f"| {' | '.join(row)} |")
    return lines


def write(folder: Path, answers: Sequence[Answer], seed: int, command: str) -> list[Figure]:
    """Write table.md and table.json into a folder, with the commits that answered; return the figures."""
    folder.mkdir(parents=True, exist_ok=True)
    found, missed = figures(answers), misses(answers)
    made = f"Seed {seed}, {len(answers)} servos, answered by {made_by(answers)}: `{command}`"
    lines = ["# Elastic joints", "", made, "", *against_goals(found)]
    lines += ["", "Servos that were not found in all respects:", "", *missed] if len(missed) > 2 else []
    write_whole(folder / "table.md", "\n".join(lines) + "\n")
    stamp = {"command": command} | origin(answers) | {"seed": seed, "cases": len(answers)}
    write_whole(folder / "table.json", json.dumps(stamp | {"figures": [asdict(f) for f in found]}, indent=1) + "\n")
    return found
