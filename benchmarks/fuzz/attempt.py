"""Reading of one damaged file, as a person's command would, and what came of it."""

from __future__ import annotations

import json
import random
import resource
import signal
import time
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import Any

from benchmarks.fuzz.corpus import Sound, corpus
from benchmarks.fuzz.mutate import mutate
from flexarm_env import Arm, InputError, Recording, simulate
from flexarm_env.arm_text import arm_text
from flexarm_env.recordings.column_maps import load_columns

#: A file that takes longer [s], more memory [bytes, beyond the most that the process has had] or a longer line is a find,
#: as is one that is neither read nor refused.
LONGEST, MOST_MEMORY, LONGEST_LINE = 10.0, 10**9, 2000
READ, REFUSED = "read", "refused"
#: Shares of the kinds among the files.
SHARES = {"recording": 0.6, "arm": 0.2, "columns": 0.15, "policy": 0.05}

Reader = Callable[[Path, Sound], object]


class TooLong(BaseException):
    """Raised in a reader that takes too long. No reader catches it."""


@dataclass(frozen=True)
class Outcome:
    """What came of a file.

    Attributes:
        number: of the file, from which it can be made again.
        kind: of the file.
        what: READ, REFUSED, or what is wrong.
    """

    number: int
    kind: str
    what: str

    @property
    def is_find(self) -> bool:
        """Whether something is wrong."""
        return self.what not in (READ, REFUSED)


def read_arm(path: Path, sound: Sound) -> object:
    """Read an arm file, write it, read it again, and move the arm."""
    arm = Arm.load(path)
    arm.save(path.with_name("again.toml"))
    if arm_text(Arm.load(path.with_name("again.toml"))) != arm_text(arm):
        raise AssertionError("an arm changes when it is saved and loaded")
    return simulate(arm, "pulse", duration=0.05, rate=200.0, noise=False)


def read_policy(path: Path, sound: Sound) -> object:
    """Read a policy."""
    from agents.learning.artefact import Artefact

    return Artefact.load(path)


READERS: Mapping[str, Reader] = {
    "recording": lambda path, sound: Recording.read(path, sound.columns),
    "arm": read_arm,
    "columns": lambda path, sound: load_columns(path),
    "policy": read_policy,
}


def damaged(seed: int, number: int) -> tuple[Sound, bytes]:
    """Make a damaged file: the sound one that it came from, and its content."""
    draw, files = random.Random(f"{seed}/{number}"), {kind: found for kind, found in corpus().items() if found}
    kind = draw.choices(list(files), [SHARES[kind] for kind in files])[0]
    sound, other = draw.choice(files[kind]), draw.choice(files[draw.choice(list(files))])
    return sound, mutate(sound.content, draw, other.content)


def warm_up(folder: Path) -> None:
    """Read the sound files: what is imported and compiled for the first of its kind takes no part of a damaged one's time."""
    for sound in (sound for files in corpus().values() for sound in files):
        path = folder / f"sound{sound.suffix}"
        path.write_bytes(sound.content)
        READERS[sound.kind](path, sound)


def attempt(seed: int, number: int, folder: Path, readers: Mapping[str, Reader] = READERS) -> Outcome:
    """Read a damaged file."""
    sound, content = damaged(seed, number)
    path = folder / f"damaged{sound.suffix}"
    path.write_bytes(content)
    before = _memory()
    began = time.perf_counter()
    what = _read(path, sound, readers[sound.kind])
    if what in (READ, REFUSED) and time.perf_counter() - began > LONGEST:
        what = f"took {time.perf_counter() - began:.0f} s"
    if (taken := _memory() - before) > MOST_MEMORY:
        what = f"took {taken / 1e6:.0f} MB"
    return Outcome(number, sound.kind, what)


def _memory() -> int:
    """Look up the most memory [bytes] that this process has had."""
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def _read(path: Path, sound: Sound, reader: Reader) -> str:
    earlier = signal.signal(signal.SIGALRM, _stop)
    signal.setitimer(signal.ITIMER_REAL, LONGEST)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            reader(path, sound)
    except InputError as error:
        line = str(error)
        fine = line.isprintable() and len(line) <= LONGEST_LINE + 2 * len(str(path))
        return REFUSED if fine else f"no line for a person: {json.dumps(line[:200])}"
    except TooLong:
        return f"hung for {LONGEST:g} s"
    except Exception as error:
        return f"{type(error).__name__}: {error}"[:300]
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, earlier)
    return READ


def _stop(number: int, frame: FrameType | None) -> Any:
    raise TooLong
