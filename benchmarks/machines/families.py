"""The families of machines. A family is one entry of FAMILIES: a function that draws a model."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from benchmarks.machines.model import Model, Rng, log_uniform
from benchmarks.machines.parts import (
    Size,
    axis,
    beam,
    current,
    encoder,
    friction,
    gages,
    inertias,
    tachometer,
    tip,
    torque,
    voltage,
)

Table = dict[str, Any]


def _model(family: str, size: Size, drive: Mapping[str, Any], hub: float, rotary: bool = True, **tables: Any) -> Model:
    """Put the tables of an arm file together; a torque constant is known from a data sheet in one of three."""
    drive = dict(drive)
    fixed = ["drive.torque_constant"] if drive.pop("sure") else []
    table = {"name": family, "fixed": fixed, "drive": drive, "hub": {"inertia": hub}} | tables
    return Model(family, table, size.torque, size.inertia, size.angle, size.bandwidth, rotary)


def _rigid(family: str, draw: Rng, size: Size, drive: Table, **effects: Table) -> Model:
    """Draw a rigid axis on a drive."""
    motor, hub = inertias(draw, size.inertia, drive["gear_ratio"], bare=drive["gear_ratio"] == 1.0 or draw.random() < 0.3)
    sensors = {"arm_angle": encoder(draw)} | (tachometer(draw, size, drive["gear_ratio"]) if draw.random() < 0.6 else {})
    drive = drive | {"motor_inertia": motor}
    return _model(family, size, drive, hub, sensors=sensors, effects=friction(draw, size) | effects)


def rigid_voltage(draw: Rng) -> Model:
    """Draw a rigid axis that is driven by a voltage."""
    size = axis(draw)
    return _rigid("rigid_voltage", draw, size, voltage(draw, size))


def rigid_current(draw: Rng) -> Model:
    """Draw a rigid axis that is driven by a current."""
    size = axis(draw)
    return _rigid("rigid_current", draw, size, current(draw, size))


def rigid_torque(draw: Rng) -> Model:
    """Draw a rigid axis without gears whose commands are torques: 1 Nm stands for 1 A."""
    size = axis(draw)
    return _rigid("rigid_torque", draw, size, torque(size))


def vertical(draw: Rng) -> Model:
    """Draw a rigid link that hangs down at angle 0, with its weight in the model."""
    size = axis(draw)
    drive = (voltage if draw.random() < 0.5 else current)(draw, size)
    weight = {"torque": float(draw.uniform(0.15, 0.4)) * size.torque, "uphill": math.pi}
    return _rigid("vertical", draw, size, drive, base_tilt=weight)


def elastic_joint(draw: Rng) -> Model:
    """Draw a rigid link on a motor with soft gears."""
    size = axis(draw)
    drive = (voltage if draw.random() < 0.5 else current)(draw, size)
    motor, hub = inertias(draw, size.inertia, drive["gear_ratio"], bare=False)
    reduced = hub * (size.inertia - hub) / size.inertia
    stiffness = (2.0 * math.pi * log_uniform(draw, 5.0, 20.0)) ** 2 * reduced
    drive = drive | {"motor_inertia": motor, "gear_stiffness": stiffness}
    sensors = {"arm_angle": encoder(draw)} | tachometer(draw, size, drive["gear_ratio"])
    return _model("elastic_joint", size, drive, hub, sensors=sensors, effects=friction(draw, size))


def screw(draw: Rng) -> Model:
    """Draw a slide on a screw, in the units of the shipped arm `emps`: 1 m stands for 1 rad, 1 N for 1 Nm."""
    force, travel = log_uniform(draw, 1.0, 1000.0), float(draw.uniform(0.05, 0.3))
    size = axis(draw)
    size = replace(size, torque=force, angle=travel, inertia=size.inertia * force / size.torque * size.angle / travel)
    drive = {**current(draw, size, gear_ratio=1.0), "sure": True, "motor_inertia": 0.0}
    sensors = {"arm_angle": encoder(draw, turn=log_uniform(draw, 0.005, 0.02))}
    return _model("screw", size, drive, size.inertia, rotary=False, sensors=sensors, effects=friction(draw, size))


def _flexible(family: str, draw: Rng, sensors: Callable[[Rng, Size, Mapping[str, float]], Table]) -> Model:
    """Draw a beam on a hub, with sensors of its bending."""
    size, share, frequency = axis(draw), float(draw.uniform(0.3, 0.9)), log_uniform(draw, 0.2, 10.0)
    size = size.slowed(max(0.6 * 2.0 * math.pi * frequency, 1.0))
    drive = (voltage if draw.random() < 0.4 else current)(draw, size)
    ratio = drive["gear_ratio"]
    motor, hub = inertias(draw, (1.0 - share) * size.inertia, ratio, bare=draw.random() < 0.3)
    made, damping = beam(draw, share * size.inertia, frequency)
    readings = {"arm_angle": encoder(draw)} | (tachometer(draw, size, ratio) if draw.random() < 0.6 else {})
    readings |= sensors(draw, size, made)
    effects = friction(draw, size) | ({"beam_damping": {"time": damping}} if draw.random() < 0.5 else {})
    return _model(family, size, drive | {"motor_inertia": motor}, hub, beam=made, sensors=readings, effects=effects)


def flexible_strain(draw: Rng) -> Model:
    """Draw a flexible arm with one strain gage or two."""
    return _flexible("flexible_strain", draw, gages)


def flexible_tip(draw: Rng) -> Model:
    """Draw a flexible arm on which the deflection of the tip is measured."""
    return _flexible("flexible_tip", draw, tip)


FAMILIES: dict[str, Callable[[Rng], Model]] = {
    made.__name__: made
    for made in (
        rigid_voltage,
        rigid_current,
        rigid_torque,
        vertical,
        elastic_joint,
        screw,
        flexible_strain,
        flexible_tip,
    )
}
