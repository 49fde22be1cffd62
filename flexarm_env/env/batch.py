"""Many arms at a task, moved on together: the one core of the single and the vector environment."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.env import layout as at
from flexarm_env.env.arena import arena_of, env_offsets_of, plant_offsets_of
from flexarm_env.env.compose import environment_kernel
from flexarm_env.env.draws import key_of, uniform
from flexarm_env.env.setup import Setup, check_layouts, command_per_torque_of, sensors_of, settings_of
from flexarm_env.env.shares import Arms
from flexarm_env.env.start import TASK_START, Start, placed
from flexarm_env.env.state import State, check_state
from flexarm_env.env.threads import Crew
from flexarm_env.env.variation import hash_of
from flexarm_env.errors import InputError
from flexarm_env.plant.plant import Plant
from flexarm_env.plant.truth import TRUTH_ANGLE, TRUTH_SIZE

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

#: Arrays on which the next steps of a batch depend.
NUMBERS = ("lasting", "waiting", "seeds", "episodes", "rng_keys", "observations")


class Batch:
    """Arms at a task, one after another in arrays; arm i draws from its own seed.

    Args:
        setup: common to all of them.
        count: of arms.
        threads: over which steps are spread.

    Attributes:
        observations: (arms, signals + 1), float32.
        outcome: of a step (rows, arms), see layout.
        info_rows: rows of the outcome that an info reports, by name.
        info_of: makes the info of one arm from its column of the outcome, as a list.
        requested: commands of the next step (arms,) [A or V].
        noiseless_readings: without noise, delay and steps, then the plant's truth (arms, signals + TRUTH_SIZE), SI units.
        sensor_output: last readings (arms, signals), SI units.
        own: numbers of each arm (arms, COLUMNS), see layout.
        states: of the plant (arms, numbers).
        constants: of the plant (arms, numbers), or of all arms in one row.
        lasting: all numbers of the arms but the scratch of a step.

    Raises:
        InputError: for an arm that no environment can have, or ranges over which it becomes another kind of arm.
    """

    def __init__(self, setup: Setup, count: int, threads: int = 1) -> None:
        self.setup, self.count, self.limit = setup, count, setup.arm.constants["drive"]["limit"]
        self.plant = plant = setup.variation.arm(setup.arm, [0.5] * len(setup.variation.ranges)).plant(1.0 / setup.rate)
        check_layouts(setup, plant)
        if plant.delay_samples < 0:
            raise InputError(f"arm '{setup.arm.name}' has a time offset ahead of its commands, which no environment can have")
        self.waiting, self.delayed = np.zeros((plant.delay_samples, count)), plant.delay_samples > 0
        self.seeds, self.episodes = np.zeros(count, dtype=np.uint64), np.zeros(count, dtype=np.int64)
        self.first_state: Floats | None = None
        self.threads = max(min(threads, count), 1)
        self._allocate(self.threads)

    def _allocate(self, threads: int) -> None:
        """Make the arms' arrays, and the crew that shares them where there are several threads."""
        setup, plant, count, sensors = self.setup, self.plant, self.count, sensors_of(self.setup)
        arena = arena_of(setup, plant, sensors, count, threads)
        views = arena.views
        self.outcome, self.own, self.noiseless_readings = views["outcome"][:, :count], views["own"], views["noiseless"]
        self.requested, self.applied, self.sensor_output = views["requested"], views["applied"], views["sensor_output"]
        self.history, self.states, self.constants = views["history"], views["states"], views["constants"]
        views["settings"][:], views["sensors"][:], self.constants[:] = settings_of(setup, self.limit), sensors, plant.constants
        self.arena, self.lasting = arena.numbers, arena.numbers[: arena.starts["scratch"]]
        self.env_offsets, self.plant_offsets = env_offsets_of(arena), plant_offsets_of(arena, self.delayed)
        self.target_scale = setup.scales()[-1]
        self.layout, self.rng_keys = plant.layout, np.zeros(count, dtype=np.uint64)
        self.observations = np.zeros((count, len(sensors) + 1), dtype=np.float32)
        self.first_outcome, self.first_observation = self.outcome[:, 0], self.observations[0]
        self.kernel = kernel = environment_kernel(setup.task.terms)
        self.step_batch = plant.kernel.step_batch
        self.after_step, self.info_rows, self.info_of = kernel.after_step, kernel.INFO_ROWS, kernel.info_of
        arms = Arms(self.arena, self.layout, self.plant_offsets, self.env_offsets, self.rng_keys, self.observations)
        self.crew = Crew(threads, count, self.step_batch, self.after_step, arms) if threads > 1 else None

    def __reduce__(self) -> tuple[Any, ...]:
        # The views of the arena, the compiled kernels and the threads are made anew.
        return Batch, (self.setup, self.count, self.threads), (self.first_state, self.numbers())

    def __setstate__(self, state: tuple[Floats | None, Mapping[str, NDArray[Any]]]) -> None:
        self.first_state, numbers = state
        self.restore(numbers)

    def numbers(self) -> dict[str, NDArray[Any]]:
        """Copy all numbers on which the next steps depend, by name."""
        return {name: getattr(self, name).copy() for name in NUMBERS}

    def restore(self, numbers: Mapping[str, NDArray[Any]]) -> None:
        """Set all numbers on which the next steps depend."""
        for name in NUMBERS:
            getattr(self, name)[:] = numbers[name]

    def physical(self, arm: int) -> Floats:
        """Compute an arm's state [q, q̇, extra] (states,), see Plant.physical."""
        plant = self.plant
        plant.state[:] = self.states[arm]
        plant.constants[:] = self.constants[arm if len(self.constants) > 1 else 0]
        return plant.physical()

    def state(self) -> State:
        """Copy the state of all arms, with physical states (arms, states)."""
        return State(self.setup.origin, np.array([self.physical(arm) for arm in range(self.count)]), self.numbers())

    def set_state(self, state: Any) -> None:
        """Go on from the state of an equal batch.

        Raises:
            InputError: for a state of another batch, or a value of another type.
        """
        self.restore(check_state(state, self.setup.origin, self.count).numbers)

    def close(self) -> None:
        """Dismiss the threads."""
        if self.crew:
            self.crew.dismiss()
            self.crew = None

    def reset(self, arms: Sequence[int] | Indices, seeds: Sequence[int | None] | None = None, start: Start = TASK_START) -> None:
        """Start the next episode of some arms; with a seed, their first one of that seed.

        Args:
            arms: their numbers.
            seeds: one for each of them, or None.
            start: their states and targets, where these are not the task's.

        Raises:
            InputError: for a state that an arm cannot have; nothing has changed then.
        """
        own, episodes = self.seeds[arms], self.episodes[arms] + 1
        for i, seed in enumerate(seeds or ()):
            if seed is not None:
                own[i], episodes[i] = np.uint64(seed), 0
        drawn, constants = self._drawn(own, episodes)
        states = self._placed(arms, constants, start)
        # Whatever is refused has been refused before this line.
        self.seeds[arms], self.episodes[arms] = own, episodes
        if constants is not None:
            self.constants[arms] = constants
        for i, arm in enumerate(arms):
            self._start(int(arm), drawn[i], states[i])
        self.aim(arms, start)

    def _drawn(self, seeds: NDArray[np.uint64], episodes: Indices) -> tuple[list[Arm], Floats | None]:
        """Draw arms, and compute the plant's constants (arms, numbers) of each; None where all have the same."""
        if not (self.setup.variation.ranges and len(seeds)):
            return [self.setup.arm] * len(seeds), None
        drawn = [self._arm_at(seed, episode) for seed, episode in zip(seeds, episodes, strict=True)]
        return drawn, self._constants_of(drawn)

    def _placed(self, arms: Sequence[int] | Indices, constants: Floats | None, start: Start) -> list[Floats | None]:
        """Compute the plant's numbers of each arm at its given state; None for an arm at the task's start."""
        if start.physical is None:
            return [None] * len(arms)
        found: list[Floats | None] = []
        for i, arm in enumerate(arms):
            if constants is not None:
                self.plant.constants[:] = constants[i]
            found.append(placed(self.plant, start.physical[arm]))
        return found

    def _constants_of(self, drawn: Sequence[Arm]) -> Floats:
        """Compute the plant's constants (arms, numbers) of drawn arms.

        Raises:
            InputError: for an arm of another kind, which the ends of the ranges did not show.
        """
        try:
            return self.plant.constants_of([arm.structure() for arm in drawn], [arm.laws() for arm in drawn])
        except ValueError:
            paths = ", ".join(path for path, _, _ in self.setup.variation.ranges)
            raise InputError(f"the ranges of {paths} change how the arm is built, not only its numbers; narrow them") from None

    def aim(self, arms: Sequence[int] | Indices, start: Start) -> None:
        """Set the targets of some arms where they are not the task's, at the present time of their episodes."""
        if start.targets is None:
            return
        half_period, rows = self.setup.task.half_period, self.outcome
        for arm in arms:
            half = math.floor(rows[at.SAMPLE_COUNT, arm] * (1.0 / self.setup.rate) / half_period + 1e-9) if half_period else 0
            self.own[arm, at.FIRST_TARGET] = start.targets[arm]
            rows[at.TARGET, arm] = start.targets[arm] * (1.0 if half % 2 == 0 else -1.0)
            self.observations[arm, -1] = rows[at.TARGET, arm] / self.target_scale

    def _start(self, arm: int, drawn: Arm, state: Floats | None) -> None:
        setup, own = self.setup, self.own[arm]
        self.rng_keys[arm] = self._key(arm, "sensors")
        plant = self.plant
        if setup.variation.ranges:
            plant.constants[:] = self.constants[arm]
        if state is not None:
            self.states[arm] = state
        else:
            if setup.variation.ranges or self.first_state is None:
                self.first_state = self._run_up(plant)
            self.states[arm] = self.first_state
        self.waiting[:, arm] = 0.0
        plant.kernel.write_noiseless(self.arena, plant.layout, self.plant_offsets, arm, arm + 1)
        angle = self.noiseless_readings[arm, TRUTH_ANGLE - TRUTH_SIZE]
        own[:] = self.outcome[:, arm] = 0.0
        own[at.LENGTH] = drawn.constants.get("beam", {}).get("length", 1.0)
        own[at.COMMAND_PER_TORQUE] = command_per_torque_of(drawn)
        own[at.FIRST_ANGLE] = angle
        own[at.FIRST_TARGET] = self.outcome[at.TARGET, arm] = self._target(arm, angle)
        self.history[arm] = self.sensor_output[arm] = self.noiseless_readings[arm, :-TRUTH_SIZE]
        self.kernel.after_reset(self.arena, self.env_offsets, self.rng_keys, self.observations, arm)

    def _target(self, arm: int, angle: float) -> float:
        """Choose an arm's target [rad], whose hub is at an angle [rad]."""
        setup = self.setup
        if setup.goals is not None:
            low, high = setup.goals
            return low + float(uniform(self._key(arm, "goal"), 0, 0)) * (high - low)
        return angle if setup.task.hold else setup.task.target

    def _run_up(self, plant: Plant) -> Floats:
        """Compute the state at the start of an episode, after the task's pulse and coast."""
        task = self.setup.task
        start = np.zeros(plant.states)
        start[: plant.bodies] = task.angle
        plant.place(start)
        pulse, coast = round(task.pulse_time * self.setup.rate), round(task.coast * self.setup.rate)
        if pulse + coast:
            plant.replay(np.concatenate([np.full(pulse, task.pulse * self.limit), np.zeros(coast + 1)]))
        return plant.state.copy()

    def step(self) -> None:
        """Move all arms on by one sample under the commands `requested`."""
        if self.delayed:
            self.applied[:] = self.waiting[0]
            self.waiting[:-1] = self.waiting[1:]
            self.waiting[-1] = self.requested
        if self.crew is None:
            self._step(0, self.count)
        else:
            self.crew.run(self._step)

    def _step(self, first: int, last: int) -> None:
        self.step_batch(self.arena, self.layout, self.plant_offsets, first, last, 0)
        self.after_step(self.arena, self.env_offsets, self.rng_keys, self.observations, first, last)

    def request(self, actions: Floats) -> int:
        """Set the commands of the next step to actions (arms,) · limit; return the first arm with an impossible action, or -1."""
        return int(self.kernel.request(actions, self.arena, self.env_offsets, self.limit))

    def info(self) -> dict[str, Floats]:
        """Copy the quantities of an info, by name (arms,): the truth, the target, the command, the reward's terms."""
        outcome = self.outcome.copy()
        return {name: outcome[row] for name, row in self.info_rows.items()}

    def arm_of(self, arm: int) -> Arm:
        """Draw the arm of the present episode again."""
        return self._arm_at(self.seeds[arm], self.episodes[arm])

    def _arm_at(self, seed: np.uint64, episode: np.int64) -> Arm:
        """Draw the arm of an episode of a seed."""
        return self.setup.variation.arm(self.setup.arm, self._draws_at(seed, episode))

    def draws_of(self, arm: int) -> list[float]:
        """Look up the unit-interval draws of an arm's present episode, one for each range: 0 is its low end, 1 its high one."""
        return self._draws_at(self.seeds[arm], self.episodes[arm])

    def _draws_at(self, seed: np.uint64, episode: np.int64) -> list[float]:
        key = _key_at(seed, episode, "arm")
        return [uniform(key, 0, i) for i in range(len(self.setup.variation.ranges))]

    def _key(self, arm: int, name: str) -> np.uint64:
        """Compute the key of an arm's draws of a name in its present episode."""
        return _key_at(self.seeds[arm], self.episodes[arm], name)


def _key_at(seed: np.uint64, episode: np.int64, name: str) -> np.uint64:
    """Compute the key of the draws of a name in an episode of a seed."""
    return np.uint64(key_of(seed, hash_of(name), int(episode)))
