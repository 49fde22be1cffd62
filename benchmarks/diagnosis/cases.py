"""The fixed cases: ten of the practice recordings' kind, and four kinds of machine."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.diagnosis.machine import Machine
from flexarm_env import Arm, Recording
from tests.rig import SIGNALS, simulate

#: Recordings of an independent simulator, where a checkout has them; the rig makes the like otherwise.
PRACTICE = Path(__file__).resolve().parents[2].parent / "shared" / "measurements" / "practice"
RUNS = ("pulse", "square", "sweep")


@dataclass(frozen=True)
class Case:
    """Recordings of a machine that hides something, and its model.

    Attributes:
        group: by which goals are set.
        hidden: effects that are missing, or the verdict.
        load: makes the arm and the recordings.
    """

    group: str
    hidden: tuple[str, ...]
    load: Callable[[], tuple[Arm, list[Recording]]]


def practice(folder: str, settings: Mapping[str, float]) -> tuple[Arm, list[Recording]]:
    """Read a folder of the practice recordings, or make the like with the rig's settings."""
    arm = Arm.load("thesis-fem")
    if (PRACTICE / folder).is_dir():
        return arm, Recording.read_all(PRACTICE / folder)
    recordings = []
    for run in RUNS:
        made = simulate(dict(settings), run, 0, vary=False)
        signals = {name: np.round(made[name], 5) for name in SIGNALS}
        recordings.append(Recording.from_arrays(run, made["time"], "current", np.round(made["current"], 5), signals))
    return arm, recordings


def machine(made: Machine, experiments: tuple[str, ...]) -> tuple[Arm, list[Recording]]:
    """Simulate the experiments of a machine."""
    return made.arm, [made.record(experiment, seed) for seed, experiment in enumerate(experiments)]


RIGID_VOLTAGE = Machine(
    {
        "name": "rigid-voltage",
        "drive": {
            "input": "voltage",
            "torque_constant": 0.0107,
            "gear_ratio": 48.4,
            "motor_inertia": 0.0,
            "resistance": 3.29,
            "limit": 10.0,
        },
        "hub": {"inertia": 0.0035},
        "sensors": {"arm_angle": {"noise": 4e-4}, "motor_speed": {"noise": 0.68}},
    },
    gains=(8.0, 0.4),
    coulomb=0.035,
    torque=0.012,
    rate=250.0,
)
RIGID_CURRENT = Machine(
    {
        "name": "rigid-current",
        "drive": {"input": "current", "torque_constant": 0.11, "gear_ratio": 9.0, "motor_inertia": 2e-4, "limit": 6.0},
        "hub": {"inertia": 0.05},
        "sensors": {"arm_angle": {"noise": 1e-4, "resolution": 2e-4}},
        "effects": {"viscous": {"coefficient": 0.1}, "coulomb": {"torque": 0.15}},
    },
    gains=(6.0, 0.9),
    viscous=0.1,
    coulomb=0.15,
    stribeck=0.12,
    rate=250.0,
)
FLEXIBLE_TIP = Machine(
    {
        "name": "flexible-tip",
        "drive": {
            "input": "voltage",
            "torque_constant": 0.0077,
            "gear_ratio": 70.0,
            "motor_inertia": 0.0,
            "resistance": 2.6,
            "limit": 10.0,
        },
        "hub": {"inertia": 0.0021},
        "beam": {"elements": 2, "length": 0.42, "mass_per_length": 0.155, "bending_stiffness": 0.33},
        "sensors": {"arm_angle": {"noise": 6e-4, "resolution": 1.5e-3}, "tip_deflection": {"noise": 3e-4}},
    },
    gains=(9.0, 0.5),
    viscous=0.01,
    coulomb=0.03,
)
FLEXIBLE_STRAIN = Machine(
    {
        "name": "flexible-strain",
        "drive": {"input": "current", "torque_constant": 0.8, "gear_ratio": 3.0, "motor_inertia": 8e-3, "limit": 12.0},
        "hub": {"inertia": 0.15},
        "beam": {"elements": 3, "length": 1.4, "mass_per_length": 1.1, "bending_stiffness": 60.0},
        "sensors": {
            "arm_angle": {"noise": 5e-4, "resolution": 5e-4},
            "motor_speed": {"noise": 0.05},
            "strain_base": {"gain": 0.12, "position": 0.0, "noise": 0.01},
        },
        "effects": {"viscous": {"coefficient": 0.4}, "coulomb": {"torque": 0.6}},
    },
    gains=(12.0, 4.0),
    viscous=0.4,
    coulomb=0.6,
    cable=1.5,
)

CASES = {
    "nothing": Case("nothing and parameters", ("nothing_missing",), partial(practice, "p01", {})),
    "parameters": Case("nothing and parameters", ("parameters",), partial(practice, "p02", {"jm": 0.00233, "ksg": 2.45})),
    "beam_damping": Case("one effect", ("beam_damping",), partial(practice, "p03", {"beam_damp": 0.0035})),
    "backlash": Case("one effect", ("backlash",), partial(practice, "p04", {"gap": 0.06})),
    "cable_stiffness": Case("one effect", ("cable_stiffness",), partial(practice, "p05", {"cable": 0.12, "cable0": 0.2})),
    "current_lag": Case("one effect", ("current_lag",), partial(practice, "p06", {"lag": 0.02})),
    "stribeck": Case("one effect", ("stribeck",), partial(practice, "p07", {"stribeck": 0.12, "vs": 0.15})),
    "tach_filter": Case("one effect", ("tach_filter",), partial(practice, "p08", {"tachlag": 0.015})),
    "two": Case("two effects", ("air_drag", "asymmetric_coulomb"), partial(practice, "p09", {"asym": 0.06, "drag": 0.25})),
    "outside": Case("outside the catalogue", ("unknown",), partial(practice, "p10", {"hum": 0.12, "humf": 6.0})),
    "rigid_voltage": Case("rigid axis", ("constant_torque", "coulomb"), partial(machine, RIGID_VOLTAGE, ("square", "sweep"))),
    "rigid_current": Case("rigid axis", ("stribeck",), partial(machine, RIGID_CURRENT, ("square", "sweep"))),
    "flexible_tip": Case(
        "flexible machine", ("beam_damping", "coulomb", "viscous"), partial(machine, FLEXIBLE_TIP, ("square", "sweep", "sweep"))
    ),
    "flexible_strain": Case(
        "flexible machine", ("beam_damping", "cable_stiffness"), partial(machine, FLEXIBLE_STRAIN, ("square", "sweep", "sweep"))
    ),
}
