"""A machine on the rig: what it records, and what it would show without noise."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from benchmarks.machines import translate
from benchmarks.machines.experiments import Run
from benchmarks.machines.model import Model
from benchmarks.machines.translate import Settings
from flexarm_env import Recording
from tests.rig import READINGS, TRUTHS, Plan, perform

Floats = NDArray[np.float64]
HUB_SPEED = TRUTHS.index("hub_speed")
#: Signals of the rig's converters.
CONVERTERS = {"angle": "arm_angle", "speed": "motor_speed", "strain": "strain_base", "tip": "tip_deflection"}
#: Noise of a speed that only the controller gets, over the usual speed.
UNSEEN = 0.01


def settings(machine: Model, effects: Sequence[Settings] = ()) -> Settings:
    """Combine a machine's constants and its effects."""
    found = translate.settings(machine.values, machine.arm.input == "voltage")
    for effect in effects:
        found |= effect
    return found


def record(machine: Model, run: Run, effects: Sequence[Settings] = ()) -> Recording:
    """Record an experiment, with the noise and steps of the sensors."""
    sensors, count = machine.arm.sensors, len(run.plan.feed)
    deviations = [sensors[name]["noise"] if name in sensors else 0.0 for name in READINGS]
    if "motor_speed" not in sensors:
        deviations[READINGS.index("motor_speed")] = UNSEEN * machine.speed * machine.values["drive.gear_ratio"]
    noise = np.array(deviations) * np.random.default_rng(run.seed).standard_normal((count, len(READINGS)))
    steps = {key: sensors[name]["resolution"] if name in sensors else 0.0 for key, name in CONVERTERS.items()}
    made = settings(machine, effects)
    command, shown, _ = perform(made, run.plan, noise, run.rate, steps=steps, step=translate.step(machine.values, made))
    signals = {name: shown[:, READINGS.index(name)] for name in sensors}
    return Recording.from_arrays(run.name, np.arange(count) / run.rate, machine.arm.input, command, signals)


def shown(machine: Model, command: Floats, rate: float, effects: Sequence[Settings] = ()) -> tuple[Floats, Floats]:
    """Replay commands (n,) without noise; return the readings (n, signals) and the hub's speed (n,) [rad/s]."""
    made = settings(machine, effects)
    still = np.zeros_like(command)
    plan = Plan(command, still, (0.0, 0.0, np.inf))
    quiet, steps = np.zeros((len(command), len(READINGS))), dict.fromkeys(CONVERTERS, 0.0)
    _, readings, truth = perform(made, plan, quiet, rate, steps=steps, step=translate.step(machine.values, made))
    return readings[:, [READINGS.index(name) for name in machine.arm.sensors]], truth[:, HUB_SPEED]
