"""The comparison of policies and controllers, as Markdown."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from agents.goals import THESIS, against_classical, against_thesis
from agents.markdown import origin_line, row, with_interval
from agents.report import COLUMNS

#: Task and set of the goals.
GOAL = ("slew", "randomised")


def report_of(result: Mapping[str, Any]) -> str:
    """Write the whole report: its origin, the goals, one table for each task and set."""
    lines = [
        "# Policies",
        "",
        origin_line(result),
        f"Interquartile means over {result['arms']} arms that no training saw and, for policies, over training runs, with 95 %",
        "bootstrap intervals in which runs and arms are drawn again; unsettled ones as means. An arm that never settles counts",
        "with the whole stretch. The worst tenth is the mean settling time of the slowest tenth of all episodes. Less is better",
        "everywhere. Tuned laws and policies were searched on other arms than these.",
        "",
        *_about(result["policies"]),
        "",
        *(f"- {name}: {value['meaning']} [{value['unit']}]" for name, value in result["measures"].items()),
        "",
        "## Goals",
        "",
        *_goals(result),
    ]
    for task, sets in result["tasks"].items():
        for arms, found in sets.items():
            lines += ["", f"## {task}, {arms}: {result['sets'][arms]}", "", *_rows(found["cells"], result["policies"])]
    return "\n".join(lines) + "\n"


def _about(policies: Mapping[str, Any]) -> list[str]:
    lines = [
        "| policy | algorithm | added to | pulses | runs | actions each | time each [s] |",
        "|---|---|---|---|---:|---:|---:|",
    ]
    for name, entry in policies.items():
        plan, runs = entry["plan"], entry["runs"]
        pulses = "yes" if plan["interface"]["pulse"] else "no"
        times = [run["seconds"] for run in runs]
        lines.append(
            f"| `{name}` | {plan['algorithm']} | {plan['interface']['base']} | {pulses} | {len(runs)} "
            f"| {runs[0]['actions'] / 1e6:.1f} M | {min(times):.0f} to {max(times):.0f} |"
        )
    return lines


def _goals(result: Mapping[str, Any]) -> list[str]:
    task, arms = GOAL
    lines = [
        f"On {task}, {arms}. Each measure is held against the controller that is best in that measure. P is the probability",
        "that a run of the policy does better than that controller on the same arm.",
        "",
        "| policy | measure | policy has | rival | rival has | less by | P | |",
        "|---|---|---:|---|---:|---:|---:|---|",
    ]
    for name, kinds in result["tasks"][task][arms]["verdicts"].items():
        for kind, say in (("thesis", against_thesis), ("classical", against_classical)):
            for verdict in kinds[kind]:
                goal = f"goal {100 * verdict['goal']:.0f} %: {say(verdict)}" if kind == "thesis" else f"of all: {say(verdict)}"
                fields = (
                    f"`{name}`",
                    verdict["measure"],
                    with_interval(verdict["policy"], 3),
                    f"`{verdict['rival']}`",
                    with_interval(verdict["rival_has"], 3),
                    f"{100 * verdict['less_by']:.0f} %",
                    _probability(verdict["improvement"]),
                    goal,
                )
                lines.append(row(fields))
    return lines


def _rows(cells: Mapping[str, Any], policies: Mapping[str, Any]) -> list[str]:
    head = ["", "", *(heading for _, heading, _ in COLUMNS), "worst tenth [s]"]
    lines = [row(head), "|---|---|" + "---:|" * (len(COLUMNS) + 1)]
    for name, cell in cells.items():
        learned = f"learned, n = {len(policies[name]['runs'])}" if name in policies else ""
        kind = learned or ("thesis" if name in THESIS else "classical")
        columns = (with_interval(cell[key], digits) for key, _, digits in COLUMNS)
        lines.append(row([f"`{name}`", kind, *columns, f"{cell['settling_time']['worst_tenth']:.2f}"]))
    return lines


def _probability(value: Mapping[str, float]) -> str:
    return f"{value['probability']:.2f} ({value['low']:.2f} to {value['high']:.2f})"
