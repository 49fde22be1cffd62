"""Many arms at a task, moved on together: the one core of the single and the vector environment."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.env import kernel as at
from flexarm_env.env.kernel import after_step
from flexarm_env.env.pool import LINE
from flexarm_env.env.setup import Setup, check_layouts, per_torque_of, sensors_of, settings_of
from flexarm_env.env.threads import Crew
from flexarm_env.env.variation import hash_of
from flexarm_env.errors import InputError
from flexarm_env.plant.batch import TRUTH
from flexarm_env.plant.plant import Plant
from flexarm_env.tasks import REWARD_TERMS

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

#: Names of what an info holds, in the order of the rows that they are read from.
TRUTH_NAMES = ("hub_angle", "hub_speed", "tip_deflection", "stuck")
INFO_NAMES = (*TRUTH_NAMES, "target", "command", *(f"reward_{name}" for name in REWARD_TERMS))


class Batch:
    """Arms at a task, one after another in arrays; arm i draws from its own seed.

    Args:
        setup: what all have in common.
        count: of arms.
        threads: over which steps are spread.
    """

    def __init__(self, setup: Setup, count: int, threads: int = 1) -> None:
        self.setup, self.count = setup, count
        nominal = setup.variation.arm(setup.arm, [0.5] * len(setup.variation.ranges))
        self.plant = nominal.plant(1.0 / setup.rate)
        check_layouts(setup, self.plant)
        self.limit = setup.arm.constants["drive"]["limit"]
        self.sensors = sensors_of(setup)
        shift, self.signals = self.plant.delay_samples, len(setup.arm.sensors)
        if shift < 0:
            raise InputError(f"arm '{setup.arm.name}' has a time offset ahead of its commands, which no environment can have")
        self.waiting, self.delayed = np.zeros((shift, count)), shift > 0
        self.observations = np.zeros((count, self.signals + 1), dtype=np.float32)
        self.first_observation = self.observations[0]
        self.keys, self.seeds = np.zeros(count, dtype=np.uint64), np.zeros(count, dtype=np.uint64)
        self.episodes = np.zeros(count, dtype=np.int64)
        self.step_batch, self.layout = self.plant.kernel.step_batch, self.plant.layout
        self.first_state: Floats | None = None
        self.threads = max(min(threads, count), 1)
        self._allocate()
        given = (self.arena, self.layout, self.physics, self.places, self.keys, self.observations)
        several = self.threads > 1
        self.crew = Crew(self.threads, count, self.step_batch, after_step, given) if several else None

    def _allocate(self) -> None:
        """Lay out all numbers in one array: the kernels pay for each array that they are given."""
        setup, plant, count = self.setup, self.plant, self.count
        late = self.sensors[:, at.WHOLE_DELAY :].any()
        depth = int(self.sensors[:, at.WHOLE_DELAY].max()) + 2 if late else 0
        own_constants = bool(setup.variation.ranges)
        shapes = {
            "settings": (at.SETTINGS,),
            "sensors": self.sensors.shape,
            "told": (at.ROWS, count + LINE - count % LINE),  # rows of a multiple of 512 would push each other out of the cache
            "own": (count, at.COLUMNS),
            "looks": (count, self.signals + TRUTH),
            "asked": (count,),
            "commands": (count,),
            "pushes": (count,),
            "shown": (count, self.signals),
            "history": (count, depth, self.signals),
            "constants": (count if own_constants else 1, plant.constants.size),
            "states": (count, plant.state.size),
            "scratch": (self.threads, plant.scratch.size),
        }
        ends = np.cumsum([math.prod(shape) for shape in shapes.values()])
        first = dict(zip(shapes, [0, *ends[:-1].tolist()], strict=True))
        self.arena = np.zeros(ends[-1])
        views = {name: self.arena[first[name] :][: math.prod(shape)].reshape(shape) for name, shape in shapes.items()}
        self.told, self.own, self.looks = views["told"][:, :count], views["own"], views["looks"]
        self.told_of_first, self.asked, self.commands = self.told[:, 0], views["asked"], views["commands"]
        self.shown, self.history, self.states, self.constants = (
            views["shown"], views["history"], views["states"], views["constants"],
        )  # fmt: skip
        views["settings"][:], views["sensors"][:] = settings_of(setup, self.limit), self.sensors
        self.constants[:] = plant.constants
        each = plant.constants.size if own_constants else 0
        heard = first["commands"] if self.delayed else first["asked"]
        self.physics = np.array(
            [
                first["constants"], each, first["states"], plant.state.size, heard, first["pushes"],
                first["looks"], first["scratch"], plant.scratch.size,
            ]
        )  # fmt: skip
        self.places = np.array(
            [
                first["settings"], first["sensors"], first["own"], first["looks"], self.signals + TRUTH, first["asked"],
                first["pushes"], first["history"], first["shown"], first["told"], views["told"].shape[1], self.signals, depth,
            ]
        )  # fmt: skip

    def close(self) -> None:
        """Let the threads go."""
        if self.crew:
            self.crew.dismiss()
            self.crew = None

    def reset(self, arms: Sequence[int] | Indices, seeds: Sequence[int | None] | None = None) -> None:
        """Start the next episode of some arms; with a seed, their first one of that seed."""
        for i, arm in enumerate(arms):
            seed = None if seeds is None else seeds[i]
            if seed is None:
                self.episodes[arm] += 1
            else:
                self.seeds[arm], self.episodes[arm] = np.uint64(seed % 2**64), 0
        drawn = [self.setup.arm] * len(arms)
        if self.setup.variation.ranges and len(arms):
            drawn = [self.arm_of(int(arm)) for arm in arms]
            self.constants[arms] = self.plant.constants_of([arm.structure() for arm in drawn], [arm.laws() for arm in drawn])
        for i, arm in enumerate(arms):
            self._start(int(arm), drawn[i])

    def _start(self, arm: int, drawn: Arm) -> None:
        setup, own = self.setup, self.own[arm]
        self.keys[arm] = self._key(arm, "sensors")
        plant = self.plant
        if setup.variation.ranges:
            plant.constants[:] = self.constants[arm]
        if setup.variation.ranges or self.first_state is None:
            self.first_state = self._run_up(plant)
        self.states[arm] = self.first_state
        self.waiting[:, arm] = 0.0
        plant.kernel.look_batch(self.arena, plant.layout, self.physics, arm, arm + 1)
        angle = self.looks[arm, -TRUTH]
        own[:] = self.told[:, arm] = 0.0
        own[at.LENGTH], own[at.PER_TORQUE] = drawn.constants.get("beam", {}).get("length", 1.0), per_torque_of(drawn)
        own[at.FIRST_ANGLE] = angle
        own[at.FIRST_TARGET] = self.told[at.TARGET, arm] = angle if setup.task.hold else setup.task.target
        self.history[arm] = self.looks[arm, :-TRUTH]
        self.shown[arm] = self.looks[arm, :-TRUTH]
        at.after_reset(self.arena, self.places, self.keys, self.observations, arm)

    def _run_up(self, plant: Plant) -> Floats:
        """Return the state after what the task lets happen before an episode."""
        task = self.setup.task
        start = np.zeros(plant.states)
        start[: plant.bodies] = task.angle
        plant.place(start)
        pulse, coast = round(task.pulse_time * self.setup.rate), round(task.coast * self.setup.rate)
        if pulse + coast:
            plant.replay(np.concatenate([np.full(pulse, task.pulse * self.limit), np.zeros(coast + 1)]))
        return plant.state.copy()

    def step(self) -> None:
        """Move all arms on by one sample under what is `asked` (arms,) [A or V]."""
        if self.delayed:
            self.commands[:] = self.waiting[0]
            self.waiting[:-1] = self.waiting[1:]
            self.waiting[-1] = self.asked
        if self.crew is None:
            self._step(0, self.count)
        else:
            self.crew.run(self._step)

    def _step(self, first: int, last: int) -> None:
        self.step_batch(self.arena, self.layout, self.physics, first, last, 0)
        after_step(self.arena, self.places, self.keys, self.observations, first, last)

    def ask(self, actions: Floats) -> int:
        """Set the commands of the next step to actions (arms,) · limit; return the first arm whose is no number, or -1."""
        return int(at.admit(actions, self.arena, self.places, self.limit))

    def info(self) -> dict[str, Floats]:
        """Return a copy of what an agent does not see, by name (arms,): the truth, the target, the reward's terms."""
        return dict(zip(INFO_NAMES, self.told[: at.REWARD].copy(), strict=True))

    def arm_of(self, arm: int) -> Arm:
        """Return the arm as it was drawn for the present episode."""
        return self.setup.variation.arm(self.setup.arm, self.draws_of(arm))

    def draws_of(self, arm: int) -> list[float]:
        """Return where in its range, from 0 up to 1, each value that varies was drawn for the present episode."""
        key = self._key(arm, "arm")
        return [at.uniform(key, 0, i) for i in range(len(self.setup.variation.ranges))]

    def _key(self, arm: int, name: str) -> np.uint64:
        """Return the key of an arm's draws of a name in its present episode."""
        return np.uint64(at.key_of(self.seeds[arm], hash_of(name), int(self.episodes[arm])))
