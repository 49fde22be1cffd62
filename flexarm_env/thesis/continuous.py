"""Control without a sampling interval, as in the thesis's simulations: the product's plant, its command renewed every 10 µs.

The thesis's controllers act at each of its steps. With friction compensated, where the command switches at zero speed, the
motion settles only below 0.1 ms, and a loop in Python would take seconds for each run. So the law of eq. 4.2 is compiled
beside the plant. It is that of the product's `VibrationSuppression`, and tests hold it against that one, and against the
thesis's own method with a step of 1 µs.
"""

from __future__ import annotations

import numpy as np
from numba import float64, int64, njit, types

from flexarm_env.arm import Arm
from flexarm_env.plant import layout
from flexarm_env.thesis.constants import TABLE
from flexarm_env.thesis.law import Law, current
from flexarm_env.thesis.runs import DURATION, INTERVAL, RUN_AWAY, Run

COMMAND, MODE = layout.COMMAND, layout.MODE
STEP = 1e-5  # [s]

_NUMBERS, _PLACES, _ROWS = types.Array(float64, 1, "C"), types.Array(int64, 1, "C"), types.Array(float64, 2, "C")
# The plant's kernels come as addresses: nothing of them is compiled in, so what numba keeps of this loop is never stale.
_MEASURE = types.FunctionType(types.none(_NUMBERS, _PLACES, _NUMBERS, _NUMBERS, int64))
_LET_THROUGH = types.FunctionType(float64(_NUMBERS, _PLACES, _NUMBERS, float64))
_CONTROL_STEP = types.FunctionType(types.none(_NUMBERS, _PLACES, _NUMBERS, float64, float64, _NUMBERS))
_PLAY = int64(
    _MEASURE, _LET_THROUGH, _CONTROL_STEP, _NUMBERS, _PLACES, _NUMBERS, _NUMBERS, _NUMBERS, _NUMBERS, float64, float64, int64,
    _ROWS,
)  # fmt: skip


def run(arm: Arm, law: Law, duration: float = DURATION, step: float = STEP) -> Run:
    """Run an arm from rest at angle 0.

    Args:
        arm: one whose base gage stands at the root, so that it shows M_o.
        law: of the current; its limit holds.
        duration: [s].
        step: from one command to the next [s].

    Returns:
        Samples every millisecond, until the arm runs away.
    """
    stride = max(round(INTERVAL / step), 1)
    plant = arm.plant(step)
    plant.place()
    kernel = plant.kernel
    out = np.zeros((round(duration / (stride * step)), len(arm.signals) + 2))
    numbers, past = law.packed(step)
    per_strain = 1.0 / (arm.sensors["strain_base"]["gain"] * TABLE["N"])
    count = play(
        kernel.measure, kernel.let_through, kernel.control_step, plant.constants, plant.layout, plant.state, plant.scratch,
        numbers, past, per_strain, step, stride, out,
    )  # fmt: skip
    out = out[:count]
    signals = {signal: out[:, i].copy() for i, signal in enumerate(arm.signals)}
    time = np.arange(count) * stride * step
    return Run(time, out[:, -2].copy(), signals, out[:, -1] > 0.0, np.full(count, law.target))


@njit([_PLAY], error_model="numpy", cache=True)
def play(measure, let_through, control_step, d, n, s, w, numbers, past, per_strain, step, stride, out):  # type: ignore[no-untyped-def]
    """Fill out (samples, signals + 2) with readings, current and whether the hub is stuck; return the samples filled."""
    last = out.shape[1] - 2
    shown = np.zeros(last)
    for k in range(out.shape[0] * stride):
        measure(d, n, s, shown, 0)
        if not abs(shown[1]) < RUN_AWAY:
            return k // stride
        amps = current(numbers, past, k, k * step, shown[0], shown[1], per_strain * shown[3])
        if k % stride == 0:
            out[k // stride, :last] = shown
            out[k // stride, last] = amps
            out[k // stride, last + 1] = int(s[MODE]) & 1
        before = s[COMMAND]
        control_step(d, n, s, before, let_through(d, n, s, amps), w)
    return out.shape[0]
