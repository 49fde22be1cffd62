"""Results of comparing, fitting, adding and diagnosing."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.display import Shown
from flexarm_env.experiments.next_run import NextRun
from flexarm_env.identify.calibrate.estimate import Estimate
from flexarm_env.identify.explain.budget import Budget
from flexarm_env.identify.explain.detection_limits import DetectionLimit
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.settings import SETTINGS, Settings

Floats = NDArray[np.float64]

#: Verdicts that name effects.
NAMING = ("effects", "partly")


@dataclass(frozen=True)
class Fit:
    """An arm with its constants refitted.

    Attributes:
        arm: the refitted arm, which carries the intervals.
        estimates: every fitted value.
        error: "nominal", "refitted": rms over noise on the held-out part, in windows of 1 s.
        free_run: the same, replayed once from the start.
        closed_loop: the same in closed loop, where the recordings were made in a known one; else empty.
        seconds: time taken.
        settings: numbers of the method.
        notes: a sentence each for a person, on the recordings.
    """

    arm: Arm
    estimates: list[Estimate]
    error: dict[str, float]
    free_run: dict[str, float]
    seconds: float
    settings: Settings = SETTINGS
    closed_loop: dict[str, float] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Addition:
    """An arm with one effect more.

    Attributes:
        arm: the new arm.
        effect: the added one.
        estimates: the effect's parameters, then the constants.
        error: "nominal", "refitted" (constants only), "final" (with the effect): rms over noise, held out, windows of 1 s.
        free_run: the same, replayed once from the start.
        closed_loop: the same in closed loop, where the recordings were made in a known one; else empty.
        seconds: time taken.
        settings: numbers of the method.
        notes: a sentence each for a person, on the recordings.
    """

    arm: Arm
    effect: str
    estimates: list[Estimate]
    error: dict[str, float]
    free_run: dict[str, float]
    seconds: float
    settings: Settings = SETTINGS
    closed_loop: dict[str, float] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Candidate:
    """One effect in the ranking.

    Attributes:
        effect: its name.
        gain: share of the refitted model's excess held-out error that it removes, 0 to 1.
        accepted: whether the diagnosis takes it.
        estimates: its fitted parameters.
    """

    effect: str
    gain: float
    accepted: bool
    estimates: list[Estimate]


@dataclass(frozen=True)
class Diagnosis(Shown):
    """The diagnosis of an arm, and the corrected arm.

    Attributes:
        verdict: "nothing_missing", "parameters", "effects", "partly" (effects are named, and more than the noise is left),
            "unknown", "recordings" or "insufficient_data".
        effects: those accepted, in the order of their weight.
        equivalent: for each accepted effect, all that these data cannot tell from it, itself first.
        probability: of each name in `equivalent`, in the same order.
        ranking: candidates by gain.
        error: "nominal", "refitted", "final", and one entry after each accepted effect under its name, of the model that has it
            and those before it; rms over noise, held out, windows of 1 s.
        free_run: the same, replayed once from the start.
        closed_loop: the same in closed loop, where the recordings were made in a known one; else empty.
        constants: all fitted values of the final arm by short name.
        arm: the corrected arm.
        nominal: the arm that came in.
        refitted: the arm with only its constants refitted.
        notes: a sentence each for a person: findings on the recordings, and the remaining error.
        smallest: the size of each effect that is not accepted up to which it would go undetected in these recordings.
        next_run: the input to record next, where these leave something open.
        recordings: faults of the recordings. Where there are any nothing was searched, and errors are NaN.
        trace: the search, step by step, as plain data.
        settings: numbers of the method.
        seconds: time taken.
        seed: recorded with the result.
        stopped: whether a time limit left something out, which a note names; None without a limit.
        budget: shares of the excess of `error` that constants, each effect and nothing explain, in total and by signal.
    """

    verdict: str
    effects: list[str]
    equivalent: list[list[str]]
    ranking: list[Candidate]
    error: dict[str, float]
    free_run: dict[str, float]
    constants: dict[str, Estimate]
    arm: Arm
    nominal: Arm
    refitted: Arm
    notes: list[str]
    seconds: float = 0.0
    seed: int = 0
    smallest: dict[str, DetectionLimit] = field(default_factory=dict)
    next_run: NextRun | None = None
    recordings: list[Fault] = field(default_factory=list)
    trace: list[dict[str, Any]] = field(default_factory=list)
    settings: Settings = SETTINGS
    closed_loop: dict[str, float] = field(default_factory=dict)
    budget: Budget = field(default_factory=Budget)
    probability: list[list[float]] = field(default_factory=list)
    stopped: bool | None = None

    def __repr__(self) -> str:
        if self.recordings:
            return f"Diagnosis({self.verdict}: {', '.join(fault.kind for fault in self.recordings)})"
        errors = f"error {self.error['nominal']:.3g} -> {self.error['final']:.3g} of the noise"
        return f"Diagnosis({self.verdict}: {', '.join(self.effects) or 'no effect'}, {errors})"

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data for `--json`."""
        return {
            "verdict": self.verdict,
            "effects": self.effects,
            "recordings": [fault.as_json() for fault in self.recordings],
            "equivalent": self.equivalent,
            "probability": self.probability,
            "ranking": [
                {
                    "effect": c.effect,
                    "gain": c.gain,
                    "accepted": c.accepted,
                    "parameters": {e.path.split(".")[-1]: e.as_json() for e in c.estimates},
                }
                for c in self.ranking
            ],
            "budget": self.budget.as_json(),
            "error": self.error,
            "free_run": self.free_run,
            "closed_loop": self.closed_loop,
            "constants": {name: e.as_json() for name, e in self.constants.items()},
            "notes": self.notes,
            "smallest": {name: hidden.as_json() for name, hidden in self.smallest.items()},
            "next_run": self.next_run.as_json() if self.next_run else None,
            "trace": self.trace,
            "settings": self.settings.as_json(),
            "stopped": self.stopped,
            "seconds": round(self.seconds, 1),
            "seed": self.seed,
        }
