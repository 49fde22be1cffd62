"""Row T19: computing time of the thesis's method and of the product's."""

from __future__ import annotations

import functools
import time
from dataclasses import dataclass

import numpy as np

from flexarm_env.thesis import arms
from flexarm_env.thesis.claims.claim import Claim, Part
from flexarm_env.thesis.fixed_step import pinned, simulate
from flexarm_env.thesis.law import Law
from flexarm_env.thesis.runs import DURATION, INTERVAL, PULSE, Floats, pulse

#: The thesis's step [s], and the simulated time [s] that its method is run for here.
STEP, STRETCH = 1e-9, 0.02
#: The run is timed in pieces, of which the shortest counts, since other work on the machine only adds time.
PIECES = 5
#: Twelve hours [s].
THESIS_SECONDS = 12.0 * 3600.0
#: Coarser steps [s] at which the whole five seconds are run, for the convergence of the error.
COARSE = (1e-5, 1e-6)
REPEATS = 20


@dataclass(frozen=True)
class Speed:
    """Processor times and errors of both methods on the pulse of 3 A.

    Attributes:
        per_step: of the thesis's method here, the shortest of some [s].
        method: its five seconds here, extrapolated [s].
        product: the product's five seconds, sampled every millisecond [s].
        error_coarse: largest difference of the hub angle from the product over 5 s, for each of COARSE [rad].
        error_fine: the same over the shorter run at the thesis's step [rad].
    """

    per_step: float
    method: float
    product: float
    error_coarse: tuple[float, ...]
    error_fine: float

    @property
    def ratio(self) -> float:
        """Ratio of the thesis's computing time to the product's, both here."""
        return self.method / self.product


@functools.cache
def measure() -> Speed:
    """Measure times and errors on this machine."""
    law, model = Law(pulse=PULSE), pinned()
    simulate(model, law, 1e-4, 1e-6, 1e-4)
    stretch = simulate(model, law, STRETCH, STEP, INTERVAL)
    times = []
    for _ in range(PIECES):
        began = time.thread_time()
        simulate(model, law, STRETCH / PIECES, STEP, INTERVAL)
        times.append(time.thread_time() - began)
    per_step = min(times) / (STRETCH / PIECES / STEP)
    product, angle = _product()
    coarse = [simulate(model, law, DURATION, step, INTERVAL)[:, 0] for step in COARSE]
    return Speed(
        per_step=per_step,
        method=per_step * DURATION / STEP,
        product=product,
        error_coarse=tuple(float(np.max(np.abs(found - angle))) for found in coarse),
        error_fine=float(np.max(np.abs(stretch[:, 0] - angle[: len(stretch)]))),
    )


def _product() -> tuple[float, Floats]:
    """Time five seconds on the product's plant, the shortest of several runs [s]; also return the hub angle [rad]."""
    plant, commands = arms.combined().plant(INTERVAL), pulse(0.0)
    plant.place()
    readings = plant.replay(commands)
    times = []
    for _ in range(REPEATS):
        plant.place()
        began = time.thread_time()
        plant.replay(commands)
        times.append(time.thread_time() - began)
    return min(times), readings[:, 0]


def twelve_hours() -> Claim:
    """T19."""
    found = measure()
    then = THESIS_SECONDS / (DURATION / STEP)
    return Claim(
        "T19",
        "section 3.4",
        "Five seconds take about twelve hours at a step of 1e-9 s, in C on an SGI Origin 2000.",
        [
            Part(
                f"the same method and step take {1e9 * found.per_step:.0f} ns a step here, {found.method:.0f} s for five "
                f"seconds (the shortest of {PIECES} stretches of {STRETCH / PIECES / STEP:.0e} steps), where twelve hours "
                f"are {1e6 * then:.1f} µs a step",
                found.per_step < then,
                {"step here [s]": found.per_step, "five seconds here [s]": found.method, "step then [s]": then},
            ),
            Part(
                f"the product takes {1e3 * found.product:.2f} ms: {found.ratio:.0e} times as fast as that method here, "
                f"{THESIS_SECONDS / found.product:.0e} times as fast as twelve hours",
                found.ratio > 1.0,
                {
                    "product [s]": found.product,
                    "method over product": found.ratio,
                    "12 h over product": THESIS_SECONDS / found.product,
                },
            ),
            Part(
                f"the method's error falls with its step: hub angle off by {found.error_coarse[0]:.0e} and "
                f"{found.error_coarse[1]:.0e} rad at steps of {COARSE[0]:.0e} and {COARSE[1]:.0e} s, by "
                f"{found.error_fine:.0e} rad over the stretch at 1e-9 s",
                found.error_coarse[1] < 0.2 * found.error_coarse[0],
                {
                    "error at 1e-5 s [rad]": found.error_coarse[0],
                    "error at 1e-6 s [rad]": found.error_coarse[1],
                    "error at 1e-9 s, stretch [rad]": found.error_fine,
                },
            ),
        ],
        "a fixed step must be short because each change between slip and stick is found a step late, and the error is as "
        "large as the step. The product moves the linear arm exactly and finds the changes inside a sample; an "
        "independent solver agrees with it to 1e-9 of each signal (tests/plant), which is below what the method reaches "
        "at its step.",
    )
