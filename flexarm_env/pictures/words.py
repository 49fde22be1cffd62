"""Numbers and sentences of results as text."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise

from flexarm_env.arm import short_name
from flexarm_env.identify.calibrate.estimate import Estimate
from flexarm_env.identify.explain.budget import REST, Budget
from flexarm_env.identify.explain.comparison import Comparison
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.percent import percent
from flexarm_env.identify.results import Addition, Candidate, Diagnosis
from flexarm_env.sensors import known_sensors

NOTHING = "–"
_BARS = "▁▂▃▄▅▆▇█"
_EIGHTHS = " ▏▎▍▌▋▊▉"
FAULT_COLUMNS = ("recording", "fault", "size", "samples", "finding", "line that mends it")
ESTIMATES = ("value", "before", "after", "90 % interval", "unit")
PARTS = ("moving fast", "moving slowly", "stuck")


def number(value: float, digits: int = 3) -> str:
    """Format a number with a count of significant digits; "–" stands for nan."""
    if not math.isfinite(value):
        return NOTHING if math.isnan(value) else ("∞" if value > 0 else "−∞")
    if value == 0.0:
        return "0"
    exponent = math.floor(math.log10(abs(float(f"{value:.{digits - 1}e}"))))
    if -4 <= exponent <= 5:
        return f"{value:.{max(digits - 1 - exponent, 0)}f}"
    return f"{value:.{digits - 1}e}"


def rounded(value: float, low: float, high: float) -> str:
    """Format a value down to the second significant digit of half its interval."""
    half = 0.5 * abs(high - low)
    if not (math.isfinite(half) and math.isfinite(value)) or half == 0.0 or value == 0.0:
        return number(value, 4)
    digits = math.floor(math.log10(abs(value))) - math.floor(math.log10(half)) + 2
    return number(value, min(max(digits, 1), 8))


def interval(estimate: Estimate) -> str:
    """Format low and high end with as many digits as the value has."""
    ends = (rounded(end, estimate.low, estimate.high) for end in (estimate.low, estimate.high))
    return " to ".join(ends)


def value_of(estimate: Estimate) -> str:
    """Format value, unit and interval: "0.0612 rad (0.0583 to 0.0641)"."""
    unit = f" {plain_unit(estimate.unit)}" if estimate.unit else ""
    return f"{rounded(estimate.value, estimate.low, estimate.high)}{unit} ({interval(estimate)})"


def plain_unit(unit: str) -> str:
    """Format a pint unit for print: N·m² for N*m**2."""
    text = unit.replace("**2", "²").replace("**3", "³").replace("**4", "⁴").replace("*", "·")
    return text.replace("Nm", "N·m")


def parameters_of(estimates: Iterable[Estimate]) -> str:
    """Format an effect's estimates: "gap = 0.0612 rad (0.0583 to 0.0641), …"."""
    return ", ".join(f"{e.path.split('.')[-1]} = {value_of(e)}" for e in estimates)


def constant_name(estimate: Estimate) -> str:
    """Shorten the path of a fitted value to its name."""
    return short_name(estimate.path)


def estimate_rows(found: Sequence[Estimate]) -> list[list[str]]:
    """Format fitted values with their intervals, beside the values as given: rows under `ESTIMATES`."""
    return [
        [
            constant_name(e),
            rounded(e.nominal, e.low, e.high),
            rounded(e.value, e.low, e.high),
            interval(e),
            plain_unit(e.unit),
        ]
        for e in found
    ]


def counted(count: int, noun: str) -> str:
    """Format a count with its noun: "1 recording", "3 recordings"."""
    return f"{count} {noun}{'' if count == 1 else 's'}"


def sparkline(values: Sequence[float], largest: float | None = None) -> str:
    """Format values as a row of bars, from 0 to the largest: "▁▂▇█"."""
    finite = [value for value in values if math.isfinite(value)]
    top = max(finite, default=0.0) if largest is None else largest
    if top <= 0.0:
        return "▁" * len(values)
    return "".join(_BARS[min(int(len(_BARS) * v / top), len(_BARS) - 1)] if math.isfinite(v) else " " for v in values)


def bar(share: float, width: int = 12) -> str:
    """Format a share, 0 to 1, as a horizontal bar of a width in characters; every positive share is visible."""
    if not share > 0.0:
        return ""
    eighths = max(round(8 * width * min(share, 1.0)), 1)
    whole, rest = divmod(eighths, 8)
    return "█" * whole + (_EIGHTHS[rest] if rest else "")


def signals_of(rows: Sequence[str]) -> list[str]:
    """Select the signals among names, in their usual order."""
    return [name for name in known_sensors() if name in rows]


def label_of(signal: str) -> str:
    """Look up the label of a signal; "all signals" for none."""
    return known_sensors()[signal].label if signal in known_sensors() else "all signals"


def unit_of(signal: str) -> str:
    """Format a signal's unit for print."""
    return plain_unit(known_sensors()[signal].unit)


def steps_of(error: Mapping[str, float], effects: Sequence[str] = ()) -> list[tuple[str, float]]:
    """List the error after each step: as given, constants refitted, with each effect.

    The last effect carries the final error, which includes the last refit and any effect that was removed again.
    """
    steps = [("as given", error["nominal"])]
    if "refitted" in error:
        steps.append(("constants refitted", error["refitted"]))
    if effects and "final" in error:
        unnamed = [name for name in effects[:-1] if name not in error]
        steps += [(f"+ {name}", error[name]) for name in effects[:-1] if name in error]
        steps.append((" ".join(f"+ {name}" for name in [*unnamed, effects[-1]]), error["final"]))
    elif "final" in error and error["final"] != error.get("refitted"):
        steps.append(("final", error["final"]))
    return steps


def change(error: Mapping[str, float], effects: Sequence[str] = ()) -> str:
    """Write how the error changes from step to step, with the verb that fits: "falls 4.10 → 3.70 → 1.02 × the noise"."""
    values = [value for _, value in steps_of(error, effects)]
    shown = [number(value) for value in values]
    if len(set(shown)) == 1:
        return f"stays at {shown[-1]} × the noise"
    falls, rises = (all(sign * old >= sign * new for old, new in pairwise(values)) for sign in (1, -1))
    return f"{'falls' if falls else 'rises' if rises else 'goes'} {' → '.join(shown)} × the noise"


def budget_sentence(budget: Budget) -> str:
    """Write which share of the excess error each step explains; empty where shares have no meaning."""
    if not budget.has_meaning:
        return ""
    parts = [f"{name} {percent(share)}" for name, share in budget.shares.items() if name != REST]
    worse = " (less than 0: that step makes it worse)" if min(budget.shares.values()) < 0.0 else ""
    return f"Of the excess error (error² − 1), {', '.join(parts)}, nothing {percent(budget.shares[REST])}{worse}."


BUDGET_HEAD = "explained by"


def budget_columns(budget: Budget) -> list[str]:
    """List the heads of the table of the budget."""
    return [BUDGET_HEAD, "all signals", *map(label_of, budget.signals)]


def budget_rows(budget: Budget) -> list[list[str]]:
    """Format the budget: a row for each share, then the error left over the noise and in the signal's unit."""
    if not budget.has_meaning:
        return []
    parts = [budget.shares, *budget.signals.values()]
    rows = [
        [_share_name(name), *(percent(part[name]) if math.isfinite(part[name]) else NOTHING for part in parts)]
        for name in budget.shares
    ]
    left = [budget.left[signal] for signal in budget.signals]
    rows.append(["error left / noise", "", *(number(one.over_noise) for one in left)])
    units = [unit_of(signal) for signal in budget.signals]
    return [*rows, ["error left, rms", "", *(f"{number(one.rms, 2)} {u}" for one, u in zip(left, units, strict=True))]]


def _share_name(name: str) -> str:
    return "nothing (the rest)" if name == REST else name


def accepted(diagnosis: Diagnosis) -> list[Candidate]:
    """List the accepted candidates in the order of the verdict."""
    found = {c.effect: c for c in diagnosis.ranking}
    return [found[name] for name in diagnosis.effects if name in found]


def verdict(diagnosis: Diagnosis) -> str:
    """Write the verdict of a diagnosis in one to three sentences."""
    error = diagnosis.error
    if diagnosis.verdict == "recordings":
        return f"The recordings are at fault, and no effect was sought. {_faults(diagnosis.recordings)}"
    final = number(error["final"])
    if diagnosis.verdict == "nothing_missing":
        return f"No effect is missing: the arm explains these recordings to {final} × the noise."
    if diagnosis.verdict == "parameters":
        return f"No effect is missing. The constants were wrong: after a refit the error {change(error)}."
    if diagnosis.verdict == "unknown" and diagnosis.stopped:
        return f"No effect is named yet: the time was over. With the constants refitted the error {change(error)}."
    if diagnosis.verdict == "unknown":
        return (
            "An effect is missing, and none of the catalogue explains these recordings: "
            f"with the constants refitted the error {change(error)}."
        )
    if diagnosis.verdict == "insufficient_data":
        return f"These recordings are insufficient for a diagnosis: the error is {final} × the noise."
    return " ".join(filter(None, [_missing(diagnosis), budget_sentence(diagnosis.budget), _doubt(diagnosis)]))


def _faults(faults: Sequence[Fault]) -> str:
    """Describe the first fault in one sentence, with the line that mends it, and count the others."""
    first = faults[0]
    mend = f"; {first.hint} mends it" if first.hint else ""
    rest = f" ({counted(len(faults) - 1, 'more fault')})" if len(faults) > 1 else ""
    return f"{first.recording}: {first.message}{mend}{rest}."


def fault_rows(faults: Sequence[Fault]) -> list[list[str]]:
    """List faults as rows of a table: recording, fault, size, share of the samples, and the line that mends it."""
    return [
        [one.recording, one.kind, size_of(one), percent(one.share) if one.rows else "all", one.message, one.hint]
        for one in faults
    ]


def size_of(one: Fault) -> str:
    """Format the size of a fault with its unit."""
    return NOTHING if one.value is None else f"{number(one.value, 4)} {plain_unit(one.unit)}".strip()


def probabilities(diagnosis: Diagnosis) -> dict[str, str]:
    """Format the probability of each named effect, and of those that equal it, by effect: "83 %"."""
    pairs = zip(diagnosis.equivalent, diagnosis.probability, strict=True)
    return {name: percent(one) for names, every in pairs for name, one in zip(names, every, strict=True)}


def _missing(diagnosis: Diagnosis) -> str:
    named = {c.effect: parameters_of(c.estimates) for c in accepted(diagnosis)}
    parts = [f"{name}, {named[name]}" if named.get(name) else name for name in diagnosis.effects]
    them = "it" if len(diagnosis.effects) == 1 else "them"
    partly = diagnosis.verdict == "partly"
    more = ": more is missing" if partly else ""
    lead = "Partly explained. Missing" if partly else "Missing"
    return f"{lead}: {'; '.join(parts)}. With {them} the held-out error {change(diagnosis.error, diagnosis.effects)}{more}."


def _doubt(diagnosis: Diagnosis) -> str:
    rivals = [(names[0], names[1:]) for names in diagnosis.equivalent if len(names) > 1]
    return " ".join(f"These data cannot distinguish {name} from {' or '.join(others)}." for name, others in rivals)


def addition(result: Addition) -> str:
    """Write the parameters and the error reduction of an added effect in two sentences."""
    own = [e for e in result.estimates if e.path.startswith(f"effects.{result.effect}.")]
    helps = result.error["final"] < result.error["refitted"]
    return (
        f"{result.effect}: {parameters_of(own) or 'added'}. The held-out error {change(result.error, [result.effect])}"
        f"{'' if helps else ': the effect does not lower it'}."
    )


def comparison(result: Comparison) -> str:
    """Write an arm's error on recordings in one sentence."""
    closed = "" if result.closed_loop is None else f", by {number(result.closed_loop)} × in closed loop"
    return (
        f"Arm '{result.arm.name}' misses by {number(result.error)} × the noise in windows of 1 s, "
        f"by {number(result.free_run)} × in one free run{closed}; 1 is perfect."
    )


#: Heads of the table of errors in closed loop.
LOOP_HEADS = ("recording", "quantity", "error over noise", "fit", "100 ‖e‖/‖y‖")


def loop_rows(result: Comparison) -> list[list[str]]:
    """Format the errors in closed loop by recording and quantity."""
    return [
        [
            row.recording,
            label_of(row.quantity) if row.quantity in known_sensors() else row.quantity,
            number(row.error),
            f"{row.fit:.1f} %" if math.isfinite(row.fit) else NOTHING,
            f"{number(row.relative)} %" if math.isfinite(row.relative) else NOTHING,
        ]
        for row in result.loop_rows
    ]
