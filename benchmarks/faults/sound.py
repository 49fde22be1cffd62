"""Sound recordings, on which no fault must be named: of machines with hidden effects, and of real ones."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import flexarm_env.demo
from benchmarks.hidden_effects.cases import sample
from flexarm_env import Arm, Recording
from flexarm_env.terminal.inputs import read_recordings

MEASUREMENTS = Path(__file__).resolve().parents[3] / "shared" / "measurements"
ARM = "thesis-fem"
#: Arm and files of each real machine.
REAL = (
    ("emps", "emps/*.mat"),
    ("cu-flexible", "cu_boulder/*flexarm*.txt"),
    ("cu-rigid", "cu_boulder/*rigidarm*.txt"),
)

Case = tuple[str, Arm, list[Recording]]


def hidden_effects(seed: int, count: int) -> Iterator[Case]:
    """Record cases of the benchmark of hidden effects, drawn at random."""
    arm = Arm.load(ARM)
    for case in sample(seed, count):
        yield case.name, arm, case.recordings()


def shipped() -> Iterator[Case]:
    """Read the recordings of the demo."""
    yield "demo", Arm.load(ARM), Recording.read_all(Path(flexarm_env.demo.__file__).parent)


def real() -> Iterator[Case]:
    """Read recordings of real machines and of the practice cases; none where the folder is absent."""
    for name, pattern in REAL:
        files = sorted(MEASUREMENTS.glob(pattern))
        if files:
            arm = Arm.load(name)
            yield name, arm, read_recordings(arm, files, None)
    for folder in sorted(MEASUREMENTS.glob("practice/p*")):
        yield folder.name, Arm.load(ARM), Recording.read_all(folder)
