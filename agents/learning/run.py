"""One training run, from a plan and a seed to an artefact; a stopped run continues from its checkpoint."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import torch
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.logger import configure

from agents.learning.artefact import Artefact, acting_weights
from agents.learning.checkpoint import read_checkpoint, restore, restore_randomness, write_checkpoint
from agents.learning.episodes import EpisodeVecEnv
from agents.learning.models import ON_POLICY, make_model
from agents.learning.options import Plan
from flexarm_env import Arm, InputError, __version__
from flexarm_env.arm_text import arm_text
from flexarm_env.terminal.provenance import commit

#: Called with the finished share and one line about it.
Report = Callable[[float, str], None]
#: Time between checkpoints [s], and points of a stored learning curve.
BETWEEN, POINTS = 10.0, 100


class Watch(BaseCallback):
    """Learning curve, checkpoints and progress, between batches of episodes."""

    def __init__(self, plan: Plan, env: EpisodeVecEnv, run: dict[str, Any], place: Path | None, report: Report) -> None:
        super().__init__()
        self.plan, self.env, self.run, self.place, self.report = plan, env, run, place, report
        self.began = self.saved = time.perf_counter()
        self.before, self.state = run["seconds"], None

    def _on_training_start(self) -> None:
        if self.state is not None:
            restore_randomness(self.state)

    def _on_step(self) -> bool:
        return True

    def _on_rollout_start(self) -> None:
        self.calm()
        self.look()

    def calm(self) -> None:
        """Set the falling spread of PPO's actions, so that training ends with the policy that is evaluated."""
        network, share = self.plan.network, min(self.num_timesteps / self.plan.actions, 1.0)
        spread = network.log_std + share * (network.last_log_std - network.log_std)
        if self.plan.algorithm in ON_POLICY and network.spread == "falling":
            self.model.policy.log_std.requires_grad_(False).fill_(spread)

    def look(self) -> None:
        """Record the last episodes' return, and write a checkpoint when it is due."""
        # an off-policy batch is a single action: look only where episodes begin
        if self.env.step_number or self.env.mean_return is None:
            return
        now, done = time.perf_counter(), self.num_timesteps
        self.run["curve"].append([done, round(self.env.mean_return, 3)])
        self.run["seconds"] = round(self.before + now - self.began, 1)
        self.env.mean_return = None
        text = f"{done / 1e6:.1f} of {self.plan.actions / 1e6:.1f} M actions, return {self.run['curve'][-1][1]:.1f}"
        self.report(min(done / self.plan.actions, 1.0), text)
        if self.place is not None and now - self.saved > BETWEEN:
            write_checkpoint(self.place, self.model, self.env, self.run)
            self.saved = now


def train(plan: Plan, seed: int, place: Path | None, report: Report, tensorboard: Path | None = None) -> Artefact:
    """Run a plan; return its artefact.

    Args:
        plan: all about the run but its seed.
        seed: of the network, the actions, the batches and the arms.
        place: of the checkpoint, from which the run goes on where there is one; None for none.
        report: called with the progress.
        tensorboard: folder for TensorBoard.

    Raises:
        InputError: for a plan with a missing arm, or a checkpoint of another plan, arm, seed or version.
    """
    torch.set_num_threads(1)
    arm = Arm.load(plan.arm)
    env = EpisodeVecEnv(plan, arm, seed)
    work = {"plan": plan.table(), "arm": arm_text(arm), "seed": seed, "version": __version__}
    run: dict[str, Any] = {**work, "seconds": 0.0, "curve": []}
    state = read_checkpoint(place) if place is not None and place.is_file() else None
    if state is not None and state["run"] != state["run"] | work:
        raise InputError(
            f"{place} is of another plan, arm, seed or version of FlexArm; delete it to start anew, or name another folder"
        )
    model = make_model(plan, env, seed)
    model.set_logger(configure(str(tensorboard) if tensorboard else None, ["tensorboard"] if tensorboard else []))
    if state is not None:
        run = state["run"]
        restore(state, model, env)
    watch = Watch(plan, env, run, place, report)
    watch.state = state
    model.learn(plan.actions - model.num_timesteps, callback=watch, reset_num_timesteps=state is None)
    watch.look()
    env.close()
    about = {"seed": seed, "version": __version__, "commit": commit(), "actions": model.num_timesteps}
    about |= {"seconds": run["seconds"], "curve": thinned(run["curve"])}
    return Artefact(plan, arm, acting_weights(model.policy), about)


def thinned(curve: list[list[float]]) -> list[list[float]]:
    """Select at most POINTS of a curve's points, evenly, the last among them."""
    places = np.unique(np.linspace(0, len(curve) - 1, min(POINTS, len(curve))).round().astype(int))
    return [curve[place] for place in places]
