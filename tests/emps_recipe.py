"""The published EMPS recipe: inverse-dynamics least squares, to score any constants as its authors did.

Source: A. Janot, M. Gautier, M. Brunot, *Data Set and Reference Models of EMPS*, Workshop on Nonlinear System
Identification Benchmarks, 2019.  The position is filtered (4th-order zero-phase Butterworth, 100 Hz) and differentiated
twice by central differences; the first 49 samples are dropped, and force and regressors are decimated by 10 alike.
Every digit of the published tables needs MATLAB's edges: `filtfilt` padded by 3 (taps - 1) samples, and `decimate`
keeping the last sample and every tenth before it.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.io import loadmat
from scipy.signal import butter, cheby1, filtfilt

Array = NDArray[np.float64]

SAMPLING = 1000.0  # [Hz]
CUT_OFF = 100.0  # [Hz]
DROPPED = 49  # [samples]
DECIMATION = 10

# M [kg], Fv [N s/m], Fc and offset [N]
published: dict[str, dict[str, float]] = {
    "symmetric": {"M": 95.1089, "Fv": 203.5034, "Fc": 20.3935, "offset": -3.1648},
    "asymmetric": {"M": 95.1540, "Fv+": 166.7061, "Fc+": 20.1440, "Fv-": 240.4236, "Fc-": 20.6277},
}
# on the estimation file and on PULSES [%]
published_errors: dict[str, tuple[float, float]] = {"symmetric": (4.0834, 5.9824), "asymmetric": (3.1117, 5.36)}


class Regressor(NamedTuple):
    """Columns of the least squares and its right-hand side, at 100 Hz, each of shape (samples,)."""

    force: Array  # gtau vir [N]
    accel: Array  # [m/s^2]
    speed: Array  # [m/s]
    sign: Array  # of the speed
    one: Array
    speed_forward: Array  # speed where it is positive, else 0 [m/s]
    sign_forward: Array
    speed_backward: Array  # speed where it is negative, else 0 [m/s]
    sign_backward: Array


def _decimate(signal: Array) -> Array:
    b, a = cheby1(8, 0.05, 0.8 / DECIMATION)
    smooth = filtfilt(b, a, signal, padlen=3 * (len(a) - 1))
    return np.asarray(smooth[(len(signal) - 1) % DECIMATION :: DECIMATION], dtype=np.float64)


def regressor(path: str | Path) -> Regressor:
    """Force [N], acceleration [m/s^2], speed [m/s] and the friction columns of one EMPS `.mat` file."""
    data = loadmat(path)
    position = data["qm"].ravel().astype(np.float64)
    force = float(data["gtau"].item()) * data["vir"].ravel().astype(np.float64)
    b, a = butter(4, 2 * CUT_OFF / SAMPLING)
    speed = np.gradient(filtfilt(b, a, position, padlen=3 * (len(a) - 1)), 1 / SAMPLING)
    accel = np.gradient(speed, 1 / SAMPLING)
    forward, sign = speed > 0, np.sign(speed)
    directed = (speed * forward, sign * forward, speed * ~forward, sign * ~forward)
    columns = (force, accel, speed, sign, np.ones_like(speed), *directed)
    return Regressor(*(_decimate(column[DROPPED:]) for column in columns))


def columns_of(rows: Regressor, names: tuple[str, ...]) -> Array:
    """The regressor's columns that multiply the parameters `names`, shape (samples, len(names))."""
    of = {"M": rows.accel, "Fv": rows.speed, "Fc": rows.sign, "offset": rows.one}
    of |= {"Fv+": rows.speed_forward, "Fc+": rows.sign_forward, "Fv-": rows.speed_backward, "Fc-": rows.sign_backward}
    return np.column_stack([of[name] for name in names])


def relative_error(path: str | Path, parameters: dict[str, float]) -> float:
    """100 ||force - predicted|| / ||force|| [%] of constants under the names of `published`; those not named are 0."""
    rows = regressor(path)
    predicted = columns_of(rows, tuple(parameters)) @ np.array(list(parameters.values()))
    return float(100 * np.linalg.norm(rows.force - predicted) / np.linalg.norm(rows.force))


def least_squares(path: str | Path, names: tuple[str, ...]) -> dict[str, float]:
    """The recipe's own constants for the parameters `names`, in the units of `published`."""
    rows = regressor(path)
    values = np.linalg.lstsq(columns_of(rows, names), rows.force, rcond=None)[0]
    return {name: float(value) for name, value in zip(names, values, strict=True)}
