"""Speed and error of the plant: one element with base friction, four elements with six effects, and its peers."""

from __future__ import annotations

import importlib.util
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.peers import Peer
from flexarm_env import Arm

Array = NDArray[np.float64]

INTERVAL = 0.005
SECONDS = 5.0
#: Repetitions of the pulse, each from the state after the last, in the run on the dependence of cost on motion: with six
#: effects the arm then slides most of the time, which costs more than rest.
REPEATED = 10
ROUNDS = 200
FINER = (16, 32)
#: Of structure and drive, three; of friction that varies with direction, speed and angle, three.
SIX = ("stribeck", "asymmetric_coulomb", "position_friction", "cable_stiffness", "beam_damping", "current_lag")


def pulse() -> Array:
    """Build the thesis's pulse [A]: 3 A from 0.5 to 1.0 s."""
    t = INTERVAL * (np.arange(round(SECONDS / INTERVAL) + 1) + 0.5)
    return np.where((t > 0.5) & (t < 1.0), 3.0, 0.0)


def six_effects(elements: int = 4) -> Arm:
    """Build the thesis's arm with four elements and six effects of typical size."""
    arm = Arm.load("thesis").with_values({"beam.elements": elements, "drive.gear_stiffness": 0.0})
    for effect in SIX:
        arm = arm.with_effect(effect)
    return arm


class Timed:
    """A plant with timed steps; the shortest round counts, since other work on the machine only adds time."""

    def __init__(self, arm: Arm, repeated: int = 1) -> None:
        self.plant = arm.plant(INTERVAL)
        self.command = np.tile(pulse(), repeated)
        self.times: list[float] = []

    def round(self) -> None:
        """Time one replay from rest."""
        self.plant.place()
        start = time.perf_counter()
        self.plant.replay(self.command)
        self.times.append((time.perf_counter() - start) / len(self.command))

    @property
    def nanoseconds(self) -> float:
        """Compute the time of a step [ns]."""
        return 1e9 * min(self.times)


def replay(arm: Arm, parts: int = 1) -> Array:
    """Replay the pulse in steps shorter by a factor `parts`: readings (samples, signals)."""
    plant = arm.plant(INTERVAL / parts)
    plant.place()
    return plant.replay(np.repeat(pulse(), parts))[::parts]


def error(found: Array, wanted: Array) -> float:
    """Compute the largest error of any column, over that column's peak."""
    return float(np.max(np.max(np.abs(found - wanted), axis=0) / np.max(np.abs(wanted), axis=0)))


class Independent:
    """Readings of an arm computed by scipy."""

    def __init__(self, arm: Arm) -> None:
        self.peer = Peer(arm.constants, arm.effects)
        size = self.peer.size
        rows = np.zeros((len(arm.sensors), 2 * size + 1))
        for row, (signal, sensor) in zip(rows, arm.sensors.items(), strict=True):
            if signal == "arm_angle":
                row[0] = 1.0
            elif signal == "motor_speed":
                row[size] = arm.constants["drive"]["gear_ratio"]
            else:
                row[:size] = self.peer.moment_row(sensor["position"], arm.constants)
            row *= sensor["gain"]
        self.rows = rows

    def readings(self, states: Array) -> Array:
        """Convert states (samples, states) to readings (samples, signals)."""
        return states @ self.rows.T


def reference() -> Array | None:
    """Solve the base arm by the tests' reference solver of tight tolerance, which shares no code; None without it."""
    path = Path(__file__).resolve().parent.parent / "tests" / "reference.py"
    if not path.is_file():
        return None
    spec = importlib.util.spec_from_file_location("flexarm_tests_reference", path)
    assert spec is not None
    assert spec.loader is not None
    module: Any = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    solver = module.ReferenceArm(elements=1)
    solved = solver.simulate(pulse()[:-1], INTERVAL)
    sensors = Arm.load("thesis").sensors
    bend = [sensors[s]["gain"] * solver.moment_at(sensors[s]["position"], solved["state"][:, : solver.size])
            for s in ("strain_mid", "strain_base")]  # fmt: skip
    return np.column_stack([solved["hub_angle"], 1.5 * solved["hub_speed"], *bend])


def timed(work: Callable[[], Array], times: int) -> tuple[float, Array]:
    """Time work: the shortest of several runs [s], and the result."""
    best, result = np.inf, np.zeros(0)
    for _ in range(times):
        start = time.perf_counter()
        result = work()
        best = min(best, time.perf_counter() - start)
    return best, result


def measure(say: Callable[[str], None]) -> dict[str, Any]:
    """Measure all figures, by name."""
    base_arm, six_arm = Arm.load("thesis"), six_effects()
    base, six, base_on, six_on = Timed(base_arm), Timed(six_arm), Timed(base_arm, REPEATED), Timed(six_arm, REPEATED)
    say("plant: one element and six effects in turns")
    base.plant.replay(base.command)  # compiled or loaded before the timing starts
    for k in range(ROUNDS):
        for timer in (base, six) if k % REPEATED else (base, six, base_on, six_on):
            timer.round()
    ratio = float(np.median(np.array(six.times) / np.array(base.times)))
    found: dict[str, Any] = {
        "base_ns": base.nanoseconds,
        "six_ns": six.nanoseconds,
        "six_over_base": six.nanoseconds / base.nanoseconds,
        "six_over_base_median": ratio,
        "six_repeated_ns": six_on.nanoseconds,
        "six_repeated_over_base": six_on.nanoseconds / base_on.nanoseconds,
        "six_effects": {effect: dict(six_arm.effects[effect]) for effect in SIX},
    }
    found |= _peers(base, base_arm, say)
    say("six effects: against steps 16 and 32 times as short")
    readings = replay(six_arm)
    for parts in FINER:
        found[f"six_error_{parts}_times_finer"] = error(readings, replay(six_arm, parts))
    say("six effects: DOP853 with events at rtol 1e-10, some seconds")
    other = Independent(six_arm)
    seconds, states = timed(lambda: other.peer.exact(pulse(), INTERVAL, 1e-10, 1e-14), 1)
    found |= {"six_error": error(readings, other.readings(states)), "six_dop853_s": seconds}
    return found


def _peers(base: Timed, arm: Arm, say: Callable[[str], None]) -> dict[str, Any]:
    say("peers: LSODA and DOP853 on the same arm and pulse")
    other = Independent(arm)
    readings = replay(arm)
    tight = reference()
    kind = "tests/reference.py: DOP853 at rtol 1e-12, events polished by Newton's method"
    if tight is None:
        tight = other.readings(other.peer.exact(pulse(), INTERVAL, 1e-13, 1e-16))
        kind = "benchmarks/peers.py: DOP853 with events at rtol 1e-13"
    ratios: dict[str, list[float]] = {"lsoda": [], "dop853": []}
    results: dict[str, tuple[float, Array]] = {}
    work = {
        "lsoda": lambda: other.peer.smooth(pulse(), INTERVAL, 1e-6),
        "dop853": lambda: other.peer.exact(pulse(), INTERVAL, 1e-10),
    }
    for _ in range(5):  # in turns with the plant: both run under the same load
        for name, solve in work.items():
            seconds, states = timed(solve, 1)
            base.times.clear()
            for _ in range(5):
                base.round()
            ratios[name].append(seconds / (SECONDS / INTERVAL * min(base.times)))
            results[name] = min((seconds, states), results.get(name, (np.inf, states)), key=lambda pair: pair[0])
    found: dict[str, Any] = {"base_error": error(readings, tight), "reference": kind}
    for name, (seconds, states) in results.items():
        found[f"{name}_s"] = seconds
        found[f"{name}_over_plant"] = float(np.median(ratios[name]))
        found[f"{name}_error"] = error(other.readings(states), tight)
    found["mujoco"] = mujoco_version()
    return found


def mujoco_version() -> str:
    """Read the version of MuJoCo, or "not installed"."""
    if importlib.util.find_spec("mujoco") is None:
        return "not installed"
    from importlib.metadata import version

    return f"{version('mujoco')}, not compared"
