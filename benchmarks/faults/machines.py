"""Machines drawn at random around the shipped arms, and their recordings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexarm_env import Arm, Recording, simulate

NAMES = ("thesis", "thesis-fem", "cu-flexible", "cu-rigid", "emps")
INPUTS = ("pulse", "square", "sweep")
#: Standard deviation of a constant's logarithm where the machine differs from its model.
SPREAD = 0.04
DURATIONS, RATES = (4.0, 10.0), (200.0, 500.0)
CONSTANTS = ("drive.torque_constant", "hub.inertia", "beam.mass_per_length", "beam.bending_stiffness")


def draw(rng: np.random.Generator) -> tuple[Arm, list[Recording]]:
    """Draw a model, and simulate three recordings of a machine that may differ from it by a few percent."""
    model = Arm.load(NAMES[rng.integers(len(NAMES))])
    if model.name != "emps" and rng.random() < 0.3:
        model = _with_steps(model, float(rng.uniform(0.2, 2.0)))
    machine = model
    if rng.random() < 0.7:
        paths = [path for path in CONSTANTS if path.split(".")[0] != "beam" or model.constants.get("beam")]
        machine = model.with_values({path: model.value(path) * float(np.exp(SPREAD * rng.standard_normal())) for path in paths})
    if model.name.startswith("cu") and rng.random() < 0.5:
        machine = machine.with_effect("coulomb", torque=0.02)
        model = model.with_effect("coulomb", torque=0.02)
    duration, rate = float(rng.uniform(*DURATIONS)), float(rng.uniform(*RATES))
    seed = int(rng.integers(2**31))
    inputs = [INPUTS[i] for i in rng.integers(len(INPUTS), size=3)]
    names = [f"{name}-{i}" for i, name in enumerate(inputs, start=1)]
    runs = [simulate(machine, name, duration, rate, seed + i, name=names[i]) for i, name in enumerate(inputs)]
    return model, runs


def _with_steps(arm: Arm, share: float) -> Arm:
    """Give every sensor steps of a share of its noise."""
    return replace(arm, sensors={name: {**one, "resolution": share * one["noise"]} for name, one in arm.sensors.items()})
