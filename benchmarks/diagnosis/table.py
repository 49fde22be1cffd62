"""Times and counts of diagnoses as lines and as Markdown."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

from benchmarks.diagnosis.count import PARTS

Found = Mapping[str, Any]


def totals(found: Found, what: str) -> Counter[str]:
    """Sum "calls" or "cpu_seconds" of the parts over the stages of a case."""
    sums: Counter[str] = Counter()
    for stage in found["stages"].values():
        sums.update(stage[what])
    return sums


def line(name: str, found: Found, before: Found | None) -> str:
    """Format a case in a line, with its time in the last stored run."""
    calls = totals(found, "calls")
    then = f", before {before['seconds']:.1f} s, CPU {before['cpu_seconds']:.1f} s" if before else ""
    return (
        f"{name}: {found['seconds']:.1f} s, CPU {found['cpu_seconds']:.1f} s{then}; {answer(found)}, error {found['error']:.3g}; "
        f"{calls['residual']} residuals, {calls['replay']} replays, {calls['plant']} plants"
    )


def answer(found: Found) -> str:
    """Format effects or verdict of a case."""
    return " + ".join(found["effects"]) or str(found["verdict"])


def lines(found: Mapping[str, Found], before: Mapping[str, Found]) -> list[str]:
    """Format stages and parts of all cases together, beside those of the last stored run."""
    shared = [name for name in found if name in before]
    rows = [f"{'stage':24}{'wall s':>9}{'before':>9}  residuals  before    replays  before"]
    now, then = _stages(found.values()), _stages(before[name] for name in shared)
    for stage, (seconds, calls) in now.items():
        old_seconds, old_calls = then.get(stage, (0.0, Counter()))
        rows.append(
            f"{stage:24}{seconds:9.1f}{old_seconds:9.1f}{calls['residual']:11}{old_calls['residual']:8}"
            f"{calls['replay']:11}{old_calls['replay']:8}"
        )
    rows += ["", f"{'part':34}{'calls':>9}{'before':>9}{'CPU s':>9}{'before':>9}"]
    for part in sorted({part for one in found.values() for part in totals(one, "calls")}, key=_order):
        counts = [sum(totals(one, "calls")[part] for one in some) for some in (found.values(), [before[n] for n in shared])]
        spent = [sum(totals(one, "cpu_seconds")[part] for one in some) for some in (found.values(), [before[n] for n in shared])]
        rows.append(f"{part:34}{counts[0]:9}{counts[1]:9}{spent[0]:9.1f}{spent[1]:9.1f}")
    if before:
        rows.append(f"before: {', '.join(shared) or 'none of these cases'}")
    return rows


def markdown(cases: Mapping[str, Found]) -> str:
    """Format all stored cases as a table."""
    rows = ["# Time of a diagnosis", "", "`python -m benchmarks --diagnosis`; a row has the commit that made it.", ""]
    rows += [
        "| case | hidden | answer | error | s | CPU s | residuals | replays | those of initial states | plants | load | commit |"
    ]
    rows += ["|---|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---|"]
    for name, found in cases.items():
        calls = totals(found, "calls")
        counts = " | ".join(str(calls[part]) for part in ("residual", "replay", "replay of initial state", "plant"))
        made = f"{found['load']:.1f} | {(found['commit'] or 'unknown')[:9]}"
        times = f"{found['seconds']:.1f} | {found['cpu_seconds']:.1f}"
        hidden = " + ".join(found["hidden"])
        rows.append(f"| {name} | {hidden} | {answer(found)} | {found['error']:.3g} | {times} | {counts} | {made} |")
    return "\n".join(rows) + "\n"


def _stages(cases: Any) -> dict[str, tuple[float, Counter[str]]]:
    sums: dict[str, tuple[float, Counter[str]]] = {}
    for case in cases:
        for stage, own in case["stages"].items():
            seconds, calls = sums.get(stage, (0.0, Counter()))
            sums[stage] = seconds + own["seconds"], calls + Counter(own["calls"])
    return sums


def _order(part: str) -> int:
    return next(place for place, name in enumerate(PARTS) if part.startswith(name)) + (len(PARTS) if " of " in part else 0)
