"""Quasi-continuous control, as in the thesis's simulations: the product's plant with a new command every 10 µs.

The thesis's controllers act at each of its steps. With friction compensation the command switches at zero speed, and the
result converges only for intervals below 0.1 ms; a loop in Python would take seconds for each run. So the law of eq. 4.2 is
compiled beside the plant. Tests compare it with the product's `VibrationSuppression`, which has the same law, and with the
thesis's own method at a step of 1 µs.
"""

from __future__ import annotations

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.plant import layout
from flexarm_env.thesis.constants import TABLE
from flexarm_env.thesis.kernels import LawArrays, PlantArrays, player
from flexarm_env.thesis.law import Law
from flexarm_env.thesis.runs import DURATION, INTERVAL, RUN_AWAY, Run, clock

STEP = 1e-5  # [s]


def run(arm: Arm, law: Law, duration: float = DURATION, step: float = STEP) -> Run:
    """Run an arm from rest at angle 0.

    Args:
        arm: with its base gage at the root, where it measures M_o.
        law: of the current; its limit applies.
        duration: [s].
        step: from one command to the next [s].

    Returns:
        Samples every millisecond, until the run diverges.
    """
    stride = max(round(INTERVAL / step), 1)
    plant = arm.plant(step)
    plant.place()
    kernel = plant.kernel
    out = np.zeros((round(duration / (stride * step)), len(arm.signals) + 2))
    per_strain = 1.0 / (arm.sensors["strain_base"]["gain"] * TABLE["N"])
    settings = np.array([per_strain, step, RUN_AWAY, layout.COMMAND, layout.MODE])
    arrays = PlantArrays(plant.constants, plant.layout, plant.state, plant.scratch)
    kernels = kernel.measure, kernel.drive_output, kernel.control_step
    count = player()(*kernels, arrays, LawArrays(*law.packed(step)), settings, stride, out)
    out = out[:count]
    signals = {signal: out[:, i].copy() for i, signal in enumerate(arm.signals)}
    return Run(clock(count, stride * step), out[:, -2].copy(), signals, out[:, -1] > 0.0, np.full(count, law.target))
