"""Write recordings in the practice format, read them back, and replay them through the rig."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .experiments import EXPERIMENTS
from .settings import CONVERTER, STEP
from .simulate import SIGMA, SIGNALS, simulate

COLUMNS = {
    "time [s]": "%.4f",
    "current [A]": "%.5f",
    "arm_angle [rad]": "%.4f",
    "motor_speed [rad/s]": "%.3f",
    "strain_mid [V]": "%.4f",
    "strain_base [V]": "%.4f",
}
LSB = np.array([CONVERTER[name] for name in ("angle", "speed", "strain", "strain")])
FLOOR = np.sqrt(SIGMA**2 + LSB**2 / 12)  # noise and rounding together [rad, rad/s, V, V]


def write_recording(path: Path, data: dict[str, np.ndarray]) -> None:
    """Write what `simulate` returned, without its truth."""
    table = np.column_stack([data[name.split(" ")[0]] for name in COLUMNS])
    # 0.0 is added because rounding leaves negative zeros
    table = np.round(table, 5) + 0.0
    np.savetxt(path, table, delimiter=",", header=",".join(COLUMNS), comments="", fmt=list(COLUMNS.values()))


def write_case(folder: Path | str, settings: dict[str, float], seed: int, *, vary: bool = True) -> list[Path]:
    """Write pulse.csv, square.csv and sweep.csv of one arm into `folder`; return their paths."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / f"{name}.csv" for name in EXPERIMENTS]
    for path in paths:
        write_recording(path, simulate(settings, path.stem, seed, vary=vary))
    return paths


def read_recording(path: Path | str) -> dict[str, np.ndarray]:
    """Return the columns of a recording by name, without units."""
    with open(path, encoding="utf-8") as file:
        names = [column.split(" ")[0] for column in file.readline().strip().split(",")]
        table = np.loadtxt(file, delimiter=",")
    return dict(zip(names, table.T, strict=True))


def replay(settings: dict[str, float], recorded: dict[str, np.ndarray], step: float = STEP) -> np.ndarray:
    """Return (measured - simulated) / noise, shape (n, 4), of a free run under the recorded current.

    The columns are the four signals; an rms of 1 is perfect.
    """
    rate = 1.0 / (recorded["time"][1] - recorded["time"][0])
    quiet = settings | {"noise": 0.0, "quant": 0.0}
    model = simulate(quiet, recorded["current"], 0, rate=round(rate, 6), step=step)
    return np.column_stack([recorded[s] - model[s] for s in SIGNALS]) / FLOOR
