"""Two controllers or policies side by side on one task, as a GIF: python -m agents.film writes results/baselines/pd-dual.gif."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import gymnasium as gym
import numpy as np
from PIL import Image

from agents.evaluate import FOLDER
from flexarm_env import Arm
from flexarm_env.controllers import CONTROLLERS, make_controller
from flexarm_env.env import FlexArmEnv
from flexarm_env.errors import InputError
from flexarm_env.terminal.outputs import make_folder
from flexarm_env.terminal.program import Program
from flexarm_env.trials.rollout import Agent
from flexarm_env.trials.sets import FIRST_SEED

#: Pictures per second, and the width of one of the two pictures.
RATE, WIDTH = 20, 400
COLOURS = 48


def pictures(name: str, env_id: str, arm: str) -> list[Image.Image]:
    """Draw one episode of a controller, or of the policy in a file, with a picture every 1 / RATE seconds."""
    env = gym.make(env_id, arm=arm, physical=True, render_mode="rgb_array")
    bare = env.unwrapped
    assert isinstance(bare, FlexArmEnv)
    interval = 1.0 / bare.setup.rate
    agent = driver(name, arm, interval)
    agent.reset()
    bare.title = f"{bare.setup.task.name}: {Path(name).stem.replace('_', ' ')}"
    observation, _ = env.reset(seed=FIRST_SEED)
    every = round(1.0 / (RATE * interval))
    found, over, sample = [], False, 0
    while not over:
        if sample % every == 0:
            frame = Image.fromarray(np.asarray(env.render()))
            found.append(frame.resize((WIDTH, WIDTH), Image.Resampling.LANCZOS))
        observation, _, terminated, truncated, _ = env.step(agent.action(observation))
        over, sample = terminated or truncated, sample + 1
    env.close()
    return found


def driver(name: str, arm: str, interval: float) -> Agent:
    """Load a controller by its name, or a policy from its file."""
    if name in CONTROLLERS:
        return make_controller(name, Arm.load(arm), interval)
    # policies need torch, controllers do not
    from agents.learning.artefact import Artefact

    return Artefact.load(Path(name)).agent()


def film(names: tuple[str, str], env_id: str, arm: str, path: Path) -> None:
    """Write a GIF of two controllers side by side."""
    both = []
    for left, right in zip(*(pictures(name, env_id, arm) for name in names), strict=False):
        frame = Image.new("RGB", (2 * WIDTH, WIDTH))
        frame.paste(left, (0, 0))
        frame.paste(right, (WIDTH, 0))
        both.append(frame)
    # One palette for all, from a picture with a stuck hub, which has every colour; by coverage, so that small marks keep theirs.
    palette = both[-1].quantize(COLOURS, method=Image.Quantize.MAXCOVERAGE)
    both = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in both]
    both[0].save(path, save_all=True, append_images=both[1:], duration=1000 // RATE, loop=0, optimize=True)


@Program()
def main(arguments: Sequence[str]) -> int:
    """Make the film of README.md, or another, and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m agents.film", description=__doc__)
    parser.add_argument("--controllers", nargs=2, default=["pd", "vibration_dual"], metavar="NAME", help="or files of policies")
    parser.add_argument("--env", default="FlexArm/Slew-v0", help="id of the environment")
    parser.add_argument("--arm", default="thesis", help="name or file of the arm; another than a policy's own is allowed")
    parser.add_argument("--save", type=Path, default=FOLDER / "pd-dual.gif")
    asked = parser.parse_args(arguments)
    if asked.save.suffix != ".gif":
        raise InputError(f"--save {asked.save}; name a .gif")
    make_folder(asked.save.parent, asked.save.name)
    film(tuple(asked.controllers), asked.env, asked.arm, asked.save)
    return 0


if __name__ == "__main__":
    sys.exit(main())
