"""The drive in the linear model: how command and motion make current and torque."""

from __future__ import annotations

from typing import Any

import numpy as np

from flexarm_env.plant.beam import Matrix
from flexarm_env.plant.reading import Current
from flexarm_env.plant.structure import (
    COMMAND,
    DRIVERS,
    HUB_TORQUE,
    MOTOR_TORQUE,
    ONE,
    SHORTEST_LAG,
    LinearModel,
    Structure,
    exceeds,
)


def drive_model(s: Structure, names: list[str], motor: int, mass: Matrix, damping: Matrix, stiffness: Matrix) -> LinearModel:
    """Build the linear model of an arm with its drive, and without sensors yet."""
    size, arms = len(names), mass.shape[:-2]
    drivers = np.zeros((*arms, size, len(DRIVERS)))
    drivers[..., 0, HUB_TORQUE] = 1.0
    drivers[..., motor, MOTOR_TORQUE] = 1.0 if s.separate_motor else 0.0
    drivers[..., 0, ONE] = s.hub_torque
    torque_per_amp = s.torque_by_amp
    amps_per_command, amps_per_angle, amps_per_speed = _amps(s)
    lagged = exceeds(s.current_lag, SHORTEST_LAG)
    extra = int(lagged)
    model = LinearModel(
        names=names,
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        input=drivers,
        from_extra=np.zeros((*arms, size, extra)),
        extra=np.zeros((*arms, extra, extra)),
        extra_from_motion=np.zeros((*arms, extra, 2 * size)),
        extra_from_input=np.zeros((*arms, extra, len(DRIVERS))),
        output=np.zeros((*arms, 0, 0)),
        output_from_input=np.zeros((*arms, 0, len(DRIVERS))),
        beam_force=np.broadcast_to(np.eye(size, 1), (*arms, size, 1)),
        beam_velocity=np.zeros((*arms, 1, size)),
        signals=[],
        settled=np.zeros((*arms, extra, 2 * size)),
        tip=np.zeros((*arms, size)),
    )
    if lagged:
        model.from_extra[..., motor, 0] = torque_per_amp
        model.extra[..., 0, 0] = -1.0 / s.current_lag
        model.extra_from_input[..., 0, COMMAND] = amps_per_command / s.current_lag
        model.extra_from_motion[..., 0, motor] = amps_per_angle / s.current_lag
        model.extra_from_motion[..., 0, size + motor] = amps_per_speed / s.current_lag
    else:
        drivers[..., motor, COMMAND] = torque_per_amp * amps_per_command
        stiffness[..., motor, motor] -= torque_per_amp * amps_per_angle
        damping[..., motor, motor] -= torque_per_amp * amps_per_speed
    return model


def _amps(s: Structure) -> tuple[Any, Any, Any]:
    """Compute the motor current by command, and by angle and speed of the motor's body [A per unit], without limits and lag."""
    per_command = s.amps_by_command * s.command_gain
    per_speed = -s.back_emf / s.resistance if exceeds(s.resistance, 0.0) else 0.0
    if not s.is_servo:
        return per_command, 0.0, per_speed
    return per_command * s.position_gain, -per_command * s.position_gain, per_speed - per_command * s.rate_gain


def motor_current(s: Structure, size: int, motor: int) -> Current | None:
    """Express the motor's current; None where limits make it another function of the motion."""
    if s.has_limits:
        return None
    rows = np.zeros((2, *np.shape(s.hub_inertia), size))
    if exceeds(s.current_lag, SHORTEST_LAG):
        return Current(0.0, rows[0], rows[1], lagged=1.0)
    per_command, rows[0, ..., motor], rows[1, ..., motor] = _amps(s) if exceeds(s.efficiency, 0.0) else (0.0, 0.0, 0.0)
    return Current(per_command, rows[0], rows[1])
