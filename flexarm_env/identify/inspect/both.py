"""One line of the column map for a signal that wraps and is a multiple of the model's: a modulus is in SI, after the scale."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.report import quantity


def with_common_lines(faults: Sequence[Fault]) -> list[Fault]:
    """Give the wrap and the factor of one signal of one recording the same line, which mends both."""
    factors = {
        (one.recording, one.signal): (one.value, one.hint) for one in faults if one.kind == "factor" and one.value and one.hint
    }
    wraps = {(one.recording, one.signal): (one.value, one.unit) for one in faults if one.kind == "wrap" and one.value}
    lines = {}
    for key in set(factors) & set(wraps):
        (factor, hint), (modulus, unit) = factors[key], wraps[key]
        entry, _, gain = hint.partition(" }")
        lines[key] = f'{entry}, wrap = "{quantity(abs(modulus / factor), unit)}" }}{gain}'
    shared = ("factor", "wrap")
    return [
        replace(one, hint=lines[key]) if one.kind in shared and (key := (one.recording, one.signal)) in lines else one
        for one in faults
    ]
