"""Results on the machine of controllers and policies for the nominal and the corrected arm, as numbers and Markdown."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from agents.goals import cell_of
from agents.markdown import origin_line, row, with_interval
from agents.statistics import RESAMPLES, Interval, drawn_again, with_ends
from flexarm_env.trials.score import cost

Floats = NDArray[np.float64]

COLUMNS = (("settling_time", "settling [s]", 2), ("steady_error", "error [°]", 3), ("residual_strain", "strain [V]", 4))


def less_by(values: Mapping[str, Floats], reference: Mapping[str, Floats], seed: int = 0) -> Interval:
    """Compute the share by which the geometric mean of the measures is below the reference's, with its 95 % interval.

    Runs and episodes are drawn again, on both sides apart: a run is whole.
    """
    own, other = cost(values), cost(reference)
    draw = np.random.default_rng(seed)
    found = drawn_again(own, draw, RESAMPLES).mean(axis=1) - drawn_again(other, draw, RESAMPLES).mean(axis=1)
    value, low, high = with_ends(float(own.mean() - other.mean()), found)
    return 1.0 - float(np.exp(value)), 1.0 - float(np.exp(high)), 1.0 - float(np.exp(low))


def verdict_of(values: Mapping[str, Mapping[str, Floats]]) -> dict[str, Any]:
    """Compute a case's cells, and the improvement over those for the nominal arm of each one for the corrected arm.

    One chosen of both by simulations of the corrected arm is compared likewise.
    """
    gains = {}
    for name in values:
        who, _, kind = name.rpartition(", ")
        if kind in ("corrected", "chosen"):
            rivals = [rival for rival in ("nominal", "randomised") if f"{who}, {rival}" in values]
            found = {rival: less_by(values[name], values[f"{who}, {rival}"]) for rival in rivals}
            gains[who if kind == "corrected" else f"{who}, chosen"] = {
                rival: dict(zip(("value", "low", "high"), gain, strict=True)) for rival, gain in found.items()
            }
    runs = {name: len(found["settling_time"]) for name, found in values.items()}
    return {"runs": runs, "cells": {name: cell_of(found) for name, found in values.items()}, "corrected_less_by": gains}


def report_of(result: Mapping[str, Any]) -> str:
    """Write the whole report."""
    lines = [
        "# From the simulator to the machine",
        "",
        origin_line(result),
        f"The slew over 100° on a machine that hides something, {result['episodes']} episodes with other noise; interquartile",
        "means over episodes and training runs, 95 % bootstrap intervals in which both are drawn again. Less is better.",
    ]
    if result["not_made"]:
        lines += ["", f"Not made yet: {', '.join(result['not_made'])}; `python -m agents.sim_to_rig --make` goes on."]
    lines += ["", *_in_short(result["cases"])]
    for case, found in result["cases"].items():
        diagnosis = result["diagnoses"][case]
        named = ", ".join(diagnosis["effects"]) or "none named"
        lines += ["", f"## {case}: {diagnosis['settings']}, nominal arm {diagnosis['nominal']}", ""]
        lines.append(f"Hidden: {diagnosis['hidden']}. Diagnosis: `{diagnosis['verdict']}`, {named}, in {diagnosis['seconds']} s.")
        lines += ["", row(["for the arm", "runs", *(heading for _, heading, _ in COLUMNS)]), "|---|" + "---:|" * 4]
        for name, cell in found["cells"].items():
            parts = (with_interval(cell[key], digits) for key, _, digits in COLUMNS)
            lines.append(row([name, str(found["runs"][name]), *parts]))
    return "\n".join(lines) + "\n"


def _in_short(cases: Mapping[str, Any]) -> list[str]:
    lines = [
        "By how much the geometric mean of settling time, error and strain (none of a rigid link) is less for the corrected arm.",
        "Chosen: of the controllers for the nominal and for the corrected arm, the one that does better in simulations of the",
        "corrected arm. Bold: the interval excludes 0. Empty: the law cannot be made for that machine.",
        "",
        row(["corrected", "against", *cases]),
        "|---|---|" + "---:|" * len(cases),
    ]
    pairs = dict.fromkeys(
        (who, rival) for found in cases.values() for who, rivals in found["corrected_less_by"].items() for rival in rivals
    )
    for who, rival in pairs:
        gains = [found["corrected_less_by"].get(who, {}).get(rival) for found in cases.values()]
        entries = [_gain(gain) if gain else "" for gain in gains]
        lines.append(row([who, rival, *entries]))
    return lines


def _gain(gain: Mapping[str, float]) -> str:
    value, low, high = (f"{100.0 * gain[key]:.0f} %" for key in ("value", "low", "high"))
    text = f"{value} ({low} to {high})"
    return f"**{text}**" if gain["low"] > 0.0 or gain["high"] < 0.0 else text
