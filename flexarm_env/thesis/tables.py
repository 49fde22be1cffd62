"""Appendix A's printed tables as recordings, each with the thesis's model of it, as inputs of `diagnose`."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.recordings.recording import Recording
from flexarm_env.thesis import arms
from flexarm_env.thesis.appendix import back_emf
from flexarm_env.thesis.constants import EXPERIMENT_2, EXPERIMENT_3, RESISTANCE, TABLE
from flexarm_env.thesis.runs import Floats

#: Uncertainty of the motor's speed in each table [rad/s]: scatter of E over kφ; 1 mA over b; slopes to four digits.
EMF_SCATTER, POWER_SCATTER, RUN_DOWN_SCATTER = 0.04, 0.5, 0.3
#: Duration of each steady state [s], long enough for the transient to decay before the first reading.
EMF_HOLD, POWER_HOLD, READINGS = 2.0, 4.8, 8
#: Motor inertia of experiment 2 [kg m²]: not observable in steady states, which a tenth of the motor's reaches sooner.
POWER_INERTIA = 0.1 * TABLE["J_m"]
#: Durations of the printed initial slope of a run-down and of the rest after it [s].
TANGENT, AT_REST = 0.05, 0.1


def experiment_1() -> tuple[Arm, list[Recording]]:
    """Build the model E = kφ ω, and experiment 1 as a staircase of E [V], which drives a motor without friction."""
    motor = arms.motor_alone()
    drive = {**motor.constants["drive"], "resistance": RESISTANCE, "limit": 0.0}  # which is one of the current
    arm = replace(motor, input="voltage", effects={}, constants={**motor.constants, "drive": drive})
    speed, emf = back_emf()
    return _with_tachometer(arm, EMF_SCATTER, "motor_inertia"), [_staircase("experiment 1", "voltage", emf, speed, EMF_HOLD)]


def experiment_2() -> tuple[Arm, list[Recording]]:
    """Build the model kφ I = b ω + T_f, and experiment 2 as a staircase of currents."""
    stairs = _staircase("experiment 2", "current", EXPERIMENT_2[:, 1] / 1000.0, EXPERIMENT_2[:, 5], POWER_HOLD)
    return _with_tachometer(arms.motor_alone(POWER_INERTIA), POWER_SCATTER, "motor_inertia", "torque_constant"), [stairs]


def experiment_3() -> tuple[Arm, list[Recording]]:
    """Build the thesis's model of the slopes, J dω/dt = −b ω, and each run-down: its slope, then its stop."""
    recordings = []
    for speed, stop, slope, *_ in EXPERIMENT_3:
        time = np.append(np.arange(0.0, TANGENT, TANGENT / 50.0), [stop, stop + AT_REST])
        shown = np.where(time < TANGENT, speed + slope * time, 0.0)
        name = f"run-down from {speed:g} rad/s"
        recordings.append(Recording.from_arrays(name, time, "current", np.zeros(len(time)), {"motor_speed": shown}))
    return _with_tachometer(arms.motor_alone().without_effect("coulomb"), RUN_DOWN_SCATTER, "torque_constant"), recordings


def _with_tachometer(arm: Arm, scatter: float, *known: str) -> Arm:
    """Reduce the arm's sensors to a tachometer of a noise [rad/s]; fix its gain and some constants of the drive."""
    fixed = ("sensors.motor_speed.gain", *(f"drive.{name}" for name in known))
    return replace(arm, fixed=fixed, sensors={"motor_speed": {**arm.sensors["motor_speed"], "noise": scatter}})


def _staircase(name: str, kind: str, commands: Floats, speeds: Floats, hold: float) -> Recording:
    """Join steady states to a recording: each reading is the response to the command before it.

    The rows are shuffled: sorted by speed, as printed, a drift in time would explain any trend with speed.
    """
    order = np.random.default_rng(0).permutation(len(commands))
    command, reached = (np.repeat(column[order], READINGS) for column in (commands, speeds))
    time = hold / READINGS * np.arange(len(command))
    return Recording.from_arrays(name, time, kind, command, {"motor_speed": np.concatenate([[0.0], reached[:-1]])})
