"""The record of a run: all parts of an environment together, and the table of all environments."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

from benchmarks.endurance.parts import ARMS

#: Longest call over the median call, of one part: the promise.
MOST = 1000.0
#: Characters of a line of a document.
WIDTH = 124
HEADS = (
    *("environment", "disturbed", "steps", "episodes", "median call [ms]", "slowest call [ms]", "its CPU time [ms]"),
    *("slowest over median", "not finite"),
)


def record(outcomes: Sequence[Mapping[str, Any]], hung: str) -> dict[str, Any]:
    """Sum outcomes by environment.

    Args:
        outcomes: parts with what came of them, at least one.
        hung: name of a part that did not end; "" for none.
    """
    keys = dict.fromkeys((each["id"], each["disturbed"]) for each in outcomes)
    cases = [_case([each for each in outcomes if (each["id"], each["disturbed"]) == key]) for key in keys]
    return {
        "arms": ARMS,
        "steps": sum(case["steps"] for case in cases),
        "episodes": sum(case["episodes"] for case in cases),
        "seconds": round(sum(case["seconds"] for case in cases), 1),
        "not_finite": [f"{case['id']}: {found}" for case in cases for found in case["not_finite"]],
        "hung": hung,
        "slowest_over_median": max(case["slowest_over_median"] for case in cases),
        "most": MOST,
        "environments": cases,
    }


def _case(outcomes: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    worst = max(outcomes, key=lambda each: each["slowest"] / each["median"])
    calls, seconds = sum(each["calls"] for each in outcomes), sum(each["seconds"] for each in outcomes)
    return {
        "id": worst["id"],
        "disturbed": worst["disturbed"],
        "steps": calls * ARMS,
        "episodes": sum(each["episodes"] for each in outcomes),
        "seconds": round(seconds, 2),
        "median_ms": round(1e3 * worst["median"], 4),
        "slowest_ms": round(1e3 * worst["slowest"], 2),
        "slowest_cpu_ms": round(1e3 * worst["slowest_cpu"], 2),
        "slowest_over_median": round(worst["slowest"] / worst["median"], 1),
        "not_finite": [each["not_finite"] for each in outcomes if each["not_finite"]],
    }


def kept(result: Mapping[str, Any]) -> bool:
    """Whether the promise was kept by the steps that were taken."""
    return not result["not_finite"] and not result["hung"] and bool(result["slowest_over_median"] <= result["most"])


def words(result: Mapping[str, Any]) -> str:
    """Say in a paragraph what came of a run."""
    worst = max(result["environments"], key=lambda case: case["slowest_over_median"])
    finite = f"not finite: {'; '.join(result['not_finite'])}" if result["not_finite"] else "all of them finite"
    hung = f"`{result['hung']}` hung" if result["hung"] else "none hung"
    ids = len({case["id"] for case in result["environments"]})
    sentences = (
        f"{result['steps']:,} steps over {ids} ids, half of them disturbed, seed {result['seed']}, with {result['episodes']:,}"
        f" ends of episodes, took {result['seconds']:.0f} s of one core: observations, rewards and states {finite}, and {hung}."
        f" The slowest call took {worst['slowest_over_median']:.0f} times the median one, resets included (`{worst['id']}`;"
        f" allowed are {result['most']:.0f})."
    )
    return textwrap.fill(sentences, WIDTH, break_long_words=False, break_on_hyphens=False) + "\n"


def markdown(result: Mapping[str, Any]) -> str:
    """Write the report."""
    lines = [
        "# Endurance of the environments",
        "",
        words(result),
        f"`{result['command']}`, FlexArm {result['version']}, commit {result['commit']}.",
        f"A call steps {result['arms']} arms; times and ratio are those of the part with the largest ratio. What the slowest",
        "call took beyond its CPU time it waited for a core of the machine.",
        "",
        f"| {' | '.join(HEADS)} |",
        "|---|---|" + "---:|" * (len(HEADS) - 2),
    ]
    for case in result["environments"]:
        figures = [f"{case['steps']:,}", f"{case['episodes']:,}", *_times(case)]
        cells = [f"`{case['id']}`", "yes" if case["disturbed"] else "no", *figures, str(len(case["not_finite"]))]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def _times(case: Mapping[str, Any]) -> list[str]:
    decimals = {"median_ms": 3, "slowest_ms": 1, "slowest_cpu_ms": 1, "slowest_over_median": 0}
    return [f"{case[name]:.{places}f}" for name, places in decimals.items()]
