"""Two runs in one file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.report import fault, quantity
from flexarm_env.identify.inspect.series import Floats, Inspected, Series
from flexarm_env.identify.inspect.wild import usual_change
from flexarm_env.identify.inspect.wrap import wraps
from flexarm_env.identify.settings import Inspecting
from flexarm_env.recordings.columns import UNITS


def glued(inspected: Inspected, arm: Arm, numbers: Inspecting) -> list[Fault]:
    """Find samples at which a signal jumps and all stand as the recording began, or at which several jump at once.

    Across a gap signals go on meanwhile, so that several may well have changed.
    """
    recording = inspected.recording
    series = {signal: inspected.series(signal, numbers) for signal in recording.signals}
    sudden: Counter[int] = Counter()
    for signal, one in series.items():
        for row, is_sudden in _jumps(one, recording.time[one.rows], UNITS[signal] == "rad", numbers):
            sudden[row] += int(is_sudden)
    found = []
    for row, count in sorted(sudden.items()):
        if count > 1 or _begins_again(row, series, numbers):
            time = float(recording.time[row])
            text = (
                f"all signals jump at {quantity(time, 's')} (sample {row + 1}): the file holds two runs; "
                "cut it there into one file each"
            )
            found.append(fault(recording, "", "glued", time, text, "", [row]))
    return found


def _jumps(series: Series, time: Floats, is_angle: bool, numbers: Inspecting) -> Iterator[tuple[int, bool]]:
    """Find the samples at which a signal has changed by far more than elsewhere, and stays there.

    Yields:
        The sample, and whether the time since the reading before it is too short for such a change.
    """
    changes, length = np.abs(series.changes), numbers.goes_on
    if len(changes) < 2 * length or wraps(series, is_angle, numbers)[1]:
        return
    largest = np.argsort(changes)[: -numbers.most_glued - 1 : -1]
    rest = float(np.delete(changes, largest).max(initial=0.0))
    steps = np.diff(time)
    least = max(numbers.jump * rest, numbers.jump_noise * series.noise, numbers.wild_steps * series.step)
    for place in largest:
        if place + 1 < length:  # so few readings are no run
            continue
        before, after = series.values[max(place - length + 1, 0) : place + 1], series.values[place + 1 : place + 1 + length]
        stays = abs(float(np.median(after)) - float(np.median(before))) > numbers.stays * changes[place]
        if changes[place] > least and stays:
            meanwhile = float(steps[place] / np.median(steps))
            yield int(series.rows[place + 1]), bool(changes[place] > least * max(meanwhile, 1))


def _begins_again(row: int, series: dict[str, Series], numbers: Inspecting) -> bool:
    """Whether the readings of a sample are those that the recording began with."""
    for one in series.values():
        place = int(np.searchsorted(one.rows, row))
        slack = max(numbers.as_begun * max(one.noise, one.step), 2 * usual_change(one, numbers))
        if place == len(one) or abs(float(one.values[place] - one.values[0])) > slack:
            return False
    return True
