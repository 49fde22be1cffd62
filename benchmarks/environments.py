"""Steps per second of the environments, beside Gymnasium's Pendulum, EnvPool's, MuJoCo's arm and the rate of PPO."""

from __future__ import annotations

import hashlib
import os
import threading
import time
from collections.abc import Callable
from importlib.metadata import version
from importlib.util import find_spec
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from benchmarks import mujoco_arm
from flexarm_env import Arm

Floats = NDArray[np.float32]
Say = Callable[[str], None]

ID = "FlexArm/Slew-v0"
ARMS = 1024
RATE = 200.0
EPISODE = 1000
ROUNDS = 7
#: Smooth actions: a slow sine of less than a third of the limit, as of a controller that slews and stops.
AMPLITUDE, FREQUENCY = 0.3, 0.5
MUJOCO_STEPS, MUJOCO_ROUNDS = 20, 3
PPO_STEPS, PPO_UPDATES, PPO_BATCH, PPO_EPOCHS = 64, 3, 4096, 10


def smooth(steps: int, arms: int) -> Floats:
    """Build actions (steps, arms, 1): a sine with its own phase for each arm."""
    phases = np.random.default_rng(1).uniform(0.0, 2.0 * np.pi, arms)
    angle = 2.0 * np.pi * FREQUENCY / RATE * np.arange(steps)[:, None] + phases
    return (AMPLITUDE * np.sin(angle)).astype(np.float32)[:, :, None]


def white(steps: int, arms: int) -> Floats:
    """Draw actions (steps, arms, 1), each uniform over the whole range: the worst case, beyond any policy."""
    return np.random.default_rng(2).uniform(-1.0, 1.0, (steps, arms, 1)).astype(np.float32)


def in_turns(works: dict[str, Callable[[], object]], rounds: int) -> dict[str, list[float]]:
    """Time pieces of work [s] in turns, under the same load of the machine; the first turn does not count."""
    times: dict[str, list[float]] = {name: [] for name in works}
    for turn in range(rounds + 1):
        for name, work in works.items():
            start = time.perf_counter()
            work()
            if turn:
                times[name].append(time.perf_counter() - start)
    return times


def ratio(slow: list[float], fast: list[float]) -> tuple[float, float]:
    """Compute the speed-up by the best of each, and by the median of the pairs."""
    return min(slow) / min(fast), float(np.median(np.array(slow) / np.array(fast)))


def one_episode_after_another(id: str, scale: float) -> Callable[[], None]:
    """Prepare steps of a single environment, with a reset at the end of each episode."""
    env = gym.make(id)
    env.reset(seed=0)
    actions = list(scale * smooth(2 * EPISODE, 1)[:, 0])

    def work() -> None:
        for action in actions:
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                env.reset()

    return work


def all_steps(envs: Any, actions: Floats) -> Callable[[], None]:
    """Prepare steps of a batch with automatic resets."""
    envs.reset()

    def work() -> None:
        for action in actions:
            envs.step(action)

    return work


def batch(actions: Floats, threads: int = 1) -> Callable[[], None]:
    """Prepare steps of FlexArm's batch, with sensor noise and infos."""
    return all_steps(gym.make_vec(ID, ARMS, vectorization_mode="vector_entry_point", threads=threads), actions)


def measure(say: Say) -> dict[str, Any]:
    """Measure all figures, by name."""
    found: dict[str, Any] = {"environments_load_before": os.getloadavg()[0]}
    for part in (_single, _batch, _mujoco, _threads, _ppo):
        found |= part(say)
    return found | {"environments_load_after": os.getloadavg()[0]}


def _single(say: Say) -> dict[str, Any]:
    say(f"environments: {ID} and Pendulum-v1 in turns")
    works = {"ours": one_episode_after_another(ID, 1.0), "pendulum": one_episode_after_another("Pendulum-v1", 2.0)}
    times = in_turns(works, ROUNDS)
    best, median = ratio(times["pendulum"], times["ours"])
    rates = {f"single_{name}_per_s": 2 * EPISODE / min(each) for name, each in times.items()}
    return rates | {"single_over_pendulum": best, "single_over_pendulum_median": median}


def _batch(say: Say) -> dict[str, Any]:
    say(f"environments: {ARMS} arms on one thread, and EnvPool's pendulums")
    gentle, rough = smooth(EPISODE, ARMS), white(EPISODE, ARMS)
    works: dict[str, Callable[[], object]] = {"smooth": batch(gentle), "white": batch(rough)}
    known = find_spec("envpool") is not None
    if known:
        import envpool

        pendulums = envpool.make("Pendulum-v1", env_type="gymnasium", num_envs=ARMS, num_threads=1)
        works["envpool"] = all_steps(pendulums, 2.0 * gentle)
    times = in_turns(works, ROUNDS)
    found: dict[str, Any] = {f"batch_{name}_per_s": ARMS * EPISODE / min(each) for name, each in times.items()}
    found.setdefault("batch_envpool_per_s", None)
    for name in ("smooth", "white"):
        both = ratio(times["envpool"], times[name]) if known else (None, None)
        found[f"{name}_over_envpool"], found[f"{name}_over_envpool_median"] = both
    return found | {"envpool": version("envpool") if known else None}


def _mujoco(say: Say) -> dict[str, Any]:
    names = ("mujoco_us", "mujoco_over_batch", "mujoco_over_batch_median", "mujoco_creep", "mujoco_creep_default")
    if not mujoco_arm.installed():
        return dict.fromkeys([*names, "mujoco_friction"])
    say(f"environments: {ARMS} arms in MuJoCo, at {1e3 * mujoco_arm.STEP:g} ms")
    arm = Arm.load("thesis")
    arms = mujoco_arm.Rollouts(arm, ARMS)
    parts = round(1.0 / RATE / mujoco_arm.STEP)
    actions = smooth(MUJOCO_STEPS, ARMS)
    commands = np.repeat(arm.constants["drive"]["limit"] * actions[:, :, 0].T.astype(float), parts, axis=1)
    times = in_turns({"ours": batch(actions), "mujoco": lambda: arms.roll(commands)}, MUJOCO_ROUNDS)
    best, median = ratio(times["mujoco"], times["ours"])
    creeps = [mujoco_arm.Rollouts(arm, 1, friction).creep() for friction in (mujoco_arm.STIFF, {})]
    values = (1e6 * min(times["mujoco"]) / (ARMS * MUJOCO_STEPS), best, median, *creeps)
    return dict(zip(names, values, strict=True)) | {"mujoco_friction": mujoco_arm.STIFF}


def hashes(threads: int) -> Callable[[], None]:
    """Prepare purely parallel work, which measures the share of the cores that is free."""
    block = bytes(40_000_000)

    def work() -> None:
        helpers = [threading.Thread(target=lambda: hashlib.sha256(block)) for _ in range(threads)]
        for helper in helpers:
            helper.start()
        for helper in helpers:
            helper.join()

    return work


def _threads(say: Say) -> dict[str, Any]:
    say(f"environments: {ARMS} arms on one thread and on two")
    load = os.getloadavg()[0]
    gentle, rough = smooth(EPISODE // 4, ARMS), white(EPISODE // 4, ARMS)
    works = {(name, n): batch(actions, n) for name, actions in (("smooth", gentle), ("white", rough)) for n in (1, 2)}
    works |= {("hashes", n): hashes(n) for n in (1, 2)}
    times = in_turns({f"{name}{n}": work for (name, n), work in works.items()}, 2 * ROUNDS)
    found: dict[str, Any] = {"threads_load": load}
    for name in ("smooth", "white"):
        found[f"threads_{name}"], found[f"threads_{name}_median"] = ratio(times[f"{name}1"], times[f"{name}2"])
    best, median = ratio(times["hashes1"], times["hashes2"])
    return found | {"threads_possible": 2.0 * best, "threads_possible_median": 2.0 * median}


def _ppo(say: Say) -> dict[str, Any]:
    if find_spec("stable_baselines3") is None:
        return {"ppo_env_percent": None, "ppo_samples_per_s": None}
    say(f"environments: {PPO_UPDATES} updates of PPO on {ARMS} arms")
    import torch
    from stable_baselines3 import PPO

    from flexarm_env.sb3 import make_vec

    torch.set_num_threads(1)
    vec, spent = make_vec(ID, ARMS, seed=0), 0.0
    step = vec.step

    def timed(actions: Any) -> Any:
        nonlocal spent
        start = time.perf_counter()
        result = step(actions)
        spent += time.perf_counter() - start
        return result

    vec.step = timed  # type: ignore[method-assign]
    learner = PPO("MlpPolicy", vec, n_steps=PPO_STEPS, batch_size=PPO_BATCH, n_epochs=PPO_EPOCHS, device="cpu", seed=0)
    samples = ARMS * PPO_STEPS * PPO_UPDATES
    start = time.perf_counter()
    learner.learn(samples)
    whole = time.perf_counter() - start
    return {"ppo_env_percent": 100.0 * spent / whole, "ppo_samples_per_s": samples / whole}
