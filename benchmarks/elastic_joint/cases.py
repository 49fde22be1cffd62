"""The cases: a servo on soft gears, made on the rig, and its rigid model, whose delay is too long and whose friction is off."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from benchmarks.answers.place import Place
from benchmarks.machines import translate
from flexarm_env import Arm, Recording
from tests.rig.experiments import Plan
from tests.rig.simulate import perform

Rng = np.random.Generator

#: Samples per second of the recordings, and steps of the servo's loop for each [Hz, 1].
RATE, LOOPS = 1000.0, 10
#: Length of a recording [s]; frequencies of the first one's sweep [Hz]; period of the second one's steps [s].
LENGTH, SWEEP, PERIOD = 8.0, (0.3, 25.0), 1.6
#: Deviation of the link's encoder [rad] and of the motor's speed [rad/s, arm side].
NOISE = {"arm_angle": 2e-4, "motor_speed": 5e-3}
#: Delay of the model as given [s]: what a rigid model was fitted to have.
GIVEN_DELAY = 9.5e-3
#: Largest deviation of the model's friction and inertia from the machine's, as a logarithm.
OFF = 0.2
#: Voltage of the supply [V], and motor turns per arm turn.
SUPPLY, RATIO = 48.0, 50.0


@dataclass(frozen=True)
class Machine:
    """A servo on soft gears, in SI units; everything but the motor's own constants is arm side.

    Attributes:
        link: inertia of the link [kg m²].
        motor: inertia of the motor [kg m²].
        stiffness: of the gears [Nm/rad].
        viscous: friction [Nms].
        coulomb: friction [Nm].
        delay: of the goal [s].
        back_emf: damping by the motor's back-EMF [Nms].
        gain: torque of the loop by its error [Nm/rad].
        angle: amplitude of the motion [rad].
    """

    link: float
    motor: float
    stiffness: float
    viscous: float
    coulomb: float
    delay: float
    back_emf: float
    gain: float
    angle: float

    @property
    def resonance(self) -> float:
        """Frequency at which the link rings on its gears while the motor holds [Hz]."""
        return math.sqrt(self.stiffness / self.link) / (2.0 * math.pi)

    @property
    def torque_constant(self) -> float:
        """Of the motor [Nm/A], with a resistance of 1 ohm."""
        return math.sqrt(self.back_emf) / RATIO

    @property
    def volts_per_angle(self) -> float:
        """Voltage by the error of the loop [V/rad]."""
        return self.gain / (RATIO * self.torque_constant)


def draw_machine(draw: Rng) -> Machine:
    """Draw a machine that rings at 12 to 20 Hz."""
    link = float(10.0 ** draw.uniform(-2.0, -0.5))
    motor = link * float(draw.uniform(0.3, 1.0))
    stiffness = link * (2.0 * math.pi * float(draw.uniform(12.0, 20.0))) ** 2
    loop = 2.0 * math.pi * float(draw.uniform(5.0, 9.0))
    back_emf = 2.0 * float(draw.uniform(0.3, 0.7)) * loop * (link + motor)
    gain, angle = loop**2 * (link + motor), float(draw.uniform(0.2, 0.5))
    viscous, coulomb = back_emf * float(draw.uniform(0.02, 0.1)), gain * angle * float(draw.uniform(0.02, 0.06))
    return Machine(link, motor, stiffness, viscous, coulomb, float(draw.uniform(1e-3, 6e-3)), back_emf, gain, angle)


def model_of(machine: Machine, draw: Rng) -> Arm:
    """Build the model as given: rigid, with the delay of a rigid fit, and with inertia and friction off."""
    factors = dict(zip(("link", "viscous", "coulomb"), np.exp(draw.uniform(-OFF, OFF, 3)), strict=True))
    drive = {
        "input": "position",
        "gear_ratio": RATIO,
        "torque_constant": machine.torque_constant,
        "motor_inertia": machine.motor / RATIO**2,
        "resistance": 1.0,
        "supply_voltage": SUPPLY,
        "proportional": 1.0,
        "error_gain": machine.volts_per_angle / SUPPLY,
        "motor_coulomb_share": 1.0,
        "motor_viscous_share": 1.0,
        "limit": 4.0 * machine.angle,
    }
    effects = {
        "viscous": {"coefficient": machine.viscous * factors["viscous"]},
        "coulomb": {"torque": machine.coulomb * factors["coulomb"]},
        "input_delay": {"delay": GIVEN_DELAY},
    }
    sensors = {"arm_angle": {"noise": NOISE["arm_angle"]}, "motor_speed": {"noise": NOISE["motor_speed"] * RATIO}}
    known = ["drive.torque_constant", "drive.motor_inertia", "drive.error_gain"]
    table = {"drive": drive, "hub": {"inertia": machine.link * factors["link"]}, "effects": effects, "sensors": sensors}
    return Arm.from_table(table | {"fixed": known}, "servo")


def goals(machine: Machine, draw: Rng) -> dict[str, np.ndarray]:
    """Draw the goals (samples,) of each recording [rad]: a sweep, and steps of several sizes."""
    time = np.arange(round(LENGTH * RATE)) / RATE
    low, high = SWEEP
    phase = 2.0 * np.pi * low * LENGTH / math.log(high / low) * (np.exp(time / LENGTH * math.log(high / low)) - 1.0)
    sizes = draw.uniform(0.3, 1.0, math.ceil(LENGTH / PERIOD)) * np.where(np.arange(math.ceil(LENGTH / PERIOD)) % 2, -1.0, 1.0)
    steps = np.where(time > 0.1, sizes[(time / PERIOD).astype(int)], 0.0)
    return {"sweep": machine.angle * np.sin(phase), "steps": machine.angle * steps}


def record(machine: Machine, name: str, goal: np.ndarray, seed: int) -> Recording:
    """Make a recording on the rig, whose loop acts on the motor's angle at several times the rate of the samples."""
    rate, held = RATE * LOOPS, np.repeat(goal, LOOPS)
    late = round(machine.delay * rate)
    target = np.concatenate([np.zeros(late), held])[: len(held)]
    settings = {"gear": RATIO, "kphi": machine.torque_constant, "ra": 1.0, "jm": machine.motor / RATIO**2, "jh": machine.link}
    settings |= {"volts": 1.0, "servo": 1.0, "elements": 0.0, "joined": 0.0, "split": 1.0, "bs": 0.0, "taf": 0.0, "tas": 0.0}
    settings |= {"bm": machine.viscous / RATIO**2, "tmf": machine.coulomb / RATIO, "tms": machine.coulomb / RATIO}
    settings |= translate.gears(machine.stiffness)
    noise = np.zeros((len(held), 5))
    gains = (machine.volts_per_angle, 0.0, SUPPLY)
    steps = {"angle": 0.0, "speed": 0.0, "strain": 0.0, "tip": 0.0}
    _, shown, _ = perform(settings, Plan(np.zeros_like(held), target, gains), noise, rate, steps=steps)
    draw, kept = np.random.default_rng(seed), slice(None, None, LOOPS)
    angle = shown[kept, 0] + NOISE["arm_angle"] * draw.standard_normal(len(goal))
    speed = shown[kept, 1] + NOISE["motor_speed"] * RATIO * draw.standard_normal(len(goal))
    time = np.arange(len(goal)) / RATE
    return Recording.from_arrays(name, time, "position", goal, {"arm_angle": angle, "motor_speed": speed})


class Key(Place):
    """The place of a servo."""

    def pose(self) -> tuple[dict[str, Any], Arm, list[Recording]]:
        """Make the case: its plain data, the arm as given and the recordings. The same key gives the same bits."""
        draw = np.random.default_rng([self.seed, self.index])
        machine = draw_machine(draw)
        arm = model_of(machine, draw)
        recordings = [record(machine, name, goal, int(draw.integers(2**31))) for name, goal in goals(machine, draw).items()]
        return self.as_json() | {"machine": asdict(machine) | {"resonance": machine.resonance}}, arm, recordings
