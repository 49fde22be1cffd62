"""The parts of a run: each registered environment, half of its steps undisturbed and half disturbed, in stretches."""

from __future__ import annotations

import math
import zlib
from dataclasses import asdict, dataclass
from typing import Any

import gymnasium as gym
from numpy.random import SeedSequence

from flexarm_env.registration import IDS, SHAPED

#: Arms of an environment, as many as the shipped policies are trained on.
ARMS = 256
#: Calls of a part, a million steps: 2 to 7 s, which is what an interrupted process loses.
LONGEST_PART = 4000
#: Arguments of a disturbed environment: constants far from those of the file, hard taps, and sensors that drop out.
DISTURBED: dict[str, Any] = {
    "vary": {
        "drive.torque_constant": 0.3,
        "hub.inertia": 0.3,
        "beam.mass_per_length": 0.3,
        "beam.bending_stiffness": 0.3,
        "viscous.coefficient": 0.5,
        "coulomb.torque": 0.5,
    },
    "disturb": {"tap_rate": 2.0, "tap_torque": 2.0, "dropout_rate": 2.0},
}


@dataclass(frozen=True)
class Part:
    """Calls of one environment from its first reset on: the `number`-th stretch of its steps, from 0."""

    id: str
    disturbed: bool
    number: int
    calls: int
    seed: int

    @property
    def name(self) -> str:
        """Name of its outcome, such as "Slew-Random-v0-disturbed-000"."""
        return f"{self.id.rpartition('/')[2]}-{'disturbed' if self.disturbed else 'undisturbed'}-{self.number:03}"

    @property
    def steps(self) -> int:
        """Steps of all arms."""
        return self.calls * ARMS

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data."""
        return asdict(self)

    def seeds(self) -> SeedSequence:
        """Make the seeds of its arms and of its actions."""
        return SeedSequence([self.seed, zlib.crc32(self.name.encode())])

    def make(self) -> Any:
        """Make its vector environment."""
        given = DISTURBED if self.disturbed else {}
        return gym.make_vec(self.id, ARMS, vectorization_mode="vector_entry_point", **given)


def parts_of(steps: int, seed: int) -> list[Part]:
    """Divide steps, or a few more, equally over all environments; every environment comes once before any comes again."""
    cases = [(id, disturbed) for id in (*IDS, *SHAPED) for disturbed in (False, True)]
    calls = math.ceil(steps / (len(cases) * ARMS))
    stretches = [min(LONGEST_PART, calls - first) for first in range(0, calls, LONGEST_PART)]
    return [Part(*case, number, stretch, seed) for number, stretch in enumerate(stretches) for case in cases]
