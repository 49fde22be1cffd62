"""Take the steps of a part, time each call, and look for numbers that are not finite."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from benchmarks.endurance.actions import actions
from benchmarks.endurance.parts import Part


@dataclass(frozen=True)
class Outcome:
    """What came of a part.

    Attributes:
        calls: timed ones; the first call of an environment may compile and is none of them.
        episodes: that ended.
        seconds: of all timed calls [s].
        median: time of a call [s].
        slowest: the longest call [s].
        slowest_cpu: CPU time of that call [s]; where it is much less, the machine had other work, and the call waited for a core.
        not_finite: call and quantity of the first NaN or infinity, after which nothing is measured; "" for none.
    """

    calls: int
    episodes: int
    seconds: float
    median: float
    slowest: float
    slowest_cpu: float
    not_finite: str

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data."""
        return asdict(self)


def endure(part: Part, envs: Any, clock: Callable[[], float] = time.perf_counter) -> Outcome:
    """Step an environment as often as its part has calls.

    Args:
        part: with the seeds.
        envs: its vector environment, with its arms' states in `envs.batch.states`.
        clock: seconds from any origin.
    """
    arms, draws = part.seeds().spawn(2)
    envs.reset(seed=int(arms.generate_state(1)[0]))
    drawn = actions(np.random.default_rng(draws), part.calls + 1, envs.action_space.shape)
    envs.step(next(drawn))
    times, cpu_times, episodes, not_finite = [], [], 0, ""
    for action in drawn:
        began, cpu_began = clock(), time.thread_time()
        observations, rewards, terminated, truncated, _ = envs.step(action)
        cpu_times.append(time.thread_time() - cpu_began)
        times.append(clock() - began)
        episodes += int(np.count_nonzero(terminated | truncated))
        looked_at = {"observations": observations, "rewards": rewards, "states": envs.batch.states}
        odd = [name for name, values in looked_at.items() if not np.isfinite(values).all()]
        if odd:
            not_finite = f"call {len(times)}: {' and '.join(odd)}"
            break
    slowest = max(times)
    cpu = cpu_times[times.index(slowest)]
    return Outcome(len(times), episodes, sum(times), float(np.median(times)), slowest, cpu, not_finite)
