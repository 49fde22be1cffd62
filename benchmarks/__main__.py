"""Measure speed and accuracy and compare them with their goals; the exit code is 0 for any figures."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks import environments, faults, jacobian, plant, report, scale_out, start
from benchmarks.diagnosis import measure as diagnosis
from benchmarks.diagnosis.cases import CASES
from flexarm_env.terminal.outputs import make_folder
from flexarm_env.terminal.program import Program

PARTS = {"plant": plant, "jacobian": jacobian, "start": start, "diagnosis": diagnosis, "environments": environments}
#: Left out of a whole run: one has options of its own, one needs the extra cluster.
ON_REQUEST = {"faults": faults, "scale_out": scale_out}
OUTPUT = Path(__file__).resolve().parent.parent / "results" / "bench" / "bench.json"


@Program()
def main(arguments: Sequence[str]) -> None:
    """Run the requested parts, all by default."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    for name, part in (PARTS | ON_REQUEST).items():
        parser.add_argument(f"--{name.replace('_', '-')}", action="store_true", help=f"only: {part.__doc__}")
    parser.add_argument("--output", type=Path, help="the JSON file; results/bench/bench.json after a whole run")
    parser.add_argument("--cases", nargs="+", choices=list(CASES), help="with --diagnosis: only these")
    parser.add_argument("--seed", type=int, default=faults.SEED, help="with --faults: of the cases; 1 has been looked at")
    parser.add_argument("--count", type=int, default=faults.COUNT, help="with --faults: cases")
    asked = parser.parse_args(arguments)
    if asked.cases and not asked.diagnosis:
        parser.error("--cases needs --diagnosis")
    names = [name for name in PARTS if getattr(asked, name)] or ([] if asked.faults or asked.scale_out else list(PARTS))
    output = asked.output or (OUTPUT if len(names) == len(PARTS) else None)
    if output is not None:
        make_folder(output.parent, output.name)
    began = time.perf_counter()

    def say(text: str) -> None:
        print(f"{time.perf_counter() - began:4.0f} s  {text}", file=sys.stderr, flush=True)

    found: dict[str, Any] = {}
    for name in names:
        found |= diagnosis.measure(say, asked.cases) if name == "diagnosis" else PARTS[name].measure(say)
    if asked.faults:
        found |= faults.measure(say, asked.seed, asked.count)
    if asked.scale_out:
        found |= scale_out.measure(say)
    report.show(found)
    if output is not None:
        report.write(output, found, time.perf_counter() - began)
        say(f"figures are in {output}")


if __name__ == "__main__":
    sys.exit(main())
