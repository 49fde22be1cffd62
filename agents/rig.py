"""The independent simulator of tests/rig as a machine, driven by agents sample by sample."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexarm_env.tasks import Task
from flexarm_env.trials.measures import Trajectories
from flexarm_env.trials.rollout import Agent
from flexarm_env.trials.sets import FIRST_SEED
from tests.rig import SIGNALS
from tests.rig.experiments import stream
from tests.rig.settings import make_beam, make_modes, make_par, make_sense, resolve
from tests.rig.simulate import READINGS, SIGMA

from truth_rig.kernel import STATES, TH, interval, latch, moments  # isort: skip  # tests.rig gives the kernel this name

Floats = NDArray[np.float64]

#: Step of the machine's integrator [s]; half of it moves the measures of a slew by less than a hundredth of their size.
STEP = 2e-5
#: Largest current of the drive [A], as in the arms' files.
LIMIT = 5.0


class Machine:
    """One machine in one episode.

    Args:
        settings: of the rig, the hidden effect among them.
        seed: of the sensors' noise.
        samples: of the episode.
        rate: samples per second [Hz].
        signals: that are read.
    """

    def __init__(
        self, settings: Mapping[str, float], seed: int, samples: int, rate: float, signals: Sequence[str] = SIGNALS
    ) -> None:
        values = resolve(dict(settings))
        beam = make_beam(values)
        self.parameters = make_par(values, beam, rate, STEP)
        self.senses = make_sense(values, self.parameters)
        self.modal = make_modes(values, beam, self.parameters["h"])
        size = beam.omega2.size
        self.state, self.bend, self.bend_rate, self.force = np.zeros(STATES), np.zeros(size), np.zeros(size), np.zeros(size)
        self.commands, self.clean = np.zeros(samples), np.zeros((samples + 1, len(READINGS)))
        self.noise = values["noise"] * SIGMA * stream(seed, "drive", "noise").standard_normal((samples + 1, len(SIGNALS)))
        self.steps = np.array([self.senses[f"step_{name}"] for name in ("angle", "speed", "strain", "strain")])
        self.tip_row, self.gain = beam.shape[-1], self.senses["ksg_base"]
        self.read = [SIGNALS.index(signal) for signal in signals]
        self.sample = 0
        latch(self.state, self.bend, self.modal[0], self.senses, 0.0, self.clean[0])

    def readings(self) -> Floats:
        """Read the sensors (signals,), with noise and the converters' steps."""
        late = max(self.sample - int(self.senses["late_samples"]), 0)
        found: Floats = np.rint((self.clean[late, : len(SIGNALS)] + self.noise[self.sample]) / self.steps) * self.steps
        return found[self.read]

    def move(self, command: float) -> None:
        """Hold a command [A] for one sample."""
        self.commands[self.sample] = command
        row = self.clean[self.sample + 1]
        interval(
            self.sample, self.state, self.bend, self.bend_rate, self.parameters, self.senses, self.modal, self.commands,
            self.force, row,
        )  # fmt: skip
        self.sample += 1

    def truth(self) -> tuple[float, float, float]:
        """Return the true hub angle [rad], tip deflection [m] and base strain [V]."""
        _, base = moments(self.bend, self.modal[0])
        return float(self.state[TH]), float(self.tip_row @ self.bend), float(self.gain * base)


def drive(
    agent: Agent, task: Task, settings: Mapping[str, float], count: int, rate: float = 200.0, signals: Sequence[str] = SIGNALS
) -> Trajectories:
    """Drive a machine through `count` episodes of a slew with different noise of the sensors.

    Args:
        agent: that drives.
        task: with a fixed target, from rest at its start.
        settings: of the rig.
        count: of episodes.
        rate: samples per second [Hz].
        signals: that the agent observes.
    """
    samples = round(task.duration * rate)
    machines = [Machine(settings, FIRST_SEED + i, samples, rate, signals) for i in range(count)]
    length = resolve(dict(settings))["length"]
    tip, strain, commands = (np.zeros((samples, count)) for _ in range(3))
    agent.reset(count)
    for k in range(samples):
        seen = np.array([[*machine.readings(), task.target] for machine in machines])
        commands[k] = LIMIT * np.asarray(agent.action(seen), dtype=np.float64)[:, 0]
        for i, machine in enumerate(machines):
            machine.move(commands[k, i])
            angle, bend, strain[k, i] = machine.truth()
            tip[k, i] = angle + bend / length
    still: Any = np.zeros(count)
    return Trajectories(tip, np.full_like(tip, task.target), strain, commands, still > 0.0, still, 1.0 / rate)
