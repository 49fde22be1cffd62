"""Options of a training run: each with its default, its meaning and its bounds."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

from flexarm_env.tasks import TASKS
from flexarm_env.wrappers.options import ArmsOptions, InterfaceOptions, RewardOptions, option

ALGORITHMS = ("ppo", "recurrent_ppo", "sac", "tqc")
#: Layers of a network: policies for control have two to four, and each of the widest takes 64 MB.
MOST_LAYERS = 16


@dataclass(frozen=True)
class NetworkOptions:
    """The policy's network; the critic's has the same layers."""

    layers: tuple[int, ...] = option((64, 64), "units in each layer", 1, 4096, longest=MOST_LAYERS)
    activation: str = option("tanh", "between layers", allowed=("tanh", "relu", "elu"))
    log_std: float = option(-1.5, "PPO: logarithm of the actions' standard deviation at the start", -20.0, 5.0)
    spread: str = option(
        "learned",
        "PPO: how that deviation goes on: learned, one for all states; own, learned for each state; falling, to last_log_std",
        allowed=("learned", "own", "falling"),
    )
    last_log_std: float = option(-4.0, "PPO: its logarithm at the end where it is falling, evenly", -20.0, 5.0)
    memory: int = option(64, "units of the recurrent layer of recurrent_ppo", 1, 4096)


@dataclass(frozen=True)
class LearningOptions:
    """Settings of the algorithm. Each algorithm ignores those of the others."""

    learning_rate: float = option(1e-3, "at the start", 1e-8, 1.0)
    last_learning_rate: float = option(2e-5, "at the end; linear between", 0.0, 1.0)
    gamma: float = option(0.99, "discount per action", 0.0, 1.0)
    batch_size: int = option(8000, "actions in a gradient step", 1, 10_000_000)
    epochs: int = option(5, "PPO: passes over what a batch of episodes has shown", 1, 1000)
    gae_lambda: float = option(0.95, "PPO: between one step's advantage (0) and the whole episode's (1)", 0.0, 1.0)
    clip: float = option(0.2, "PPO: largest change of an action's probability in an update", 1e-3, 10.0)
    entropy: float = option(0.0, "PPO: weight of the actions' entropy", 0.0, 10.0)
    buffer: int = option(300_000, "SAC, TQC: actions remembered", 100, 100_000_000)
    warm_up: int = option(5_000, "SAC, TQC: random actions before learning starts", 0, 100_000_000)
    gradient_steps: int = option(8, "SAC, TQC: gradient steps after one action of every arm", 1, 100_000)
    tau: float = option(0.005, "SAC, TQC: share of the critic that its slow copy takes over in a step", 1e-6, 1.0)


@dataclass(frozen=True)
class Plan:
    """A whole training run."""

    algorithm: str = option("ppo", "which of Stable-Baselines3 and sb3-contrib", allowed=ALGORITHMS)
    task: str = option("slew", "what the arms do", allowed=tuple(TASKS))
    arm: str = option("thesis", "name or file of the arm that training moves and the policy believes in")
    actions: int = option(16_000_000, "actions in the whole run; PPO rounds up to whole batches of episodes", 1, 10**12)
    at_once: int = option(256, "arms moved together, whose episodes start and end together", 1, 1_000_000)
    seeds: int = option(3, "runs, with seeds from 0 up", 1, 1000)
    arms: ArmsOptions = field(default_factory=ArmsOptions)
    interface: InterfaceOptions = field(default_factory=InterfaceOptions)
    reward: RewardOptions = field(default_factory=RewardOptions)
    network: NetworkOptions = field(default_factory=NetworkOptions)
    learning: LearningOptions = field(default_factory=LearningOptions)

    def table(self) -> dict[str, Any]:
        """Convert the plan to tables for plan_file.read_table."""
        return asdict(self)
