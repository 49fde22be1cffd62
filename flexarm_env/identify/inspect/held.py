"""Readings that repeat: a sensor that is slower than the file's rows."""

from __future__ import annotations

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.report import fault
from flexarm_env.identify.inspect.series import Floats, Inspected, Series
from flexarm_env.identify.settings import Inspecting


def held(inspected: Inspected, arm: Arm, numbers: Inspecting) -> list[Fault]:
    """Find signals that change at an even beat of several rows, by more than a step."""
    recording = inspected.recording
    found = []
    for signal in recording.signals:
        count = repeats(inspected.series(signal, numbers), numbers)
        if count:
            text = f"repeats {count:.3g} by {count:.3g}: its sensor is slower than the rows of the file"
            found.append(fault(recording, signal, "held", count, text, f"{signal} = {{ repeats = {round(count)} }}"))
    return found


def repeats(series: Series, numbers: Inspecting) -> float:
    """Estimate how many readings in a row are one; 0 where they are not held.

    The samples at which a held reading changes lie on a comb, whose spectrum is a line at one over the repeats. A coarse
    reading of a steady motion makes the same comb, by changes of one step, which therefore prove nothing.
    """
    changes = series.changes
    at = np.flatnonzero(changes)
    if len(at) < numbers.fewest_changes or len(at) > numbers.most_changing * len(changes):
        return 0.0
    large = np.abs(changes[at]) > numbers.more_than_a_step * series.step
    if large.mean() < numbers.large_changes:
        return 0.0
    comb = np.zeros(len(changes))
    comb[at] = 1.0
    line = np.abs(np.fft.rfft(comb - comb.mean(), numbers.padding * len(comb))) / len(at)
    count = _beat(line, len(at), numbers)
    return count if count * len(at) <= numbers.once_a_beat * len(changes) else 0.0


def _beat(line: Floats, count: int, numbers: Inspecting) -> float:
    """Read the beat off the spectrum of a comb: its first line."""
    length = 2 * (len(line) - 1)
    highest = float(line.max())
    if highest < max(numbers.comb, numbers.comb_by_chance / count**0.5):
        return 0.0
    first = int(np.flatnonzero(line > numbers.first_line * highest)[0])
    near = slice(first, first + 2 * numbers.padding)
    place = first + int(line[near].argmax())
    return length / place
