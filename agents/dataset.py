"""Make data sets for offline learning, in Minari's format: python -m agents.dataset."""

from __future__ import annotations

import argparse
import importlib.util
import sys
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

import flexarm_env
from agents.learning.artefact import Artefact
from agents.train import FOLDER, place_of
from flexarm_env import Arm, InputError
from flexarm_env.controllers import make_controller
from flexarm_env.errors import did_you_mean
from flexarm_env.tasks import CONTROL_RATE, TASKS
from flexarm_env.terminal.program import Program
from flexarm_env.trials.rollout import Agent

#: What Minari needs beside itself, as `pip install "minari[hdf5,create]"` brings it.
NEEDED = ("minari", "h5py", "jax")
#: Seed of the first episode: training and evaluation use others.
FIRST = 700_000_000
#: Longest time for which a random command is held [samples].
LONGEST_HOLD = 40


class Random:
    """Drives arms by random commands, each held for a random time."""

    def __init__(self) -> None:
        self.episode = 0

    def reset(self, count: int | None = None) -> None:
        """Start an episode, with the commands that belong to its number."""
        self.draw, self.left = np.random.default_rng(self.episode), 0
        self.episode += 1

    def action(self, observation: NDArray[np.floating[Any]]) -> NDArray[np.float32]:
        """Compute a share of the limit (1,)."""
        if self.left == 0:
            self.left, self.held = int(self.draw.integers(1, LONGEST_HOLD)), self.draw.uniform(-1.0, 1.0, 1)
        self.left -= 1
        return self.held.astype(np.float32)


def driver(name: str, task: str) -> Agent:
    """Make what drives the arms of a data set."""
    if name == "random":
        return Random()
    if name == "policy":
        return Artefact.load(place_of(FOLDER, Path(f"ppo_{task}.toml"), 0)).agent()
    return make_controller(name, Arm.load("thesis"), 1.0 / CONTROL_RATE)


#: Task and driver of each data set, by its name.
DATASETS = {f"flexarm/{task}/{who}-v0": (task, who) for task in TASKS for who in ("pd", "lqg", "policy", "random")}


def collect(name: str, episodes: int, collector: Callable[..., Any]) -> Any:
    """Drive an arm through episodes, and return the collector that has seen them.

    Args:
        name: of the data set.
        episodes: with an unknown payload in each.
        collector: minari.DataCollector, or one like it.
    """
    task, who = DATASETS[name]
    env = collector(gym.make(f"FlexArm/{TASKS[task].title}-Random-v0", physical=True), record_infos=True)
    agent = driver(who, task)
    for seed in range(FIRST, FIRST + episodes):
        observation, _ = env.reset(seed=seed)
        agent.reset()
        over = False
        while not over:
            observation, _, terminated, truncated, _ = env.step(agent.action(observation))
            over = terminated or truncated
    return env


def make(name: str, episodes: int) -> str:
    """Make and store a data set; return what was stored, in words."""
    import minari

    env = collect(name, episodes, minari.DataCollector)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it asks for an author, a page and the like
        task, who = DATASETS[name]
        words = f"{TASKS[task].summary} Driven by {who}, with an unknown payload in each episode; SI units."
        stored = env.create_dataset(
            name, algorithm_name=who, description=words, requirements=[f"flexarm-env=={flexarm_env.__version__}"]
        )
    env.close()
    return f"{stored.total_episodes} episodes, {stored.total_steps} steps"


def missing() -> list[str]:
    """List the packages that are needed and not installed."""
    return [package for package in NEEDED if importlib.util.find_spec(package) is None]


@Program(stopped="stopped; the same command goes on")
def main(arguments: Sequence[str]) -> int:
    """Make data sets, skip those that exist, and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m agents.dataset", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="data sets, as --list shows them; all by default")
    parser.add_argument("--episodes", type=int, default=20, help="in each; 20 by default")
    parser.add_argument("--list", action="store_true", help="list the data sets and end")
    asked = parser.parse_args(arguments)
    if asked.list:
        print("\n".join(DATASETS))
        return 0
    for name in asked.names:
        if name not in DATASETS:
            raise InputError(f"no data set '{name}'{did_you_mean(name, DATASETS)}")
    if asked.episodes < 1:
        raise InputError(f"--episodes {asked.episodes}; give a whole number from 1 up")
    names = asked.names or list(DATASETS)
    if lacking := missing():
        skipped = f"{len(names)} data set{'s' if len(names) > 1 else ''}"
        print(f"skipped {skipped}: {', '.join(lacking)} not installed; pip install 'minari[hdf5,create]'", file=sys.stderr)
        return 0
    import minari

    known = set(minari.list_local_datasets())
    for name in names:
        print(f"{name}: " + ("is there already" if name in known else make(name, asked.episodes)), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
