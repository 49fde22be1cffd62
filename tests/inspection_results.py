"""An overview of recordings made by hand for the tests of pages."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.excitation import (
    DETECTABLE,
    NOT_EXCITED,
    NOT_SHOWN,
    SHOWN,
    TOO_SMALL,
    ConstantExcitation,
    EffectExcitation,
    Excitation,
)
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.inspection import Inspection
from flexarm_env.identify.inspect.overview import Overview
from flexarm_env.identify.inspect.signal_facts import SignalFacts
from flexarm_env.recordings.recording import Recording

CUT = Fault(
    "pulse", "", "arm_angle", "rail", 1.5, "rad", "arm_angle stands at 1.5 rad", "arm_angle = { range = [0, 1.5] }", (40, 41, 42)
)
GLUED = Fault("pulse", "", "time", "glued", 0.5, "s", "another run begins at 0.5 s")
EXCITATION = Excitation(
    (
        ConstantExcitation("drive.torque_constant", 0.33, 0.03, 0.08, "Nm/A", SHOWN),
        ConstantExcitation("drive.gear_stiffness", 4000.0, 600.0, 650.0, "N*m/rad", NOT_SHOWN),
    ),
    (
        EffectExcitation("coulomb", "torque", 0.002, 0.08, "N*m", 0.025, False, DETECTABLE),
        EffectExcitation("saturation", "limit", 2.0, 3.0, "A", 1.5, True, TOO_SMALL),
        EffectExcitation("backlash", "gap", None, 0.03, "rad", math.inf, False, NOT_EXCITED),
    ),
    NOT_SHOWN,
)


def overview(*faults: Fault) -> Overview:
    """Two recordings of one signal, with the faults given."""
    time = 0.01 * np.arange(100)
    first = Recording.from_arrays("pulse", time, "current", np.sin(9.0 * time), {"arm_angle": 1.0 - np.cos(9.0 * time)})
    recordings = (first, replace(first, name="square"))
    facts = tuple(SignalFacts(one.name, "arm_angle", "rad", 0.0, 2.0, 75, 0.0, 0.002) for one in recordings)
    inspection = Inspection(faults, facts, recordings, 0.1)
    return Overview(Arm.load("thesis-fem"), recordings, inspection, EXCITATION, ("the noise is a guess",))
