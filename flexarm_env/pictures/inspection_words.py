"""An overview of recordings as sentences and rows of text, for terminal, page and lab."""

from __future__ import annotations

from collections.abc import Sequence

from flexarm_env.arm import Arm, short_name
from flexarm_env.identify.inspect.excitation import (
    DETECTABLE,
    NOT_EXCITED,
    NOT_SHOWN,
    SHOWN,
    ConstantExcitation,
    EffectExcitation,
    Excitation,
)
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.inspection import Inspection
from flexarm_env.identify.inspect.overview import Overview, stated_noise
from flexarm_env.identify.percent import percent
from flexarm_env.parameters import INPUTS
from flexarm_env.pictures import words
from flexarm_env.pictures.words import NOTHING, counted, number
from flexarm_env.recordings.recording import Recording

EXTENTS = ("recording", "duration", "rate", "samples", "gaps", "command", "payload")
SIGNALS = ("recording", "signal", "from", "to", "unit", "resolution", "noise", "arm file", "measured")
CONSTANTS = ("constant", "", "as given", "unit", "before", "after")
EFFECTS = ("effect", "", "shown", "typical", "unit", "parameter")
COMMON_SCALE = (
    "No motion here shows the scale that torques, inertias and stiffnesses have in common. It comes from the priors of all of "
    "them. A run with a known payload would show it."
)
NOT_READ = "The file cannot be read as one recording, so that nothing else was inspected."
INSUFFICIENT = "Insufficient for a diagnosis."
NEAR_THE_TRUTH = "These limits hold for an arm near the truth: the error that it makes now is no part of them."


def remarks(found: Excitation) -> list[str]:
    """List what a reader of the limits must know, a sentence or two each; nothing where there are no limits."""
    if not (found.constants or found.effects):
        return []
    return [*([COMMON_SCALE] if found.common_scale == NOT_SHOWN else []), NEAR_THE_TRUTH]


def faults_sentence(faults: Sequence[Fault], recordings: Sequence[Recording]) -> str:
    """Count the faults of recordings in one sentence."""
    where = counted(len(recordings), "recording")
    return f"{counted(len(faults), 'fault')} in {where}." if faults else f"No fault in {where}."


def sentence(found: Overview) -> str:
    """Write what recordings hold and can show in two sentences."""
    if not found.recordings:
        return f"{counted(len(found.inspection.faults), 'fault')}. {NOT_READ}"
    ability = INSUFFICIENT if found.insufficient else _excitation(found.excitation)
    return f"{faults_sentence(found.inspection.faults, found.recordings)} {ability}"


def _excitation(found: Excitation) -> str:
    shown = sum(one.state == SHOWN for one in found.constants)
    detectable = sum(one.state == DETECTABLE for one in found.effects)
    constants = f"{shown} of {counted(len(found.constants), 'constant')}"
    return f"Near the truth a fit would show {constants}, and {detectable} of {len(found.effects)} effects at their typical size."


def extents(recordings: Sequence[Recording]) -> list[list[str]]:
    """Make the rows of `EXTENTS`."""
    return [_extent(one) for one in recordings]


def _extent(one: Recording) -> list[str]:
    longest = max((length for _, length in one.gaps), default=0.0)
    gaps = f"{len(one.gaps)}, up to {number(longest)} s" if one.gaps else "none"
    command = f"{number(float(one.command.min()))} to {number(float(one.command.max()))} {INPUTS[one.input_kind]}"
    payload = f"{number(one.conditions['payload'])} kg" if one.conditions.get("payload") else NOTHING
    rate = f"{number(1.0 / one.sample_time, 4)} Hz"
    return [one.name, f"{number(one.duration)} s", rate, str(len(one)), gaps, command, payload]


def signals(arm: Arm, recordings: Sequence[Recording], found: Inspection) -> list[list[str]]:
    """Make the rows of `SIGNALS`."""
    samples = {one.name: len(one) for one in recordings}
    rows = []
    for one in found.signals:
        stated = stated_noise(arm, one.signal)
        ends = [number(one.low), number(one.high), words.plain_unit(one.unit)]
        noise = [number(value, 2) if value else NOTHING for value in (one.step, one.noise, stated)]
        share = percent(one.samples / samples[one.recording])
        rows.append([one.recording, words.label_of(one.signal), *ends, *noise, share])
    return rows


def constants(found: Excitation) -> list[list[str]]:
    """Make the rows of `CONSTANTS`: how exactly each is known before a fit and after."""
    return [
        [
            short_name(one.path),
            one.state,
            number(one.value, 4),
            words.plain_unit(one.unit),
            _plus_minus(one, one.prior),
            _plus_minus(one, one.half_width),
        ]
        for one in found.constants
    ]


def _plus_minus(one: ConstantExcitation, half_width: float) -> str:
    if one.value == 0.0:
        return f"± {number(half_width, 2)} {words.plain_unit(one.unit)}".strip()
    return f"± {number(100 * half_width / abs(one.value), 2)} %"


def effects(found: Excitation) -> list[list[str]]:
    """Make the rows of `EFFECTS`, those that are not shown at their typical size first."""
    return [
        [
            one.effect,
            one.state,
            NOTHING if one.limit is None else f"{'up to' if one.falls else 'from'} {number(one.limit, 2)}",
            number(one.typical, 2),
            words.plain_unit(one.unit),
            one.parameter,
        ]
        for one in ordered(found.effects)
    ]


def ordered(found: Sequence[EffectExcitation]) -> list[EffectExcitation]:
    """Order effects by their limit over their typical size, those that are not excited first."""
    return sorted(found, key=lambda one: (one.state != NOT_EXCITED, -one.sizes))
