"""Inspect recordings with one fault each, and sound ones, and score the faults that are named."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict
from itertools import cycle, islice
from typing import Any

import numpy as np

from benchmarks.faults import sound, table
from benchmarks.faults.inject import INJECTIONS, Truth, inject
from benchmarks.faults.machines import draw
from flexarm_env import Arm, Recording, inspect_recordings
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.restart import restart
from flexarm_env.recordings.clock import RestartError

SEED, COUNT = 1, 300
#: Largest error of a size; share of the faults that are also counted as cases with hidden effects.
TOLERANCE, HIDDEN_SHARE = 0.02, 0.2
TRIES = 20


def measure(say: Callable[[str], None], seed: int = SEED, count: int = COUNT) -> dict[str, Any]:
    """Name faults in `count` sets of three recordings, and look for false alarms on these without the fault and on others."""
    answers, alarms, checked = [], [], 0
    for place, kind in enumerate(islice(cycle([*INJECTIONS, "restart"]), count)):
        arm, recordings, faulty, truth = _case(np.random.default_rng([seed, place]), kind)
        alarms += _alarms(f"{arm.name}-{place}", arm, recordings)
        found = inspected(arm, faulty)
        answers.append({"case": place, "arm": arm.name, "truth": asdict(truth), "right": is_right(truth, found)} | _said(found))
        checked += 1
        if checked % 50 == 0:
            say(f"{checked} of {count} faults, {sum(a['right'] for a in answers)} named right")
    others = [*sound.shipped(), *sound.real()]
    for name, arm, recordings in _chain(others, sound.hidden_effects(seed, max(round(HIDDEN_SHARE * count), 1))):
        alarms += _alarms(name, arm, recordings)
        checked += 1
    seconds = [_seconds(arm, recordings) for name, arm, recordings in others if name == "demo" for _ in range(5)]
    found = {
        "faults_named_percent": 100.0 * float(np.mean([a["right"] for a in answers])),
        "faults_false_alarms": len(alarms),
        "faults_sound_sets": checked,
        "inspection_s": min(seconds),
    }
    say(f"tables are in {table.write(seed, count, answers, alarms, found)}")
    return found


def _chain(*parts: Iterable[sound.Case]) -> Iterator[sound.Case]:
    for part in parts:
        yield from part


def _case(rng: np.random.Generator, kind: str) -> tuple[Arm, list[Recording], list[Recording] | RestartError, Truth]:
    """Draw machines until one shows a fault of the kind."""
    while True:
        arm, recordings = draw(rng)
        if kind == "restart":
            return arm, recordings, *_restarted(rng, recordings)
        for _ in range(TRIES):
            made = inject(rng, kind, arm, recordings)
            if made is not None:
                return arm, recordings, *made


def _restarted(rng: np.random.Generator, recordings: list[Recording]) -> tuple[RestartError, Truth]:
    """Write two runs into one file, each with its own clock."""
    first, second = (recordings[i] for i in rng.permutation(len(recordings))[:2])
    joined = {name: np.r_[first.signals[name], second.signals[name]] for name in first.signals}
    time, command = np.r_[first.time, second.time], np.r_[first.command, second.command]
    try:
        Recording.from_arrays(first.name, time, first.input_kind, command, joined)
    except RestartError as error:
        return error, Truth("restart", "time", first.duration, (first.name,))
    raise AssertionError("two runs were read as one")


def inspected(arm: Arm, recordings: list[Recording] | RestartError) -> tuple[Fault, ...]:
    """Name the faults of recordings, or of a file that cannot be read as one."""
    return (restart(recordings),) if isinstance(recordings, RestartError) else inspect_recordings(arm, recordings).faults


def is_right(truth: Truth, found: Iterable[Fault]) -> bool:
    """Whether all that is named is the fault that was put in, each with its size."""
    faults = list(found)
    signals = {truth.signal, truth.other}
    sized = [one.value is None or _same_size(one.value, truth) for one in faults]
    return bool(faults) and all(sized) and all(one.kind == truth.kind and one.signal in signals for one in faults)


def _same_size(value: float, truth: Truth) -> bool:
    if truth.kind == "swapped":
        return True
    size = abs(value) if truth.kind == "rail" else value  # of two rails either is right
    return abs(size - truth.value) <= TOLERANCE * abs(truth.value)


def _alarms(name: str, arm: Arm, recordings: list[Recording]) -> list[dict[str, str]]:
    """List the false alarms on sound recordings: one entry for each set."""
    found = inspect_recordings(arm, recordings).faults
    return [{"case": name, "arm": arm.name, "said": found[0].line}] if found else []


def _said(found: Iterable[Fault]) -> dict[str, Any]:
    return {"said": [one.line for one in found]}


def _seconds(arm: Arm, recordings: list[Recording]) -> float:
    began = time.perf_counter()
    inspect_recordings(arm, recordings)
    return time.perf_counter() - began
