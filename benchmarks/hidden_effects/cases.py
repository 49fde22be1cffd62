"""The list of cases, determined by its seed."""

from __future__ import annotations

import json
import zlib
from dataclasses import asdict, dataclass
from functools import lru_cache
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.hidden_effects.effects import CATALOGUE, CONSTANTS, OUTSIDE, Hidden
from benchmarks.hidden_effects.machine import Plan, largest_command, record
from flexarm_env import Arm, Recording

SIZES = Path(__file__).parent / "sizes.json"
ARM = "thesis-fem"
STRENGTHS = (1.0, 3.0, 10.0)
#: Largest relative error of the model's constants, each drawn uniformly.
WRONG = (0.0, 0.1, 0.3)
NULLS, PAIRS = 60, 40
#: Scatter (a logarithm) of sizes around that of their strength.
SCATTER = 0.2
EXPERIMENTS: tuple[tuple[Plan, ...], ...] = (
    (("pulse", 1.0, 0.0), ("square", 1.0, 0.0), ("sweep", 1.0, 0.0)),
    (("pulse", 1.0, 0.0), ("square", 0.6, 0.0), ("sweep", 1.5, 0.0)),
    (("pulse", 1.0, 0.0), ("square", 1.0, 0.15), ("sweep", 1.0, 0.0)),
)


@dataclass(frozen=True)
class Case:
    """One machine to be diagnosed.

    Attributes:
        name: unique.
        kind: "one", "two", "outside" or "null".
        effects: hidden ones, by name in the catalogue (or OUTSIDE).
        strength: excess error after a refit of the constants, over the noise; 0 for a null.
        settings: of the rig.
        runs: experiment, factor on the controller's gains, known payload [kg] of each.
        seed: of its noise and of random details of its experiments.
    """

    name: str
    kind: str
    effects: tuple[str, ...]
    strength: float
    settings: dict[str, float]
    runs: tuple[Plan, ...]
    seed: int

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data."""
        return asdict(self)

    def pose(self) -> tuple[dict[str, Any], Arm, list[Recording]]:
        """Make the case: its plain data, the arm as given and the recordings."""
        return self.as_json(), Arm.load(ARM), self.recordings()

    def recordings(self) -> list[Recording]:
        """Simulate the recordings of the machine."""
        return record(self.settings, self.runs, self.seed)


@lru_cache
def sizes() -> dict[str, dict[str, float]]:
    """Read the size of each effect at each strength, found by `python -m benchmarks.hidden_effects --calibrate`."""
    found: dict[str, dict[str, float]] = json.loads(SIZES.read_text())
    return found


def stream(seed: int, name: str) -> np.random.Generator:
    """Seed the random numbers of a case, independent of the other cases."""
    return np.random.default_rng([seed, zlib.crc32(name.encode())])


def settings_of(hidden: Hidden, size: float, draw: np.random.Generator) -> dict[str, float]:
    """Build the rig's settings for an effect of a size."""
    sign = draw.choice([-1.0, 1.0]) if hidden.signed else 1.0
    scatter = float(np.exp(draw.uniform(-SCATTER, SCATTER)))
    size = 1.0 - (1.0 - size) * scatter if hidden.of_peak else size * scatter
    others = {key: float(draw.uniform(*limits)) for key, limits in sorted(hidden.others.items())}
    return {hidden.setting: float(sign * size), **others}


def _case(seed: int, name: str, kind: str, effects: tuple[str, ...], strength: float) -> Case:
    draw = stream(seed, name)
    known = CATALOGUE | OUTSIDE
    settings: dict[str, float] = {}
    for effect in effects:
        settings |= settings_of(known[effect], sizes()[effect][f"{strength:g}"], draw)
    wrong = WRONG[draw.integers(len(WRONG))]
    for names in CONSTANTS if wrong else ():
        factor = float(1.0 + draw.uniform(-wrong, wrong))
        settings |= {f"{name}_x": factor for name in names}
    runs = EXPERIMENTS[draw.integers(len(EXPERIMENTS))]
    own_seed = int(draw.integers(2**31))
    for effect in effects:
        settings = in_commands(known[effect], settings, runs, own_seed)
    return Case(name, kind, effects, strength, settings, runs, own_seed)


def in_commands(hidden: Hidden, settings: dict[str, float], runs: tuple[Plan, ...], seed: int) -> dict[str, float]:
    """Convert an effect's size from a share of the largest command to a command [A], where it is such a share."""
    if not hidden.of_peak:
        return settings
    without = {key: value for key, value in settings.items() if key != hidden.setting}
    return without | {hidden.setting: settings[hidden.setting] * largest_command(without, runs, seed)}


def cases(seed: int) -> list[Case]:
    """Draw all cases of a seed."""
    out = []
    for strength in STRENGTHS:
        for effect in (*CATALOGUE, *OUTSIDE):
            kind = "one" if effect in CATALOGUE else "outside"
            if f"{strength:g}" in sizes()[effect]:
                out.append(_case(seed, f"{effect}-{strength:g}", kind, (effect,), strength))
    for case in [c for c in out if c.strength == 3.0]:  # a second draw at the strength that most goals are stated for
        out.append(_case(seed, f"{case.name}-again", case.kind, case.effects, 3.0))
    pairs = [pair for pair in combinations(CATALOGUE, 2) if "3" in sizes()[pair[0]] and "3" in sizes()[pair[1]]]
    for i in stream(seed, "pairs").choice(len(pairs), PAIRS, replace=False):
        out.append(_case(seed, "-".join(pairs[i]), "two", pairs[i], 3.0))
    out += [_case(seed, f"null-{i}", "null", (), 0.0) for i in range(NULLS)]
    return out


def sample(seed: int, count: int) -> list[Case]:
    """Draw a sample of a seed's cases at random: a smaller sample is part of every larger one."""
    every = cases(seed)
    return [every[i] for i in stream(seed, "sample").permutation(len(every))[:count]]
