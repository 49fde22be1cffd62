"""The comparison on other machines, as Markdown."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from agents.markdown import origin_line, row, with_interval

#: Measure, heading and digits of the columns of one set.
COLUMNS = (
    ("unsettled", "unsettled [%]", 0),
    ("settling_time", "settling [s]", 2),
    ("steady_error", "steady error [°]", 2),
    ("residual_strain", "residual strain [V]", 3),
)


def report_of(result: Mapping[str, Any]) -> str:
    """Write the whole report: failures and settling times over all sets, the verdicts, one table for each set."""
    lines = [
        "# Robustness",
        "",
        origin_line(result),
        f"The slew over 100° on {result['arms']} arms in each set, the same for all: payload 0 to 0.3 kg, constants ±10 %,",
        "friction ±20 %, and one thing more. Neither controllers nor policies were told of it, but for the control rate, for",
        "which each was made again. Means with 95 % bootstrap intervals, in which runs and arms are drawn again. An arm that",
        "never settles counts with 5 s. Less is better everywhere. Tuned controllers were searched on other arms; play of the",
        "gears and lost sensors were no part of the search.",
        "",
        *(f"- `{name}`: {meaning}" for name, meaning in result["sets"].items()),
        "",
        "## Arms that do not settle [%]",
        "",
        *_over_sets(result, "unsettled", 0),
        "",
        "## Settling time [s]",
        "",
        *_over_sets(result, "settling_time", 2),
        "",
        "## Best policy and best controller",
        "",
        *_verdicts(result),
    ]
    for arms, cells in result["cells"].items():
        lines += ["", f"## {arms}: {result['sets'][arms]}", "", *_rows(cells)]
    return "\n".join(lines) + "\n"


def _over_sets(result: Mapping[str, Any], measure: str, digits: int) -> list[str]:
    sets = list(result["cells"])
    lines = [row(["", "runs", *sets]), "|---|---:|" + "---:|" * len(sets)]
    for name in result["cells"][sets[0]]:
        cells = [result["cells"][arms][name] for arms in sets]
        lines.append(row([f"`{name}`", str(cells[0]["runs"]), *(f"{c[measure]['mean']['value']:.{digits}f}" for c in cells)]))
    return lines


def _verdicts(result: Mapping[str, Any]) -> list[str]:
    lines = [
        "Each is the best of its kind in the set by the geometric mean of settling time, error and strain. P is the probability",
        "that the policy does better on the same arm.",
        "",
        "| set | policy | controller | geometric mean less by | P | P of settling | P of error | P of strain |",
        "|---|---|---|---:|---:|---:|---:|---:|",
    ]
    for arms, verdict in result["verdicts"].items():
        if verdict is not None:
            each = (with_interval(found, 2) for found in verdict["probability"].values())
            names = (f"`{verdict[kind]}`" for kind in ("policy", "controller"))
            lines.append(row([arms, *names, f"{100.0 * verdict['less_by']:.0f} %", *each]))
    return lines


def _rows(cells: Mapping[str, Any]) -> list[str]:
    heads = [part for _, heading, _ in COLUMNS for part in (heading, "worst tenth")]
    lines = [row(["", "runs", *heads]), "|---|---:|" + "---:|" * len(heads)]
    for name, cell in cells.items():
        parts = [with_interval(cell[key][what], digits) for key, _, digits in COLUMNS for what in ("mean", "worst_tenth")]
        lines.append(row([f"`{name}`", str(cell["runs"]), *parts]))
    return lines
