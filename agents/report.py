"""The tables of an evaluation, as Markdown."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from agents.markdown import origin_line, row, with_interval

#: Measure, heading and digits of the columns.
COLUMNS = (
    ("settling_time", "settling [s]", 2),
    ("unsettled", "unsettled [%]", 0),
    ("overshoot", "overshoot [°]", 1),
    ("steady_error", "steady error [°]", 2),
    ("residual_strain", "residual strain [V]", 3),
    ("peak_current", "peak [A]", 1),
    ("energy", "energy [A² s]", 1),
)
#: Controllers and sets of the short table: the thesis's, the best as designed by hand, and two as tuned.
SHORT = ("pd", "lqg_scheduled", "pid_compensated_tuned", "mpc_tuned")
SHORT_SETS = ("nominal", "randomised")


def table_of(result: Mapping[str, Any]) -> str:
    """Write the whole report: one table for each task and set, with 95 % intervals."""
    lines = [
        "# Baselines",
        "",
        origin_line(result),
        f"Means over {result['arms']} arms, the same for every controller, with 95 % bootstrap intervals over arms. An arm",
        "that never settles counts with the whole stretch; the worst tenth is the mean settling time of the slowest tenth of the",
        "arms. Less is better everywhere. Tuned controllers were searched on other arms than these.",
        "",
        *(f"- `{name}`: {meaning}" for name, meaning in result["controllers"].items()),
        "",
        *(f"- {name}: {value['meaning']} [{value['unit']}]" for name, value in result["measures"].items()),
    ]
    for task, sets in result["cells"].items():
        for arms, cells in sets.items():
            lines += ["", f"## {task}, {arms}: {result['sets'][arms]}", "", *_rows(cells)]
    return "\n".join(lines) + "\n"


def _rows(cells: Mapping[str, Any]) -> list[str]:
    head = ["controller", *(heading for _, heading, _ in COLUMNS), "worst tenth [s]"]
    rows = [row(head), "|---|" + "---:|" * (len(COLUMNS) + 1)]
    for name, cell in cells.items():
        columns = (with_interval(cell[key], digits) for key, _, digits in COLUMNS)
        rows.append(row([f"`{name}`", *columns, f"{cell['settling_time']['worst_tenth']:.2f}"]))
    return rows


def summary_of(result: Mapping[str, Any], task: str = "slew") -> str:
    """Write a short table for README.md: settling, steady error and residual strain of one task."""
    columns = (("settling_time", "settling [s]", 2), ("steady_error", "error [°]", 2), ("residual_strain", "strain [V]", 3))
    head = ["controller", *(f"{arms}: {heading}" for arms in SHORT_SETS for _, heading, _ in columns)]
    lines = [row(head), "|---|" + "---:|" * (len(head) - 1)]
    for name in SHORT:
        cells = [result["cells"][task][arms][name] for arms in SHORT_SETS]
        values = [f"{cell[key]['mean']:.{digits}f}" for cell in cells for key, _, digits in columns]
        lines.append(row([f"`{name}`", *values]))
    return "\n".join(lines) + "\n"
