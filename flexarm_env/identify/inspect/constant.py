"""A reading that never changes while others do: an unplugged sensor."""

from __future__ import annotations

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.report import fault, shown
from flexarm_env.identify.inspect.series import Series
from flexarm_env.identify.settings import Inspecting
from flexarm_env.recordings.recording import Recording


def constant(recording: Recording, arm: Arm, numbers: Inspecting) -> list[Fault]:
    """Find signals whose readings are all equal, though their noise is not below their step or another signal moves."""
    series = {signal: Series.of(recording, signal, numbers) for signal in recording.signals}
    still = [signal for signal, one in series.items() if len(one) and not np.ptp(one.values)]
    moves = any(np.ptp(one.values) > numbers.moves * one.noise for signal, one in series.items() if signal not in still)
    found = []
    for signal in still:
        sensor = arm.sensors.get(signal, {"noise": 0.0, "resolution": 0.0})
        if moves or sensor["noise"] > sensor["resolution"]:
            value = float(series[signal].values[0])
            found.append(fault(recording, signal, "constant", value, f"never moves: it is {shown(signal, value)} in every row"))
    return found
