"""Train PPO of Stable-Baselines3, with its defaults, on FlexArm/Slew-v0: python -m agents.recipe --seeds 0 1 2 3 4."""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np

from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.files import write_whole
from flexarm_env.terminal.outputs import make_folder
from flexarm_env.terminal.program import Program
from flexarm_env.trials.measures import TAIL
from flexarm_env.trials.sets import FIRST_SEED, SEARCH_SEED
from flexarm_env.wrappers import Shaped

FOLDER = Path(__file__).resolve().parent.parent / "results" / "recipe"
#: Two readings, 20 ms apart, and the last command; a command is held for 20 ms.
HISTORY = {"lags": [0, 4], "command_lags": [0], "estimate": False, "repeat": 4}
#: Episodes between updates of PPO by which a curve is drawn, with seeds that neither training nor evaluation uses.
WATCHED, WATCHED_SEED = 10, SEARCH_SEED
#: Episodes after the training.
JUDGED = 100


@dataclass(frozen=True)
class Recipe:
    """Wrapper of FlexArm/Slew-v0, and length of a training.

    Attributes:
        meaning: one line for a person.
        interface: options of flexarm_env.wrappers.Shaped; None for the environment as it is.
        steps: actions in the training.
        every: actions between points of the curve.
    """

    meaning: str
    interface: Mapping[str, Any] | None
    steps: int
    every: int


RECIPES = {
    "added": Recipe("two readings, added to the thesis's PD", {**HISTORY, "base": "pd", "authority": 0.6}, 122_880, 4096),
    "alone": Recipe("two readings, without any controller", HISTORY, 368_640, 12_288),
    "bare": Recipe("one reading, commands of 5 ms: the environment as it is", None, 368_640, 24_576),
}


def make(recipe: Recipe) -> gym.Env[Any, Any]:
    """Make the environment of a recipe; its reward is that of the task, summed over the samples of an action."""
    if recipe.interface is None:
        return gym.make("FlexArm/Slew-v0")
    return Shaped(gym.make("FlexArm/Slew-v0", physical=True), recipe.interface, reward=None)


def episodes(model: Any, env: gym.Env[Any, Any], count: int, first_seed: int) -> tuple[list[float], list[float]]:
    """Let a model act deterministically; return each episode's return, and its tip's mean error over the last 0.5 s [deg]."""
    returns, errors = [], []
    for seed in range(first_seed, first_seed + count):
        observation, info = env.reset(seed=seed)
        over, gained, missed = False, 0.0, []
        while not over:
            action, _ = model.predict(observation, deterministic=True)
            observation, reward, terminated, truncated, info = env.step(action)
            over, gained = terminated or truncated, gained + reward
            missed.append(abs(info["hub_angle"] + info["tip_deflection"] - info["target"]))
        tail = round(len(missed) * TAIL / 5.0) or 1
        returns.append(round(gained, 2))
        errors.append(round(float(np.rad2deg(np.mean(missed[-tail:]))), 4) if not terminated else 180.0)
    return returns, errors


def train(name: str, seed: int) -> dict[str, Any]:
    """Train once; return the curve [[actions, mean return, mean error, largest error], …] and all final episodes."""
    import torch
    from stable_baselines3 import PPO
    from stable_baselines3.common.callbacks import BaseCallback

    torch.set_num_threads(1)
    recipe = RECIPES[name]
    watched, curve, began = make(recipe), [], time.perf_counter()

    class Watch(BaseCallback):
        def _on_step(self) -> bool:
            return True

        def _on_rollout_start(self) -> None:
            if self.num_timesteps >= len(curve) * recipe.every:
                point(self.num_timesteps)

    def point(actions: int) -> None:
        returns, errors = episodes(model, watched, WATCHED, WATCHED_SEED)
        curve.append([actions, round(float(np.mean(returns)), 2), round(float(np.mean(errors)), 4), max(errors)])
        print(f"\r{name}-{seed}: {actions / recipe.steps:4.0%}  return {curve[-1][1]:.1f}", end="", file=sys.stderr, flush=True)

    model = PPO("MlpPolicy", make(recipe), seed=seed, device="cpu")
    model.learn(recipe.steps, callback=Watch())
    point(model.num_timesteps)
    returns, errors = episodes(model, watched, JUDGED, FIRST_SEED)
    seconds = round(time.perf_counter() - began, 1)
    return {"recipe": name, "seed": seed, "actions": model.num_timesteps, "seconds": seconds, "curve": curve} | {
        "returns": returns,
        "errors": errors,
    }


@Program(stopped="stopped; the same command goes on")
def main(arguments: Sequence[str]) -> int:
    """Train what the folder lacks, report all that it holds, and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m agents.recipe", description=__doc__)
    parser.add_argument("recipes", nargs="*", default=["added"], help=f"of {', '.join(RECIPES)}; added by default")
    parser.add_argument("--seeds", type=int, nargs="+", default=[0, 1, 2, 3, 4], help="0 to 4 by default")
    parser.add_argument("--save", type=Path, default=FOLDER, help="folder of the results; results/recipe by default")
    asked = parser.parse_args(arguments)
    for name in asked.recipes:
        if name not in RECIPES:
            raise InputError(f"no recipe '{name}'{did_you_mean(name, RECIPES)}")
    if min(asked.seeds) < 0:
        raise InputError(f"--seeds {min(asked.seeds)}; give whole numbers from 0 up")
    make_folder(asked.save)
    for name in asked.recipes:
        for seed in asked.seeds:
            place = asked.save / f"{name}-{seed}.json"
            if not place.is_file():
                write_whole(place, json.dumps(train(name, seed)) + "\n")
                print(f"\n{place}")
    from agents.recipe_report import write_report

    write_report(asked.save, {name: recipe.meaning for name, recipe in RECIPES.items()})
    return 0


if __name__ == "__main__":
    sys.exit(main())
