"""A reading that never changes while others do: an unplugged sensor."""

from __future__ import annotations

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.report import fault, shown
from flexarm_env.identify.inspect.series import Inspected, partners
from flexarm_env.identify.settings import Inspecting


def constant(inspected: Inspected, arm: Arm, numbers: Inspecting) -> list[Fault]:
    """Find a signal whose readings are all equal though those that rest with it move, or though it alone shows no noise."""
    recording = inspected.recording
    series = {signal: inspected.series(signal, numbers) for signal in recording.signals}
    still = [signal for signal, one in series.items() if len(one) and not np.ptp(one.values)]
    found = []
    for signal in still:
        others = [one for one in partners(signal, series) if len(one)]
        moves = any(np.ptp(one.values) > numbers.moves * one.noise > 0.0 for one in others)
        sensor = arm.sensors.get(signal, {"noise": 0.0, "resolution": 0.0})
        is_noisy = sensor["noise"] > sensor["resolution"] and len(still) == 1 and np.ptp(recording.command) > 0.0
        if moves or is_noisy:
            value = float(series[signal].values[0])
            found.append(fault(recording, signal, "constant", value, f"never moves: it is {shown(signal, value)} in every row"))
    return found
