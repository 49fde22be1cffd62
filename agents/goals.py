"""Comparison of policies with classical controllers: the difference, and its significance."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from agents.statistics import improvement, interquartile_mean, stratified_interval
from flexarm_env.trials.score import worst_tenth

Floats = NDArray[np.float64]
#: Measures (runs, arms) of one agent.
Values = Mapping[str, Floats]

#: The controllers of the thesis; it leaves the others for future work.
THESIS = (
    "pd",
    "pd_rate_limited",
    "vibration_dual",
    "vibration_dual_plain",
    "vibration_high",
    "vibration_low",
    "vibration_practical",
)
#: Measures that count failures.
FAILURES = ("unsettled",)
#: Share by which a policy is to be below the best controller of the thesis.
GOALS = {"settling_time": 0.4, "steady_error": 0.8, "residual_strain": 0.7}


def cell_of(values: Values) -> dict[str, dict[str, float]]:
    """Compute each measure's interquartile mean, the ends of its 95 % interval, and the mean of its worst tenth.

    Failures have a mean in its place: the middle half of the arms shows none of them where fewer than a quarter fail.
    """
    found = {}
    for name, measured in values.items():
        failures = name in FAILURES
        value, low, high = stratified_interval([measured], mean if failures else interquartile_mean)
        centre = "mean" if failures else "iqm"
        found[name] = {centre: value, "low": low, "high": high, "worst_tenth": float(worst_tenth(measured.ravel()))}
    return found


def mean(values: Floats) -> Floats:
    """Compute the mean of values (…, values)."""
    found: Floats = values.mean(axis=-1)
    return found


def best_of(names: Sequence[str], cells: Mapping[str, Any], measure: str) -> str:
    """Find the controller with the least interquartile mean of a measure."""
    return min(names, key=lambda name: cells[name][measure]["iqm"])


def verdicts(policy: str, rivals: Sequence[str], cells: Mapping[str, Any], values: Mapping[str, Values]) -> list[dict[str, Any]]:
    """Compare a policy with the best of its rivals in each measure of GOALS.

    Args:
        policy: name.
        rivals: names.
        cells: of all, by name.
        values: of all, by name.
    """
    found = []
    for measure, goal in GOALS.items():
        rival = best_of(rivals, cells, measure)
        own, other = cells[policy][measure], cells[rival][measure]
        better, low, high = improvement(values[policy][measure], values[rival][measure])
        found.append(
            {
                "measure": measure,
                "rival": rival,
                "policy": own,
                "rival_has": other,
                "less_by": 1.0 - own["iqm"] / other["iqm"] if other["iqm"] else 0.0,
                "goal": goal,
                "apart": own["high"] < other["low"] or other["high"] < own["low"],
                "improvement": {"probability": better, "low": low, "high": high},
            }
        )
    return found


def against_thesis(verdict: Mapping[str, Any]) -> str:
    """Word the result for a goal against the thesis."""
    if verdict["less_by"] >= verdict["goal"] and verdict["apart"]:
        return "reached"
    if not verdict["apart"]:
        return "missed: intervals touch"
    return f"missed by {100.0 * (verdict['goal'] - verdict['less_by']):.0f} points"


def against_classical(verdict: Mapping[str, Any]) -> str:
    """Word the comparison with a rival: better or worse where the intervals are disjoint."""
    if not verdict["apart"]:
        return "no difference"
    return "better" if verdict["less_by"] > 0.0 else "worse"
