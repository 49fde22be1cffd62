"""Train policies: python -m agents.train configs/agents/ppo_slew.toml; stopped by Ctrl-C, the same command goes on."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from agents.learning.options import Plan
from agents.learning.plan_file import option_table, read_plan
from flexarm_env.errors import InputError
from flexarm_env.terminal.outputs import make_folder
from flexarm_env.terminal.program import Program

FOLDER = Path(__file__).resolve().parent.parent / "results" / "policies" / "weights"


def place_of(folder: Path, config: Path, seed: int) -> Path:
    """Locate the policy of a configuration and seed."""
    return folder / f"{config.stem}-{seed}.safetensors"


@Program(stopped="stopped; the same command goes on from at most ten seconds before")
def main(arguments: Sequence[str]) -> int:
    """Train the missing policies, and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m agents.train", description=__doc__)
    parser.add_argument("configs", nargs="*", type=Path, metavar="CONFIG", help="TOML files, such as configs/agents/*.toml")
    parser.add_argument("--seeds", type=int, nargs="+", metavar="SEED", help="from 0 up, as many as the file says, by default")
    parser.add_argument("--save", type=Path, default=FOLDER, help="folder of the policies; results/policies/weights by default")
    parser.add_argument("--tensorboard", type=Path, metavar="FOLDER", help="what TensorBoard shows goes there")
    parser.add_argument("--options", action="store_true", help="list every option of a configuration and end")
    asked = parser.parse_args(arguments)
    if asked.options:
        print(option_table(), end="")
        return 0
    plans = [(config, read_plan(config)) for config in asked.configs]
    if not plans:
        raise InputError("no configuration; name one such as configs/agents/ppo_slew.toml, or use --options")
    if asked.seeds and min(asked.seeds) < 0:
        raise InputError(f"--seeds {min(asked.seeds)}; give whole numbers from 0 up")
    make_folder(asked.save)
    for config, plan in plans:
        for seed in asked.seeds or range(plan.seeds):
            one_run(config, plan, seed, asked.save, asked.tensorboard)
    return 0


def one_run(config: Path, plan: Plan, seed: int, folder: Path, tensorboard: Path | None) -> None:
    """Train one policy and write it, unless it exists."""
    # torch and Stable-Baselines3 take two seconds to import; a misspelt option is reported before
    from agents.learning.run import train

    place = place_of(folder, config, seed)
    if place.is_file():
        print(f"{place} is there already")
        return

    def report(share: float, text: str) -> None:
        print(f"\r{place.stem}: {share:4.0%}  {text:<70}", end="", file=sys.stderr, flush=True)

    checkpoint = place.with_suffix(".checkpoint")
    made = train(plan, seed, checkpoint, report, tensorboard / place.stem if tensorboard else None)
    made.save(place)
    checkpoint.unlink(missing_ok=True)
    print(f"\n{place}: {made.run['actions'] / 1e6:.1f} M actions in {made.run['seconds']:.0f} s")


if __name__ == "__main__":
    sys.exit(main())
