"""Commands beyond the drive's limit: the amplifier cannot have followed them."""

from __future__ import annotations

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.report import fault, quantity
from flexarm_env.identify.inspect.series import Inspected
from flexarm_env.identify.percent import percent
from flexarm_env.identify.settings import Inspecting
from flexarm_env.parameters import INPUTS


def limit(inspected: Inspected, arm: Arm, numbers: Inspecting) -> list[Fault]:
    """Find commands above the limit of the arm's drive, unless the arm itself cuts them off."""
    recording = inspected.recording
    largest = arm.constants["drive"]["limit"]
    if not largest or recording.input_kind != arm.input or "saturation" in arm.effects:
        return []
    beyond = np.flatnonzero(np.abs(recording.command) > numbers.beyond_limit * largest)
    if not beyond.size:
        return []
    unit = INPUTS[recording.input_kind]
    reached = float(np.abs(recording.command).max())
    text = (
        f"reaches {quantity(reached, unit)}, {reached / largest:.4g} times the arm's limit of {quantity(largest, unit)}, "
        f"in {percent(beyond.size / len(recording))} of the rows: did the amplifier cut it off?"
    )
    hint = f"effects.saturation = {{ limit = {largest:g} }}"
    return [fault(recording, recording.input_kind, "limit", reached / largest, text, hint, beyond)]
