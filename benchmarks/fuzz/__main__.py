"""Read damaged files: python -m benchmarks.fuzz --files 100000; the exit code is 1 if one is neither read nor refused."""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from benchmarks.fuzz.attempt import damaged
from benchmarks.fuzz.run import outcomes
from flexarm_env.terminal.outputs import make_folder
from flexarm_env.terminal.program import Program


@Program()
def main(arguments: Sequence[str]) -> int:
    """Read the files asked for, and list what was wrong."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.fuzz", description=__doc__)
    parser.add_argument("--files", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="where files that were neither read nor refused are written")
    asked = parser.parse_args(arguments)
    if asked.keep is not None:
        make_folder(asked.keep)
    began, counts, finds = time.perf_counter(), Counter[str](), 0
    for outcome in outcomes(asked.seed, asked.files):
        counts[f"{outcome.kind} {'wrong' if outcome.is_find else outcome.what}"] += 1
        if not outcome.is_find:
            continue
        finds += 1
        print(f"{outcome.kind} {outcome.number}: {outcome.what}", flush=True)
        if asked.keep is not None:
            sound, content = damaged(asked.seed, outcome.number)
            (asked.keep / f"{outcome.number}{sound.suffix}").write_bytes(content)
    for name, count in sorted(counts.items()):
        print(f"{count:8d} {name}")
    print(f"{asked.files} files of seed {asked.seed} in {time.perf_counter() - began:.0f} s: {finds} neither read nor refused")
    return 1 if finds else 0


if __name__ == "__main__":
    sys.exit(main())
