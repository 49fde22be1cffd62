"""Options of a training run: each with its default, its meaning and its bounds."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field
from typing import Any

from flexarm_env.controllers import CONTROLLERS
from flexarm_env.tasks import TASKS

ALGORITHMS = ("ppo", "recurrent_ppo", "sac", "tqc")


def option(default: Any, meaning: str, least: float = -math.inf, most: float = math.inf, allowed: Any = None) -> Any:
    """Make a field of a section: its default, its meaning for a person, and its bounds."""
    return field(default=default, metadata={"meaning": meaning, "least": least, "most": most, "allowed": allowed})


@dataclass(frozen=True)
class ArmsOptions:
    """The arms of training, drawn anew for each episode; the nominal arm alone where all are 0."""

    payload: bool = option(True, "whether a tip mass of 0 to 0.3 kg is drawn")
    constants: float = option(0.1, "share by which torque constant, inertia, mass and stiffness differ", 0.0, 0.9)
    friction: float = option(0.2, "share by which friction differs", 0.0, 0.9)
    tap_rate: float = option(0.2, "taps on the hub per second, up to 0.5 Nm for 20 ms", 0.0, 50.0)
    dropout_rate: float = option(0.5, "drop-outs of a sensor per second, 50 ms each", 0.0, 50.0)


@dataclass(frozen=True)
class InterfaceOptions:
    """Features of the policy and effect of its action."""

    lags: tuple[int, ...] = option((0, 2, 4, 8, 16, 32), "how many samples of 5 ms ago the shown readings are", 0, 2000)
    command_lags: tuple[int, ...] = option((0, 2, 4, 8), "how many samples of 5 ms ago the shown commands were sent", 0, 2000)
    averages: tuple[float, ...] = option((), "also readings averaged with these fading memories [s]", 0.005, 10.0)
    estimate: bool = option(True, "also show a Kalman filter's angle, bending, speeds and friction, and the payload estimate")
    base: str = option("none", "classical controller to whose command the action is added", allowed=("none", *CONTROLLERS))
    authority: float = option(1.0, "command at action 1, as a share of the drive's limit", 0.001, 2.0)
    repeat: int = option(2, "samples of 5 ms for which an action is held", 1, 100)
    pulse: float = option(
        0.0, "as authority, of a second action that is sent in the first of these samples only; 0: none", 0.0, 2.0
    )
    privileged: bool = option(True, "PPO's critic alone also sees the true state and the drawn constants, in training only")

    @property
    def actions(self) -> int:
        """Count the numbers of an action."""
        return 2 if self.pulse else 1


@dataclass(frozen=True)
class RewardOptions:
    """Reward of training; evaluation has measures of its own.

    Each sample costs the tip's error and the vibration, both on a scale where halving them is worth the same whether they
    are large or small: log(1 + size / scale), over that of 100° or 3 V. The vibration's size is that of the strain now and an
    eighth of a second before, in quadrature: its amplitude at 2 Hz, and no more than that for the faster vibrations.
    """

    tip_scale: float = option(0.2, "error of the tip [deg] below which less is hardly worth anything", 1e-4, 100.0)
    strain_scale: float = option(0.01, "vibration at the base gage [V] below which less is hardly worth anything", 1e-5, 10.0)
    vibration: float = option(0.5, "weight of the vibration; the tip's error has 1", 0.0, 100.0)
    rise: float = option(1.0, "factor by which that weight has grown at the end; linear between", 0.0, 100.0)
    near: float = option(0.0, "vibration costs only near the target: error [deg] at which it counts 1/e; 0: everywhere", 0.0, 1e3)
    distance: float = option(0.0, "weight of the tip's error in rad, on a linear scale", 0.0, 100.0)
    effort: float = option(0.02, "weight of (command / limit)²", 0.0, 100.0)
    change: float = option(0.0, "weight of (change of the command / limit)²", 0.0, 100.0)


@dataclass(frozen=True)
class NetworkOptions:
    """The policy's network; the critic's has the same layers."""

    layers: tuple[int, ...] = option((64, 64), "units in each layer", 1, 4096)
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
