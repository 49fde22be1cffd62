"""Machines for the tests of the search, and their recordings as a model takes them up."""

from __future__ import annotations

from flexarm_env import Arm, Recording, simulate
from flexarm_env.identify.replay.dataset import Dataset, prepare


def recorded(machine: Arm) -> list[Recording]:
    return [simulate(machine, kind, duration=4.0, rate=200.0, seed=3) for kind in ("square", "pulse")]


def seen_by(machine: Arm, model: Arm) -> tuple[Arm, Dataset]:
    return prepare(model, recorded(machine))


def limited(arm: Arm, share: float, size: float) -> tuple[Arm, Arm]:
    """A machine whose command is limited to a share of the largest one, and the model without the limit.

    Its amplifier is commanded in units that are `size` times smaller than the arm's.
    """
    drive = arm.constants["drive"]
    values = {"drive.torque_constant": drive["torque_constant"] / size, "drive.limit": drive["limit"] * size}
    model = arm.with_values(values)
    largest = max(float(abs(run.command).max()) for run in recorded(model))
    return model.with_effect("saturation", limit=share * largest), model
