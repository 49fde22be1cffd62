"""Run the benchmark of machines, and write its table; an interrupted run resumes at the first missing answer."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.hidden_effects.run import run
from benchmarks.machines import table
from benchmarks.machines.cases import keys
from benchmarks.machines.lacks import COUNTS
from benchmarks.machines.method import by_diagnosis_or_failure
from flexarm_env.terminal.program import Program

RESULTS = Path(__file__).resolve().parents[2] / "results" / "machines"


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.machines", description=__doc__)
    parser.add_argument("--seed", type=int, default=1, help="of the cases; below 100 for development")
    parser.add_argument("--count", type=int, default=96, help="cases, a multiple of 16 to have each kind in its share")
    parser.add_argument("--kind", choices=COUNTS, help="cases of this kind only; no table is written")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--out", type=Path, default=RESULTS, help="folder of answers and tables, by seed")
    asked = parser.parse_args(arguments)
    if asked.count < 1:
        parser.error(f"--count {asked.count}: at least 1 case is needed")
    return asked


@Program(stopped="stopped; the same command goes on")
def main(arguments: Sequence[str]) -> None:
    """Answer the requested cases."""
    asked = _options(arguments)
    began = time.perf_counter()
    chosen = keys(asked.seed, asked.count, asked.kind)
    folder = asked.out / f"seed-{asked.seed}"

    def answered(count: int, answer: dict[str, Any]) -> None:
        found, case = answer["found"], answer["case"]
        said, hidden = (", ".join(part["effects"]) for part in (found, case))
        what = f"{case['name']} {case['family']}, hidden {hidden or 'nothing'}: {found['verdict']} {said}"
        line = f"{time.perf_counter() - began:5.0f} s  {count} of {len(chosen)}  {what}, error {found['error'].get('final')}"
        print(line, file=sys.stderr, flush=True)

    answers = run(chosen, by_diagnosis_or_failure, folder / "answers", asked.jobs, answered)
    if asked.kind is None:
        command = f"python -m benchmarks.machines --seed {asked.seed} --count {asked.count}"
        for figure in table.write(folder, answers, asked.seed, command):
            print(f"{figure.what:62} {figure.goal:>12}  {figure.text:>16}  {figure.judged}")


if __name__ == "__main__":
    sys.exit(main())
