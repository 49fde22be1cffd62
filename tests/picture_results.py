"""Results made by hand for the tests of pictures: noise around motion, which packs worse than any that is measured."""

from __future__ import annotations

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.explain.comparison import Comparison, Replay
from flexarm_env.identify.results import Candidate, Diagnosis, Estimate
from flexarm_env.recordings.recording import Recording

SIGNALS = {"arm_angle": 2e-3, "motor_speed": 0.03, "strain_mid": 0.01, "strain_base": 0.01}
NAMES = ("pulse", "square", "sweep")
GAP = Estimate("effects.backlash.gap", 0.0612, 0.0583, 0.0641, "rad", 0.0)
KPHI = Estimate("drive.torque_constant", 0.3312, 0.3291, 0.3333, "Nm/A", 0.33)


def replay(name: str, samples: int, seed: int) -> Replay:
    draw = np.random.default_rng(seed)
    time = 0.002 * np.arange(samples)
    parts = [
        {s: 3.0 * np.sin(2.0 * time) + draw.normal(0.0, times * noise, samples) for s, noise in SIGNALS.items()}
        for times in (1.0, 5.0, 20.0)
    ]
    return Replay(name, time, *parts, np.arange(samples) % 3)


def comparison(samples: int, seed: int) -> Comparison:
    replays = [replay(name, samples, seed + i) for i, name in enumerate(NAMES)]
    return Comparison(Arm.load("thesis"), [], replays, SIGNALS, 1.5, 12.0)


def recordings(result: Comparison) -> list[Recording]:
    return [Recording.from_arrays(one.name, one.time, "current", np.sin(3.0 * one.time), one.measured) for one in result.replays]


def diagnosis(verdict: str = "effects") -> Diagnosis:
    arm = Arm.load("thesis-fem")
    found = verdict == "effects"
    effects = ["backlash"] if found else []
    error = {"nominal": 4.1, "refitted": 3.7, "final": 1.02 if found else 3.7, **dict.fromkeys(effects, 1.02)}
    ranking = [Candidate("backlash", 0.93, found, [GAP]), Candidate("gear_compliance", 0.9, False, [])]
    equivalent = [["backlash", "gear_compliance"]] if found else []
    better = arm.with_effect("backlash", gap=0.0612) if found else arm
    constants = {"torque_constant": KPHI, "backlash_gap": GAP}
    notes = ["A slow ramp would settle it."]
    free = {key: 10.0 * value for key, value in error.items()}
    probable = [[0.83, 0.12]] if found else []
    parts = (verdict, effects, equivalent, ranking, error, free, constants, better, arm, arm, notes, 1.2, 0)
    return Diagnosis(*parts, probability=probable)
