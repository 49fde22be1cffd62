"""Report on the runs of agents/recipe.py: what a single reading lacks, returns of reference, curves."""

from __future__ import annotations

import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from agents.learning.artefact import Artefact
from agents.train import FOLDER as WEIGHTS
from flexarm_env import Arm
from flexarm_env.controllers import make_controller
from flexarm_env.errors import InputError
from flexarm_env.files import read_json, write_whole
from flexarm_env.tasks import CONTROL_RATE
from flexarm_env.trials.rollout import Agent
from flexarm_env.trials.sets import FIRST_SEED
from flexarm_env.vector_env import FlexArmVectorEnv

Floats = NDArray[np.float64]

#: Error of the tip within which an episode has ended well [deg].
NEAR = 1.0
#: Time that is predicted, and time between the readings that predict [s].
AHEAD, APART = 0.05, 0.02
#: What a run holds.
RECORDED = {"recipe", "curve", "returns", "errors"}
COLOURS = {"added": "#12395b", "alone": "#2e7d4f", "bare": "#b3541e"}


def foresight(readings: int, arms: int = 40) -> float:
    """Compute R² of the tip's speed 50 ms ahead, from the last readings of all sensors, 20 ms apart.

    Arms swing freely at the task damp. A linear predictor is fitted to half of them and judged by the others.
    """
    envs = FlexArmVectorEnv(arms, "damp", physical=True)
    seen, _ = envs.reset(seed=FIRST_SEED)
    shown, tips = [], []
    for _ in range(600):
        shown.append(seen[:, :-1].astype(np.float64))
        tips.append(envs.batch.info()["tip_deflection"])
        envs.move(np.zeros((arms, 1), dtype=np.float32))
        seen = envs.batch.observations
    past, speeds = np.array(shown), np.gradient(np.array(tips), 1.0 / CONTROL_RATE, axis=0)
    ahead, apart = round(AHEAD * CONTROL_RATE), round(APART * CONTROL_RATE)
    times = np.arange(apart * readings, len(past) - ahead - 1)
    inputs = np.concatenate([past[times - apart * i] for i in range(readings)], axis=-1)
    inputs = np.concatenate([inputs, np.ones((*inputs.shape[:2], 1))], axis=-1)
    wanted, half = speeds[times + ahead], arms // 2
    weights, *_ = np.linalg.lstsq(inputs[:, :half].reshape(-1, inputs.shape[-1]), wanted[:, :half].ravel(), rcond=None)
    left = wanted[:, half:] - inputs[:, half:] @ weights
    return 1.0 - float(np.sum(left**2) / np.sum((wanted[:, half:] - wanted[:, half:].mean()) ** 2))


class Idle:
    """An agent without a command."""

    def reset(self, count: int | None = None) -> None:
        """Start an episode of `count` arms."""
        self.count = count or 1

    def action(self, observation: NDArray[np.floating[Any]]) -> NDArray[np.float32]:
        """Return zeros (arms, 1)."""
        return np.zeros((self.count, 1), dtype=np.float32)


def mean_return(agent: Agent, arms: int) -> float:
    """Compute the mean return of an agent on FlexArm/Slew-v0, by the reward of the task."""
    envs = FlexArmVectorEnv(arms, "slew", physical=True)
    seen, _ = envs.reset(seed=FIRST_SEED)
    agent.reset(arms)
    returns, going = np.zeros(arms), np.ones(arms, dtype=bool)
    for _ in range(envs.max_episode_steps):
        rewards, terminated, _ = envs.move(agent.action(seen))
        seen = envs.batch.observations
        returns += rewards * going
        going &= ~terminated
    return float(returns.mean())


def references(arms: int = 100) -> dict[str, float]:
    """Compute returns of reference by name: no command, controllers, the policy of the first seed of three configurations."""
    arm, interval = Arm.load("thesis"), 1.0 / CONTROL_RATE
    agents: dict[str, Agent] = {"no command": Idle()}
    agents |= {name: make_controller(name, arm, interval) for name in ("pd", "lqg", "pid_compensated")}
    for name in ("ppo_slew_robust", "ppo_slew", "ppo_slew_pure"):
        agents[name] = Artefact.load(WEIGHTS / f"{name}-0.safetensors").agent()
    return {name: round(mean_return(agent, arms), 1) for name, agent in agents.items()}


def runs_of(folder: Path) -> dict[str, list[dict[str, Any]]]:
    """Read the stored runs of each recipe, by its name."""
    found: dict[str, list[dict[str, Any]]] = {}
    for path in sorted(folder.glob("*-*.json")):
        run = read_json(path, "delete it, and it is made anew")
        if not run.keys() >= RECORDED:
            raise InputError(f"{path}: is no run of a recipe; move it out of {folder}")
        found.setdefault(run["recipe"], []).append(run)
    return found


def write_report(folder: Path, meanings: Mapping[str, str]) -> None:
    """Write reference.json, recipe.md and curves.png of a folder's runs."""
    runs = runs_of(folder)
    known = {"returns": references(), "r2": {str(count): round(foresight(count), 3) for count in (1, 2)}}
    write_whole(folder / "reference.json", (json.dumps(known, indent=1) + "\n").encode())
    write_whole(folder / "recipe.md", report_of(runs, known, meanings).encode())
    draw_curves(runs, meanings, folder / "curves.png")


def report_of(runs: Mapping[str, Sequence[Mapping[str, Any]]], known: Mapping[str, Any], meanings: Mapping[str, str]) -> str:
    """Write the report in Markdown."""
    one, two = known["r2"]["1"], known["r2"]["2"]
    lines = [
        "# PPO with the defaults of Stable-Baselines3 on FlexArm/Slew-v0",
        "",
        "Each run is judged by 100 deterministic episodes that training does not see: it ends well where the tip's mean error",
        "over the last 0.5 s is below 1° in all of them. A step is an action, of 20 ms with the wrapper and of 5 ms without.",
        "",
        *runs_table(runs, meanings),
        "",
        "![Learning curves](curves.png)",
        "",
        *reference_table(known),
        "",
        f"R² of the tip's speed 50 ms ahead, of a freely swinging arm: {one:.2f} from one reading of all sensors, {two:.2f}",
        "from two that are 20 ms apart.",
    ]
    return "\n".join([*lines, ""])


def runs_table(runs: Mapping[str, Sequence[Mapping[str, Any]]], meanings: Mapping[str, str]) -> list[str]:
    """Tabulate the runs of each recipe, in Markdown."""
    lines = [
        "| observation and action | steps | runs that end well | largest error of each run [deg] | mean return of each run |",
        "|---|---:|---:|---|---|",
    ]
    for name, meaning in meanings.items():
        done = runs.get(name, [])
        if done:
            errors, returns = ([run[key] for run in done] for key in ("errors", "returns"))
            good = sum(max(each) < NEAR for each in errors)
            worst = ", ".join(f"{max(each):.2f}" if max(each) < 180.0 else "out of range" for each in errors)
            gained = ", ".join(f"{np.mean(each):.0f}" for each in returns)
            lines.append(f"| {meaning} | {done[0]['actions']} | {good} of {len(done)} | {worst} | {gained} |")
    return lines


def reference_table(known: Mapping[str, Any]) -> list[str]:
    """Tabulate the returns of reference, in Markdown."""
    rows = [f"| {name} | {value:.0f} |" for name, value in known["returns"].items()]
    return ["| agent | mean return of 100 episodes |", "|---|---:|", *rows]


def draw_curves(runs: Mapping[str, Sequence[Mapping[str, Any]]], meanings: Mapping[str, str], path: Path) -> None:
    """Draw the tip's error and the return of deterministic episodes against the steps, one line for each run."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 3.8), layout="constrained")
    panels = figure.subplots(1, 2)
    for name, meaning in meanings.items():
        for i, run in enumerate(runs.get(name, ())):
            actions, returns, errors, _ = np.array(run["curve"]).T
            style = {"color": COLOURS[name], "linewidth": 1.0, "label": meaning if i == 0 else None}
            panels[0].semilogy(actions / 1e3, np.maximum(errors, 0.02), **style)
            panels[1].plot(actions / 1e3, np.maximum(returns, -400.0), **style)
    panels[0].axhline(NEAR, color="#888888", linewidth=0.8, linestyle="--")
    panels[0].set_ylabel("error of the tip at the end [deg]")
    panels[1].set_ylabel("return, from −400 up")
    for panel in panels:
        panel.set_xlabel("steps [10³]")
        panel.grid(alpha=0.3)
    # both panels have the same lines: one's labels are enough
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=len(meanings), fontsize=8)
    picture = io.BytesIO()
    figure.savefig(picture, dpi=110, metadata={"Software": None})
    write_whole(path, picture.getvalue())
