"""The run to record next: the input on which the hypotheses that the data leave open differ most."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.experiments.simulate import simulate
from flexarm_env.parameters import INPUTS, reading_noise
from flexarm_env.recordings.recording import Recording

Floats = NDArray[np.float64]

DURATION = 10.0
#: Shares of the drive's limit at which open-loop inputs are tried, and the seeds of the experiments.
SHARES, SEEDS = (0.15, 0.3, 0.6, 0.9), (11, 12)
#: Frequencies [Hz] between which a chirp rises, and for how long [s] a ramp climbs.
CHIRP, RAMP_TIME = (0.3, 15.0), 4.0
#: A difference of this many standard deviations of the noise per sample separates two hypotheses in one run.
DECISIVE = 1.0


@dataclass(frozen=True)
class NextRun:
    """An input to apply to the machine.

    Attributes:
        name: the input in words.
        separates: the effects between which it decides; empty where the data were insufficient for a diagnosis.
        difference: rms between the two hypotheses that are closest on it, over the noise.
        time: (samples,) [s].
        command: (samples,) [A or V].
        input_kind: "current" or "voltage".
    """

    name: str
    separates: tuple[str, ...]
    difference: float
    time: Floats
    command: Floats
    input_kind: str

    @property
    def why(self) -> str:
        """The reason to record it, in one sentence."""
        if not self.separates:
            return f"record {self.name}: it breaks away both ways and comes to rest"
        one_run = self.difference >= DECISIVE
        verdict = "it decides" if one_run else "it is the best of those tried, and it takes several runs to decide"
        return f"record {self.name}: {verdict} between {' and '.join(self.separates)} ({self.difference:.2g} × the noise apart)"

    def as_json(self) -> dict[str, Any]:
        """Give the input and the reason for it, without its samples."""
        return {"input": self.name, "separates": list(self.separates), "difference": self.difference, "why": self.why}

    def as_csv(self) -> str:
        """Write the input as the text of a recording without signals, which `simulate` plays."""
        rows = "".join(f"{float(t)!r},{float(c)!r}\n" for t, c in zip(self.time, self.command, strict=True))
        return f"time [s],{self.input_kind} [{INPUTS[self.input_kind]}]\n{rows}"


def propose(hypotheses: Mapping[str, Arm], interval: float) -> NextRun | None:
    """Find the input on which the closest two hypotheses differ most.

    This is T-optimality (Atkinson and Fedorov, Biometrika 62 (1975) 57), over a list of inputs.

    Args:
        hypotheses: fitted arms that explain the recordings equally well, by effect; with one there is nothing to decide, and
            the first experiment is returned, a square wave under PD where the arm measures its angle.
        interval: sampling time [s].
    """
    arms = list(hypotheses.values())
    rate = 1.0 / interval
    best: NextRun | None = None
    for name, command in _candidate_inputs(arms[0], rate):
        played = Recording.from_arrays(name, np.arange(len(command)) / rate, arms[0].input, command, {}, require_signal=False)
        readings = [_readings(arm, played) for arm in arms]
        if not all(np.isfinite(r).all() for r in readings):
            continue
        apart = [float(np.sqrt(np.mean((a - b) ** 2))) for a, b in combinations(readings, 2)]
        difference = min(apart, default=0.0)
        if best is None or difference > best.difference:
            separates = tuple(hypotheses) if len(arms) > 1 else ()
            best = NextRun(name, separates, difference, played.time, played.command, arms[0].input)
    return best


def _readings(arm: Arm, played: Recording) -> Floats:
    """Simulate the readings (samples, signals), in standard deviations of their noise."""
    run = simulate(arm, played, noise=False)
    noise = [reading_noise(s) or 1.0 for s in arm.sensors.values()]
    return np.stack([run.signals[s] for s in arm.signals], axis=1) / np.array(noise)


def _candidate_inputs(arm: Arm, rate: float) -> list[tuple[str, Floats]]:
    """List the inputs to try, each a name and commands (samples,) within the drive's limit."""
    time = np.arange(round(DURATION * rate)) / rate
    found = []
    for experiment, words in (("square", "a square wave under PD"), ("sweep", "a slow swing with tones"), ("pulse", "pulses")):
        for seed in SEEDS:
            try:
                found.append((words, simulate(arm, experiment, DURATION, rate, seed).command))
            except InputError:
                continue  # an arm without an angle sensor has no closed loop
    limit = arm.constants["drive"]["limit"] or float(max(np.abs(c).max() for _, c in found))
    phase = 2.0 * np.pi * (CHIRP[0] * time + 0.5 * (CHIRP[1] - CHIRP[0]) / DURATION * time**2)
    ramp = np.interp(time % (2.0 * RAMP_TIME), [0.0, RAMP_TIME, 2.0 * RAMP_TIME], [0.0, 1.0, 0.0])
    sign = np.where((time // (2.0 * RAMP_TIME)) % 2 == 0, 1.0, -1.0)
    for share in SHARES:
        found.append((f"a chirp of {100 * share:.0f} % of the limit", share * limit * np.sin(phase)))
        found.append((f"slow ramps to {100 * share:.0f} % of the limit and back, both ways", share * limit * sign * ramp))
    return found
