"""A trained policy in one file: weights, interface, arm, run. Loading one runs no code of it."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from safetensors import SafetensorError, safe_open
from safetensors.torch import save
from stable_baselines3.common.policies import BasePolicy

from agents.learning.episodes import RATE
from agents.learning.models import TRAINING_ONLY, bare_policy, hidden_weights
from agents.learning.options import Plan
from agents.learning.plan_file import read_table
from flexarm_env.arm import Arm
from flexarm_env.arm_text import arm_text
from flexarm_env.errors import InputError
from flexarm_env.files import check_file, parse_toml, write_whole
from flexarm_env.wrappers import PolicyInterface

FORMAT = "flexarm-policy-1"
LARGEST_FILE = 100_000_000


@dataclass(frozen=True)
class Artefact:
    """A trained policy.

    Attributes:
        plan: by which it was trained, its task and interface in it.
        arm: modelled by its filters and its base controller.
        weights: of the acting networks, without the critic.
        run: seed, version, commit, actions, seconds, curve: [[actions, mean return of an episode], …].
        source: file that it was read from; "" for one that was just trained.
    """

    plan: Plan
    arm: Arm
    weights: Mapping[str, torch.Tensor]
    run: Mapping[str, Any]
    source: str = ""

    def save(self, path: Path) -> None:
        """Write the file, whole or not at all: weights as safetensors, the rest as text in its header."""
        text = {"format": FORMAT, "plan": json.dumps(self.plan.table()), "arm": arm_text(self.arm), "run": json.dumps(self.run)}
        tensors = {name: value.detach().contiguous().clone() for name, value in self.weights.items()}
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, save(tensors, text))

    @classmethod
    def load(cls, path: Path) -> Artefact:
        """Read a file.

        Raises:
            InputError: for a file that is not there, or is no such artefact, in one line.
        """
        check_file(path, LARGEST_FILE, "name a policy that python -m agents.train wrote")
        try:
            with safe_open(path, "pt") as file:
                text = file.metadata() or {}
                weights = {name: file.get_tensor(name) for name in file.keys()}  # noqa: SIM118
            if text.get("format") != FORMAT:
                raise InputError(f"holds no policy of format {FORMAT}; python -m agents.train makes one")
            arm, plan = Arm.from_table(parse_toml(text["arm"], "its arm"), path.stem), read_table(json.loads(text["plan"]))
            return cls(plan, arm, checked_weights(weights), checked_run(json.loads(text["run"])), str(path))
        except InputError as error:
            raise InputError(f"{path}: {error}") from None
        except OSError:
            raise InputError(f"{path}: cannot be read; check its permissions") from None
        except (SafetensorError, KeyError, ValueError, TypeError, AttributeError, RuntimeError) as error:
            raise InputError(f"{path} is no policy ({error}); python -m agents.train makes one") from None

    def agent(self, interval: float = 1.0 / RATE) -> LearnedPolicy:
        """Build the policy, ready to drive arms.

        Args:
            interval: control period [s]; its filters and base controller are made for it.

        Raises:
            InputError: where the weights do not fit the plan.
        """
        interface = PolicyInterface(self.plan.interface, self.arm, interval)
        unfit = f"{self.source}{': ' if self.source else ''}the weights do not fit the plan: "
        held, wanted = sum(value.numel() for value in self.weights.values()), hidden_weights(self.plan, interface.size)
        if held < wanted:  # a plan of a few bytes may ask for a network of gigabytes
            raise InputError(f"{unfit}its layers have {wanted} weights, and {held} are there; train again")
        policy = bare_policy(self.plan, interface.size)
        try:
            lacking, surplus = policy.load_state_dict(dict(self.weights), strict=False)
        except RuntimeError as error:
            raise InputError(f"{unfit}{str(error).splitlines()[-1].strip()}; train again") from None
        lacking = [name for name in lacking if not name.startswith(TRAINING_ONLY)]
        if lacking or surplus:
            raise InputError(f"{unfit}{', '.join([*lacking, *surplus][:3])}; train again")
        return LearnedPolicy(policy, interface)


def checked_weights(weights: Mapping[str, torch.Tensor]) -> Mapping[str, torch.Tensor]:
    """Pass on weights that are real and finite.

    Raises:
        InputError: for others, by the name of the first.
    """
    for name, value in weights.items():
        if not (value.is_floating_point() and bool(torch.isfinite(value).all())):
            raise InputError(f"weights '{name}' are not all finite real numbers; train again")
    return weights


def checked_run(run: Any) -> Mapping[str, Any]:
    """Pass on a table of a run as Artefact has it.

    Raises:
        InputError: for another value, or an entry of another kind.
    """
    if not isinstance(run, Mapping):
        raise InputError(f"run = {run!r} is no table; train again")
    for key, holds in RUN.items():
        if key not in run or not holds(run[key]):
            raise InputError(f"run.{key} is missing, or of another kind than training writes; train again")
    return run


def _is_count(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value >= 0


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= sys.float_info.max


def _is_curve(value: Any) -> bool:
    return isinstance(value, list) and all(
        isinstance(each, list) and len(each) == 2 and all(map(_is_number, each)) for each in value
    )


#: What a run holds, each with its test.
RUN: dict[str, Callable[[Any], bool]] = {
    "seed": _is_count,
    "version": lambda value: isinstance(value, str),
    "commit": lambda value: isinstance(value, str | None),
    "actions": _is_count,
    "seconds": _is_number,
    "curve": _is_curve,
}


def acting_weights(policy: BasePolicy) -> dict[str, torch.Tensor]:
    """Select the weights that acting needs."""
    return {name: value for name, value in policy.state_dict().items() if not name.startswith(TRAINING_ONLY)}


class LearnedPolicy:
    """Drives arms, one or many: an Agent of flexarm_env/trials/rollout.py.

    Args:
        policy: of Stable-Baselines3 or sb3-contrib, its critic untrained.
        interface: between it and the arms.
    """

    def __init__(self, policy: BasePolicy, interface: PolicyInterface) -> None:
        self.policy, self.interface = policy, interface
        policy.set_training_mode(False)
        self.reset()

    def reset(self, count: int | None = None) -> None:
        """Start an episode of `count` arms, or of one."""
        self.alone, width = count is None, count or 1
        self.interface.start(width)
        self.memory: Any = None
        self.starts = np.ones(width, dtype=bool)
        self.held = np.zeros((width, self.interface.options.actions), dtype=np.float32)

    def action(self, observation: NDArray[np.floating[Any]]) -> NDArray[np.float32]:
        """Compute shares of the limit (…, 1) for physical observations (…, signals + 1); … is nothing or the count."""
        self.interface.see(np.asarray(observation)[None] if self.alone else observation)
        if self.interface.sample % self.interface.options.repeat == 0:
            seen = self.interface.features()
            self.held, self.memory = self.policy.predict(seen, self.memory, self.starts, deterministic=True)
            self.starts = np.zeros_like(self.starts)
        command = self.interface.send(self.held)
        return command[0] if self.alone else command
