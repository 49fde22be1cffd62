"""Arms for the tests of the plant: the thesis's constants, and a catalogue with a law or two for each port."""

from __future__ import annotations

import math

import numpy as np

from flexarm_env.plant.active_laws import ActiveLaw
from flexarm_env.plant.plant import Plant
from flexarm_env.plant.structure import Structure
from flexarm_env.sensors.arm_angle import ArmAngle
from flexarm_env.sensors.motor_speed import MotorSpeed
from flexarm_env.sensors.strain_base import StrainBase
from flexarm_env.sensors.strain_mid import StrainMid
from flexarm_env.sensors.tip_deflection import TipDeflection

COULOMB = 1.5 * 0.066 + 0.183
STATIC = 1.5 * 0.09487 + 0.21574
TORQUE_PER_AMP = 1.5 * 0.33
SIGNALS = {
    "arm_angle": ArmAngle.channel(),
    "motor_speed": MotorSpeed.channel(),
    "strain_mid": StrainMid.channel(position=0.55),
    "strain_base": StrainBase.channel(),
    "tip_deflection": TipDeflection.channel(),
}


def coulomb(level):
    return level


def stiction(at_rest, extra):
    if at_rest:
        return extra
    return 0.0


def stribeck(speed, at_rest, extra, scale):
    if at_rest:
        return extra
    return extra * math.exp(-((speed / scale) ** 2))


def cogging(angle, amplitude, cycles):
    return amplitude * math.sin(cycles * angle)


def constant(level):
    return level


def air_drag(velocity, coefficient):
    return -coefficient * abs(velocity) * velocity


def saturation(command, limit):
    return min(max(command, -limit), limit)


CATALOGUE = [
    ("friction", "coulomb", coulomb, ("level",)),
    ("friction", "stiction", stiction, ("extra",)),
    ("friction", "stribeck", stribeck, ("extra", "scale")),
    ("torque", "cogging", cogging, ("amplitude", "cycles")),
    ("torque", "constant", constant, ("level",)),
    ("drag", "air_drag", air_drag, ("coefficient",)),
    ("drive", "saturation", saturation, ("limit",)),
]
VARYING = {"stribeck", "cogging", "air_drag"}


def law(name, *parameters):
    kind = [effect for _, effect, _, _ in CATALOGUE].index(name)
    return ActiveLaw(kind, CATALOGUE[kind][0], parameters, name in VARYING)


FRICTION = (law("coulomb", COULOMB), law("stiction", STATIC - COULOMB))


def thesis_plant(elements=1, laws=FRICTION, interval=0.005, **changes):
    constants = {
        "viscous": 1.5**2 * 0.0008 + 0.1,
        "motor_viscous_share": 0.0177,
        "sensors": SIGNALS if elements else {"arm_angle": ArmAngle.channel(), "motor_speed": MotorSpeed.channel()},
    }
    if elements:
        constants |= {"length": 1.0, "mass_per_length": 0.42381, "bending_stiffness": 68.944e9 * 1.1475e-10}
    structure = Structure(1.5, 0.33, 0.00193, 0.00129, elements=elements, **(constants | changes))
    plant = Plant(structure, laws, CATALOGUE, interval)
    plant.place()
    return plant


def energy(plant, state):
    """Kinetic and elastic energy [J] without that of the gears."""
    size = len(plant.model.names)
    place, speed = state[:size], state[size : 2 * size]
    return 0.5 * (speed @ plant.model.mass @ speed + place @ plant.model.stiffness @ place)


def energy_with_gears(plant, structure):
    """Kinetic and elastic energy [J] of a plant, that of its gears with it."""
    size = len(plant.model.names)
    windup = np.array([{"hub": -1.0, "motor": 1.0}.get(name, 0.0) for name in plant.model.names])
    gears = structure.gear_stiffness * np.outer(windup, windup) if structure.separate_motor else 0.0
    place, speed = np.split(plant.physical()[: 2 * size], 2)
    return 0.5 * (speed @ plant.model.mass @ speed + place @ (plant.model.stiffness + gears) @ place)


def relative(found, wanted):
    return np.max(np.abs(found - wanted)) / np.max(np.abs(wanted))


def pulse(samples=600, start=20, end=120, amperes=3.0):
    k = np.arange(samples)
    return np.where((k >= start) & (k < end), amperes, 0.0)


def noise(seed, samples, sigma=2.0):
    return np.random.default_rng(seed).normal(0.0, sigma, samples)
