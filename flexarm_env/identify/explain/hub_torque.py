"""Torque on the hub estimated from recordings, without any law of friction: a smoother on the arm's linear part."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.experiments.stated import with_stated
from flexarm_env.identify.replay.dataset import Dataset, prepare
from flexarm_env.identify.replay.observer import riccati
from flexarm_env.identify.replay.readings import errors_of
from flexarm_env.identify.replay.run import Run
from flexarm_env.identify.replay.scales import torque_scale
from flexarm_env.identify.settings import SETTINGS, Settings
from flexarm_env.linear import INPUTS, LinearArm
from flexarm_env.recordings.recording import Recording

Floats = NDArray[np.float64]

#: Fields of the structure that an effect on the hub may edit.
HUB_FIELDS = ("viscous", "hub_stiffness", "hub_torque")


@dataclass(frozen=True)
class HubMotion:
    """One recording, smoothed.

    Attributes:
        name: of the recording.
        time: (samples,) [s].
        angle: (samples,) of the hub [rad].
        speed: (samples,) of the hub [rad/s].
        torque: (samples,) on the hub from all that is neither drive nor beam: friction, cables, cogging [Nm].
    """

    name: str
    time: Floats
    angle: Floats
    speed: Floats
    torque: Floats


def hub_torque(arm: Arm, recordings: Sequence[Recording], settings: Settings = SETTINGS) -> list[HubMotion]:
    """Estimate the torque on the hub, sample by sample, with no assumption on its law but that it is a random walk.

    A Kalman smoother (Rauch, Tung, Striebel, AIAA Journal 3 (1965) 1445) in its steady state, on the arm with a free hub
    and a random torque on it. Where the hub sticks, it is the torque that holds the hub.

    Args:
        arm: for its drive, inertias, beam and sensors; effects that act on the hub are left out.
        recordings: of the machine, sampled evenly.
        settings: numbers of the method.

    Raises:
        InputError: for recordings that do not fit the arm.
    """
    return hub_torque_of(*prepare(without_hub_effects(arm), recordings, settings))


def hub_torque_of(arm: Arm, dataset: Dataset) -> list[HubMotion]:
    """Estimate the torque on the hub as `hub_torque` does, from recordings that are prepared.

    Args:
        arm: with the sensors of the dataset; effects that act on the hub are left out.
        dataset: the recordings.
    """
    free, numbers = without_hub_effects(arm), dataset.settings.explaining
    plants, step = dataset.plants(free), numbers.torque_step * torque_scale(free, dataset.runs)
    smoothers = {}
    for stated in plants:
        linear = with_stated(free, stated).linearise("moving", dataset.interval)
        smoothers[stated] = _smoother(linear, dataset.noise, step, dataset.settings)
    return [
        smoothers[run.stated].smooth(run, plants[run.stated].delayed(run.command), dataset)
        for run in dataset.runs
        if not len(run.intervals)
    ]


def without_hub_effects(arm: Arm) -> Arm:
    """Take out of an arm the effects that act on the hub."""
    return replace(arm, effects={name: values for name, values in arm.effects.items() if not acts_on_hub(arm, name)})


def acts_on_hub(arm: Arm, name: str) -> bool:
    """Whether an effect of the arm is nothing but a torque on the hub that follows from its motion and from time.

    Weight counts as such, though it bends the beam as well.
    """
    effect = arm.known[name]
    if effect.port("structure") is not None:
        changed = changes(arm, name)
        return bool(changed) and changed <= set(HUB_FIELDS)
    laws = [effect.port(port) for port in ("friction", "factor", "torque", "weight")]
    return any(laws) and not any("load" in arguments(law) for law in laws if law is not None)


def changes(arm: Arm, name: str) -> set[str]:
    """List the arm's linear quantities that an effect of it edits."""
    with_it, without = vars(arm.structure()), vars(arm.without_effect(name).structure())
    return {key for key, value in with_it.items() if value != without[key]}


def law_torque(arm: Arm, names: Sequence[str], angle: Floats, speed: Floats, time: Floats) -> Floats:
    """Compute the torque [Nm] on a moving hub from effects of an arm at angles [rad], speeds [rad/s] and times [s].

    Args:
        arm: with the effects.
        names: of effects that act on the hub.
        angle: (points,).
        speed: (points,), not zero.
        time: (points,).
    """
    total = np.zeros(len(speed))
    for name in names:
        values, effect = arm.effects[name], arm.known[name]
        if effect.port("structure") is not None:
            own, other = vars(arm.structure()), vars(arm.without_effect(name).structure())
            viscous, stiffness, constant = (own[key] - other[key] for key in HUB_FIELDS)
            total += constant - viscous * speed - stiffness * angle
        motion = {"angle": angle, "time": time, "direction": np.sign(speed), "at_rest": np.False_}
        ports = (("friction", np.abs(speed), -np.sign(speed)), ("torque", speed, 1.0), ("weight", speed, 1.0))
        for port, along, sign in ports:
            law = effect.port(port)
            if law is not None:
                given = motion | {"speed": along} | dict(values)
                total += sign * np.vectorize(law, otypes=[float])(*(given[key] for key in arguments(law)))
        factor = effect.port("factor")
        if factor is not None:
            given = motion | dict(values)
            share = np.vectorize(factor, otypes=[float])(*(given[key] for key in arguments(factor)))
            dry = [other for other in arm.effects if arm.known[other].port("friction") and acts_on_hub(arm, other)]
            total += (share - 1.0) * law_torque(arm, dry, angle, speed, time)
    return total


def arguments(law: Callable[..., float]) -> tuple[str, ...]:
    """List the names of a law's arguments."""
    return tuple(inspect.signature(law).parameters)


@dataclass(frozen=True)
class Smoother:
    """A steady-state Kalman smoother of an arm with a free hub and a random torque on it, the last state.

    Attributes:
        linear: the arm without the torque.
        transition: of one sample (n + 1, n + 1).
        output: readings of the states (signals, n + 1).
        gain: of the filter (n + 1, signals).
        back: of the backward pass (n + 1, n + 1).
    """

    linear: LinearArm
    transition: Floats
    output: Floats
    gain: Floats
    back: Floats

    def smooth(self, run: Run, command: Floats, dataset: Dataset) -> HubMotion:
        """Smooth one run, under the command that passed the drive's delay, and cut off both ends."""
        linear = self.linear
        count, width = len(run.time), len(self.transition)
        forcing = np.append(linear.response[:, INPUTS.index("command")], 0.0)
        readings = run.measured - linear.offset
        ahead, filtered = np.zeros((count + 1, width)), np.zeros((count, width))
        ahead[0, [linear.states.index(body) for body in ("hub", "motor") if body in linear.states]] = run.start.angle
        ahead[0, : run.start.moving + 1] = run.start.angle
        for k in range(count):
            filtered[k] = ahead[k] + self.gain @ errors_of(readings[k], self.output @ ahead[k])
            ahead[k + 1] = self.transition @ filtered[k] + forcing * command[k]
        for k in range(count - 2, -1, -1):
            filtered[k] += self.back @ (filtered[k + 1] - ahead[k + 1])
        end = round(dataset.settings.explaining.settling / dataset.interval)
        kept = slice(end, count - end)
        hub, rate = linear.states.index("hub"), linear.states.index("hub_rate")
        return HubMotion(run.name, run.time[kept], filtered[kept, hub], filtered[kept, rate], filtered[kept, -1])


def _smoother(linear: LinearArm, noise: Floats, step: float, settings: Settings) -> Smoother:
    """Design the smoother for a torque that changes by a standard deviation of `step` [Nm] per sample."""
    states, numbers = len(linear.states), settings.explaining
    transition = np.eye(states + 1)
    transition[:states, :states] = linear.transition
    transition[:states, states] = linear.response[:, INPUTS.index("hub_torque")]
    output = np.hstack([linear.output, np.zeros((len(linear.outputs), 1))])
    push = np.append(linear.response[:, INPUTS.index("hub_torque")], 1.0)
    least = numbers.least_noise * np.diag(np.maximum(push**2, np.max(push[:states] ** 2)))
    process = step**2 * (np.outer(push, push) + least)
    before = riccati(transition, output, process, noise, settings.observers.doublings)
    gain = np.asarray(np.linalg.solve(output @ before @ output.T + np.diag(noise**2), output @ before).T, dtype=np.float64)
    after = before - gain @ output @ before
    back = np.asarray(np.linalg.lstsq(before, transition @ after, rcond=numbers.rank)[0].T, dtype=np.float64)
    return Smoother(linear, transition, output, gain, back)
