"""Small simulator of rotary axes, rigid or with a beam in its clamped modes, under a sampled controller.

It shares no code with the plant: the axis takes semi-implicit Euler steps of 20 µs, with exact sticking.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from flexarm_env import Arm, Recording

Floats = NDArray[np.float64]

#: [s], of the integrator.
STEP = 2e-5
#: Roots of cos(z) cosh(z) = -1, the clamped and free beam.
ROOTS = np.array([1.87510407, 4.69409113, 7.85475744])
#: Frequencies [Hz] of the tones of a sweep.
TONES = (0.4, 0.7, 1.1, 1.7, 2.9, 4.3, 5.9, 7.3, 10.3)
#: [s], of the beam's Kelvin–Voigt damping.
BEAM_DAMPING = 5e-4
#: [rad/s], over which Stribeck friction falls.
FALLOFF = 0.3


@dataclass(frozen=True)
class Machine:
    """An axis that has more than its model.

    Attributes:
        table: arm file of the model.
        gains: of the controller, proportional [V/rad or A/rad] and derivative [V s/rad or A s/rad], by the hub.
        coulomb: friction [Nm].
        stribeck: more of it at rest [Nm].
        viscous: friction [Nms].
        torque: constant, on the hub [Nm].
        cable: stiffness of a spring on the hub [Nm/rad].
        rate: samples per second [Hz].
        duration: of a recording [s].
    """

    table: dict[str, Any]
    gains: tuple[float, float]
    coulomb: float = 0.0
    stribeck: float = 0.0
    viscous: float = 0.0
    torque: float = 0.0
    cable: float = 0.0
    rate: float = 500.0
    duration: float = 10.0

    @property
    def arm(self) -> Arm:
        """The model."""
        return Arm.from_table(self.table, self.table["name"])

    def record(self, experiment: str, seed: int) -> Recording:
        """Simulate an experiment, "square" or "sweep", and round the readings as the sensors do."""
        arm, count = self.arm, round(self.duration * self.rate)
        time = np.arange(count) / self.rate
        rng = np.random.default_rng([seed, zlib.crc32(experiment.encode())])
        limit = float(arm.value("drive.limit"))
        target, feed = _plan(experiment, time, limit, rng)
        drive, modes = self._drive(arm), self._modes(arm)
        friction = np.array([self.coulomb, self.stribeck, self.viscous, self.torque, self.cable])
        substeps = round(1.0 / self.rate / STEP)
        command, motion = _run(target, feed, np.array([*self.gains, limit]), drive, modes, friction, STEP, substeps)
        signals = {name: self._read(arm, name, motion, rng) for name in arm.signals}
        return Recording.from_arrays(experiment, time, arm.input, np.round(command, 5), signals)

    def _drive(self, arm: Arm) -> Floats:
        """Compute inertia [kg m²] of hub and motor, torque per command [Nm/A or Nm/V], and per hub speed [Nms]."""
        gear, constant = (float(arm.value(f"drive.{name}")) for name in ("gear_ratio", "torque_constant"))
        inertia = float(arm.value("hub.inertia")) + gear**2 * float(arm.value("drive.motor_inertia"))
        if arm.input == "current":
            return np.array([inertia, gear * constant, 0.0])
        resistance = float(arm.value("drive.resistance"))
        return np.array([inertia, gear * constant / resistance, (gear * constant) ** 2 / resistance])

    def _beam(self) -> tuple[float, float, float]:
        beam = self.table.get("beam", {"length": 0.0, "mass_per_length": 0.0, "bending_stiffness": 0.0})
        return beam["length"], beam["mass_per_length"], beam["bending_stiffness"]

    def _modes(self, arm: Arm) -> Floats:
        """Compute of each clamped mode, at unit modal mass, its squared frequency and its share in the hub's motion [kg^½ m].

        A last row has the inertia of the rigid beam about the hub [kg m²].
        """
        length, density, stiffness = self._beam()
        if not length:
            return np.zeros((1, 2))
        rows = np.zeros((len(ROOTS) + 1, 2))
        rows[:-1, 0] = (ROOTS / length) ** 4 * stiffness / density
        rows[:-1, 1] = 2.0 * length**2 / ROOTS**2 * np.sqrt(density / length)
        rows[-1, 1] = density * length**3 / 3.0
        return rows

    def _read(self, arm: Arm, signal: str, motion: Floats, rng: np.random.Generator) -> Floats:
        """Read a signal (samples,) from hub angle, hub speed and modes (samples, 2 + modes), with noise and rounding."""
        length, density, stiffness = self._beam()
        sensor = arm.sensors[signal]
        if signal == "arm_angle":
            true = motion[:, 0]
        elif signal == "motor_speed":
            true = float(arm.value("drive.gear_ratio")) * motion[:, 1]
        elif signal == "tip_deflection":
            true = motion[:, 2:] @ (np.array([2.0, -2.0, 2.0]) / np.sqrt(density * length))
        else:  # strain at the root
            bends = 2.0 * stiffness * (ROOTS / length) ** 2 / np.sqrt(density * length)
            true = sensor["gain"] * (motion[:, 2:] @ bends)
        noisy = true + sensor["noise"] * rng.standard_normal(len(true))
        step = sensor["resolution"]
        return np.round(noisy / step) * step if step else noisy


def _plan(experiment: str, time: Floats, limit: float, rng: np.random.Generator) -> tuple[Floats, Floats]:
    """Plan the target (samples,) [rad] and the command beside the controller's (samples,) [A or V]."""
    if experiment == "square":
        return np.where(np.floor(time / 1.25) % 2 == 0, 0.8, -0.8), np.zeros_like(time)
    tones = sum(np.sin(2.0 * np.pi * (f * time + rng.random())) for f in TONES)
    return 0.6 * np.sin(2.0 * np.pi * 0.13 * time), 0.08 * limit * np.asarray(tones)


@njit(cache=True)
def _run(
    target: Floats, feed: Floats, gains: Floats, drive: Floats, modes: Floats, friction: Floats, step: float, substeps: int
) -> tuple[Floats, Floats]:
    """Simulate an axis from rest: commands (samples,), and hub angle, hub speed and modes (samples, 2 + modes)."""
    count, flexible = len(target), len(modes) - 1
    own, by_command, by_speed = drive
    coulomb, stribeck, viscous, torque, cable = friction
    inertia = own + modes[flexible, 1]
    for i in range(flexible):
        inertia -= modes[i, 1] ** 2
    command, motion = np.zeros(count), np.zeros((count, 2 + flexible))
    angle = speed = 0.0
    q, v = np.zeros(flexible), np.zeros(flexible)
    for k in range(count):
        motion[k, 0], motion[k, 1] = angle, speed
        motion[k, 2:] = q
        wanted = gains[0] * (target[k] - angle) - gains[1] * speed + feed[k]
        command[k] = min(max(wanted, -gains[2]), gains[2])
        for _ in range(substeps):
            push = by_command * command[k] - (by_speed + viscous) * speed + torque - cable * angle
            for i in range(flexible):
                push += modes[i, 1] * modes[i, 0] * (q[i] + BEAM_DAMPING * v[i])
            dry = coulomb + stribeck * np.exp(-((speed / FALLOFF) ** 2))
            before = speed
            if speed == 0.0:
                speed = step * np.sign(push) * max(abs(push) - dry, 0.0) / inertia
            else:
                speed += step * (push - np.sign(speed) * dry) / inertia
                if speed * before < 0.0:
                    speed = 0.0
            for i in range(flexible):
                v[i] += -step * modes[i, 0] * (q[i] + BEAM_DAMPING * v[i]) - modes[i, 1] * (speed - before)
                q[i] += step * v[i]
            angle += step * speed
    return command, motion
