"""Cost of the readings' derivatives by twelve constants, over that of one replay."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from flexarm_env import Arm
from flexarm_env.experiments.derivatives import full_path, tangents_of
from flexarm_env.identify.replay.observer import modal_gains

INTERVAL = 0.002
SECONDS = 10.0
ROUNDS = 15
TWELVE = (
    "drive.torque_constant",
    "drive.motor_inertia",
    "hub.inertia",
    "beam.mass_per_length",
    "beam.bending_stiffness",
    "sensors.motor_speed.gain",
    "sensors.arm_angle.gain",
    "sensors.strain_mid.gain",
    "sensors.strain_base.gain",
    "viscous.coefficient",
    "coulomb.torque",
    "stiction.extra",
)
#: By name: the arm, and the effects that it has beside its own.
ARMS: dict[str, tuple[str, tuple[str, ...]]] = {
    "one element": ("thesis", ()),
    "six elements, two bodies": ("thesis-fem", ()),
    "stribeck": ("thesis", ("stribeck",)),
}
COMMANDS: dict[str, Callable[[int], Any]] = {
    "swing": lambda count: 4.0 * np.sin(2.0 * np.pi * 0.7 * INTERVAL * np.arange(count)),
    "noise": lambda count: np.random.default_rng(0).normal(0.0, 2.0, count),
}


def shortest(work: Callable[[], Any]) -> float:
    """Time work: the shortest of several runs [s], since other work on the machine only adds time."""
    times = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def ratios(arm: Arm, command: Any) -> dict[str, float]:
    """Measure a replay [ms] and the derivatives' cost over it, free and corrected by an observer, and the preparation [ms]."""
    plant = arm.plant(INTERVAL)
    paths = [full_path(arm, name) for name in TWELVE]
    tangents = tangents_of(arm, plant, paths)
    physical = np.zeros((plant.modes, plant.states, len(plant.signals)))
    physical[:, 0, 0] = 0.05
    plant.place()
    measured = plant.replay(command)
    observed = (np.zeros(0), modal_gains(plant, physical), measured)

    def run(replay: Callable[..., Any], *options: Any) -> float:
        def once() -> None:
            plant.place()
            replay(command, *options)

        return shortest(once)

    free, corrected = run(plant.replay), run(plant.replay, *observed)
    return {
        "replay_ms": 1e3 * free,
        "over_replay": run(tangents.replay) / free,
        "over_corrected_replay": run(tangents.replay, *observed) / corrected,
        "prepare_ms": 1e3 * shortest(lambda: tangents_of(arm, plant, paths)),
    }


def measure(say: Callable[[str], None]) -> dict[str, Any]:
    """Measure all figures, by name."""
    found: dict[str, Any] = {}
    for name, (base, effects) in ARMS.items():
        arm = Arm.load(base)
        for effect in effects:
            arm = arm.with_effect(effect)
        for kind, command in COMMANDS.items():
            say(f"derivatives by twelve constants: {name}, {kind}")
            found[f"{name}, {kind}"] = ratios(arm, command(round(SECONDS / INTERVAL)))
    return {"jacobian": found, "jacobian_over_replay": max(each["over_corrected_replay"] for each in found.values())}
