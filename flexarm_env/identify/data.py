"""Recordings made ready for identification: whitened, with a start state and a part that is held out."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.identify.load import check_load, loaded_plants, payload_of
from flexarm_env.identify.recording import Recording
from flexarm_env.identify.start import Start, find_start, place_at_start
from flexarm_env.plant.plant import NO_INTERVALS, Plant
from flexarm_env.plant.structure import assemble
from flexarm_env.signals import INPUTS

Floats = NDArray[np.float64]

#: Share of each recording, at its end, that no fit sees.
HELD_OUT = 0.35
#: Noise assumed of a signal whose arm file states none: this share of its range.
DEFAULT_NOISE = 2e-3
WINDOW = 1.0
#: Torque [Nm], range of angle [rad] and range over the root of the time [rad/√s] in recordings of the thesis's arm.
THESIS_TORQUE, THESIS_ANGLE, THESIS_SPEED = 0.35, 2.5, 0.8
FEWEST_SAMPLES = 50


@dataclass(frozen=True)
class Run:
    """One recording as arrays.

    Attributes:
        name: of the recording.
        time: (samples,) [s].
        command: (samples,) [A or V].
        measured: (samples, signals), SI units.
        intervals: (samples,) times to the next sample [s] where sampling is uneven, else empty.
        train: (samples,) what fits see.
        start: what its first samples say of its state.
        payload: known mass at the tip [kg], beside what the arm has there.
    """

    name: str
    time: Floats
    command: Floats
    measured: Floats
    intervals: Floats
    train: NDArray[np.bool_]
    start: Start
    payload: float = 0.0


@dataclass(frozen=True)
class Data:
    """Runs of one arm with their common sampling time [s] and the standard deviation of each signal's noise.

    Attributes:
        runs: one for each recording.
        signals: names in the order of the columns.
        interval: sampling time [s].
        noise: (signals,) standard deviation, SI units.
        scales: by unit, how much larger quantities are here than in the thesis's arm, for which typical sizes are given.
    """

    runs: list[Run]
    signals: list[str]
    interval: float
    noise: Floats
    scales: Mapping[str, float]

    @functools.cached_property
    def fitted(self) -> list[Run]:
        """The runs cut down to the part that fits see."""
        return [_cut(run, int(run.train.sum())) for run in self.runs]

    def plants(self, arm: Arm) -> dict[float, Plant]:
        """Return an arm's plants by the payload [kg] of the runs, which carry it."""
        return loaded_plants(arm, (run.payload for run in self.runs), self.interval)


def everything(data: Data) -> Data:
    """Return the data with nothing held out."""
    return replace(data, runs=[replace(run, train=np.ones_like(run.train)) for run in data.runs])


def _cut(run: Run, count: int) -> Run:
    return replace(
        run,
        time=run.time[:count],
        command=run.command[:count],
        measured=run.measured[:count],
        intervals=run.intervals[:count],
        train=run.train[:count],
    )


def prepare(arm: Arm, recordings: Sequence[Recording]) -> tuple[Arm, Data]:
    """Return the arm reduced to the sensors that all recordings have, and the recordings as arrays.

    Raises:
        InputError: for recordings that do not fit the arm.
    """
    if not recordings:
        raise InputError("no recordings: name at least one CSV file or a folder of them")
    signals = [s for s in arm.signals if all(s in r.signals for r in recordings)]
    if not signals:
        raise InputError(f"no signal is in all recordings and in arm '{arm.name}', which has {', '.join(arm.signals)}")
    for recording in recordings:
        if recording.input_kind != arm.input:
            other = next(kind for kind in INPUTS if kind != arm.input)
            raise InputError(f"{recording.name} holds {other}, but arm '{arm.name}' is driven by {arm.input}")
        check_load(arm, recording)
        if len(recording) < FEWEST_SAMPLES:
            raise InputError(f"{recording.name} has {len(recording)} samples; at least {FEWEST_SAMPLES} are needed")
    intervals = [r.sample_time for r in recordings]
    interval = float(np.median(intervals))
    arm = _with_sensors(arm, signals)
    measured = [np.stack([r.signals[s] for s in signals], axis=1) for r in recordings]
    noise = _noise(arm, signals, measured)
    runs = [_run(r, m, signals, noise, interval) for r, m in zip(recordings, measured, strict=True)]
    return arm, Data(runs, signals, interval, noise, _scales(arm, runs, signals))


def torque_scale(arm: Arm, runs: Sequence[Run]) -> float:
    """Return the rms of the torque that the command gives at the hub [Nm]; without any, of what slows down an arm that coasts."""
    drive = arm.constants["drive"]
    per_command = drive["gear_ratio"] * drive["torque_constant"]
    if arm.input == "voltage":
        per_command /= drive["resistance"]
    command = float(np.sqrt(np.mean([np.mean(run.command**2) for run in runs])))
    return max(per_command * command, 0.0 if command > 0.0 else _slowing_torque(arm, runs), 1e-9 * per_command)


def _slowing_torque(arm: Arm, runs: Sequence[Run]) -> float:
    """Return the largest mean torque [Nm] that the change of the motor's speed over a run takes; 0 where nothing shows it."""
    if "motor_speed" not in arm.signals:
        return 0.0
    structure, tach = arm.structure(), arm.signals.index("motor_speed")
    bodies = 2 if structure.separate_motor else 1
    inertia = np.trace(assemble(structure).mass[:bodies, :bodies])
    return float(inertia / structure.gear_ratio * max(np.ptp(run.measured[:, tach]) / run.time[-1] for run in runs))


def _scales(arm: Arm, runs: Sequence[Run], signals: Sequence[str]) -> dict[str, float]:
    torque = torque_scale(arm, runs) / THESIS_TORQUE
    angle = speed = 1.0
    if "arm_angle" in signals:
        column = signals.index("arm_angle")
        angle = max(float(np.ptp(run.measured[:, column])) for run in runs) / THESIS_ANGLE
        rates = [np.ptp(run.measured[:, column]) / np.sqrt(run.time[-1]) for run in runs]
        speed = max(float(max(rates)), 1e-12) / THESIS_SPEED
    angle = max(angle, 1e-9)
    return {
        "N*m": torque,
        "N*m*s": torque / speed,
        "N*m/rad": torque / angle,
        "rad/N/m": 1.0 / torque,
        "N*s**2/m**3": torque / speed**2,
        "1/rad": 1.0 / angle,
        "rad/s": speed,
    }


def _with_sensors(arm: Arm, signals: list[str]) -> Arm:
    return replace(arm, sensors={s: arm.sensors[s] for s in signals})


def _noise(arm: Arm, signals: list[str], measured: list[Floats]) -> Floats:
    stated = [np.hypot(arm.sensors[s]["noise"], arm.sensors[s]["resolution"] / np.sqrt(12.0)) for s in signals]
    spread = np.ptp(np.concatenate(measured), axis=0)
    return np.array([n if n > 0.0 else max(DEFAULT_NOISE * w, 1e-12) for n, w in zip(stated, spread, strict=True)])


def _run(recording: Recording, measured: Floats, signals: list[str], noise: Floats, interval: float) -> Run:
    time = recording.time - recording.time[0]
    steps = np.diff(time)
    uneven = np.abs(steps - interval).max() > 1e-3 * interval
    train = time < (1.0 - HELD_OUT) * time[-1]
    return Run(
        name=recording.name,
        time=time,
        command=np.ascontiguousarray(recording.command),
        measured=np.ascontiguousarray(measured),
        intervals=np.append(steps, interval) if uneven else NO_INTERVALS,
        train=train,
        start=find_start(time, measured, signals, noise),
        payload=payload_of(recording),
    )


def place(plant: Plant, run: Run, noise: Floats) -> None:
    """Put the plant where a run starts."""
    place_at_start(plant, run.start, run.command, run.intervals, run.measured, noise)
