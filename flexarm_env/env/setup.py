"""Task, arm and settings of an environment, and the tables of numbers that its kernel takes."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.env import layout as at
from flexarm_env.env.variation import Disturbance, Variation
from flexarm_env.errors import InputError
from flexarm_env.parameters import INPUTS
from flexarm_env.plant.plant import Plant
from flexarm_env.sensors import Sensor, known_sensors
from flexarm_env.sensors.arm_angle import ArmAngle
from flexarm_env.tasks import CONTROL_RATE, Task
from flexarm_env.tasks.task import LEAST
from flexarm_env.thesis_drive import GEAR_RATIO

Floats = NDArray[np.float64]
MOST_RATE = 10_000.0


@dataclass(frozen=True)
class Setup:
    """Task, arm and settings of an environment.

    Attributes:
        task: start, target, reward, end.
        arm: the nominal one.
        variation: values drawn anew for each episode.
        disturbance: taps and drop-outs.
        rate: control steps per second [Hz].
        physical: whether observations are in physical units; else over typical readings.
    """

    task: Task
    arm: Arm
    variation: Variation = field(default_factory=Variation)
    disturbance: Disturbance = field(default_factory=Disturbance)
    rate: float = CONTROL_RATE
    physical: bool = False

    def __post_init__(self) -> None:
        if not (math.isfinite(self.rate) and 1.0 <= self.rate <= MOST_RATE):
            raise InputError(f"control_rate = {self.rate} Hz; allowed are 1 to {MOST_RATE:g}")
        if not self.arm.constants["drive"]["limit"] > 0.0:
            raise InputError(
                f"arm '{self.arm.name}' states no drive.limit, of which an action is a share; give an arm of your own that "
                f'states it, as arm.with_values({{"drive.limit": 5.0}}) with its largest command [{INPUTS[self.arm.input]}]'
            )
        if not self.arm.sensors:
            raise InputError(f"arm '{self.arm.name}' has no sensors; an environment needs one at least")
        for signal in self.arm.sensors:
            self.arm.reading_noise(signal)  # refuses noise that only recordings give

    @cached_property
    def origin(self) -> str:
        """Name of the task, the arm, and a hash of all numbers on which a step depends: equal ones go on alike."""
        task, arm = self.task, self.arm
        parts = (
            {name: getattr(task, name) for name in (*LEAST, "hold") if name != "duration"},
            [(term.name, term.quantities, task.weight(term)) for term in task.terms],
            [arm.input, arm.constants, arm.sensors, arm.effects],
            [self.variation.ranges, vars(self.disturbance), self.rate, self.physical],
        )
        return f"{task.name}, {arm.name}, {hashlib.sha256(json.dumps(parts, default=_plain).encode()).hexdigest()[:12]}"

    @property
    def samples(self) -> int:
        """Control steps of an episode."""
        return self.task.steps(self.rate)

    @property
    def frame_rate(self) -> int | float:
        """Pictures per second of a film with one picture of each step [Hz]."""
        return int(self.rate) if self.rate.is_integer() else self.rate

    def scales(self) -> Floats:
        """List the divisors of readings and target (signals + 1,)."""
        if self.physical:
            return np.ones(len(self.arm.sensors) + 1)
        return np.array([*(sensor.typical * self._gearing(sensor) for sensor in self._sensors), ArmAngle.typical])

    def bounds(self) -> Floats:
        """List the largest observations of the readings and of the target (signals + 1,)."""
        return self.largest() / self.scales()

    def largest(self) -> Floats:
        """List the ends of the ranges of readings and target (signals + 1,), SI units."""
        return np.array([*(sensor.range_end() * self._gearing(sensor) for sensor in self._sensors), ArmAngle.range_end()])

    @property
    def _sensors(self) -> list[type[Sensor]]:
        return [known_sensors()[signal] for signal in self.arm.sensors]

    def _gearing(self, sensor: type[Sensor]) -> float:
        """Compute the gear ratio over the thesis's for a signal on the motor's side, else 1."""
        return self.arm.constants["drive"]["gear_ratio"] / GEAR_RATIO if sensor.motor_side else 1.0


def _plain(value: Any) -> Any:
    """Convert a mapping or a number of numpy for JSON."""
    return dict(value) if isinstance(value, Mapping) else float(value)


def check_layouts(setup: Setup, plant: Plant) -> None:
    """Refuse ranges over which an arm becomes another kind of arm.

    Raises:
        InputError: naming the ranges.
    """
    ranges = setup.variation.ranges
    for end in (0.0, 1.0) if ranges else ():
        other = setup.variation.arm(setup.arm, [end] * len(ranges)).plant(1.0 / setup.rate)
        if not np.array_equal(other.layout, plant.layout) or other.delay_samples != plant.delay_samples:
            paths = ", ".join(path for path, _, _ in ranges)
            raise InputError(f"the ranges of {paths} change how the arm is built, not only its numbers; narrow them")


def sensors_of(setup: Setup) -> Floats:
    """Tabulate the sensors' numbers (signals, SENSOR)."""
    table = np.zeros((len(setup.arm.sensors), at.SENSOR))
    scales = setup.scales()
    largest = setup.largest()
    for j, sensor in enumerate(setup.arm.sensors.values()):
        late = sensor["delay"] * setup.rate
        whole = math.floor(late + 1e-9)
        step = sensor["resolution"]
        inverse_step = 1.0 / step if step else 0.0
        table[j] = (sensor["noise"], step, inverse_step, largest[j], 1.0 / scales[j], whole, max(late - whole, 0.0))
    return table


def command_per_torque_of(arm: Arm) -> float:
    """Compute the command that gives 1 Nm on the hub at rest [A, V, Nm or rad per Nm]."""
    drive = arm.constants["drive"]
    if arm.input == "position":
        return float(1.0 / arm.structure().torque_by_command)
    command_per_torque = 1.0 / (drive["gear_ratio"] * drive["torque_constant"])
    return command_per_torque * drive["resistance"] if arm.input == "voltage" else command_per_torque


def settings_of(setup: Setup, limit: float) -> Floats:
    """Tabulate the numbers of task, disturbance and reward, in the kernel's order (settings,)."""
    disturbance, rate = setup.disturbance, setup.rate
    settings = np.zeros(at.WEIGHTS + len(setup.task.terms))
    settings[at.INTERVAL], settings[at.HALF_PERIOD], settings[at.RANGE] = 1.0 / rate, setup.task.half_period, setup.task.range
    settings[at.LIMIT], settings[at.TARGET_SCALE] = limit, setup.scales()[-1]
    settings[at.TAP_CHANCE], settings[at.LARGEST_TAP_TORQUE] = disturbance.tap_rate / rate, disturbance.tap_torque
    settings[at.TAP_SAMPLES] = max(round(disturbance.tap_time * rate), 1)
    settings[at.DROP_CHANCE] = disturbance.dropout_rate / rate
    settings[at.DROP_SAMPLES] = max(round(disturbance.dropout_time * rate), 1)
    settings[at.WEIGHTS :] = [setup.task.weight(term) for term in setup.task.terms]
    return settings
