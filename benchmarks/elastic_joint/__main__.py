"""Diagnose servos on soft gears, and write their table; an interrupted run resumes at the first missing answer."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.elastic_joint.cases import Key
from benchmarks.elastic_joint.score import write
from benchmarks.hidden_effects.run import by_diagnosis, run
from flexarm_env.terminal.program import Program

RESULTS = Path(__file__).resolve().parents[2] / "results" / "elastic_joint"


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.elastic_joint", description=__doc__)
    parser.add_argument("--seed", type=int, default=1, help="of the cases; below 100 for development")
    parser.add_argument("--count", type=int, default=40, help="servos")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--out", type=Path, default=RESULTS, help="folder of answers and tables, by seed")
    asked = parser.parse_args(arguments)
    if asked.count < 1:
        parser.error(f"--count {asked.count}: at least 1 servo is needed")
    return asked


@Program(stopped="stopped; the same command goes on")
def main(arguments: Sequence[str]) -> None:
    """Answer the requested cases."""
    asked = _options(arguments)
    began, folder = time.perf_counter(), asked.out / f"seed-{asked.seed}"

    def answered(count: int, answer: dict[str, Any]) -> None:
        found, named = answer["found"], ", ".join(answer["found"]["effects"])
        what = f"servo {answer['case']['name']}: {found['verdict']} {named}, error {found['error'].get('final')}"
        print(f"{time.perf_counter() - began:5.0f} s  {count} of {asked.count}  {what}", file=sys.stderr, flush=True)

    answers = run([Key(asked.seed, i) for i in range(asked.count)], by_diagnosis, folder / "answers", asked.jobs, answered)
    for figure in write(
        folder, answers, asked.seed, f"python -m benchmarks.elastic_joint --seed {asked.seed} --count {asked.count}"
    ):
        print(f"{figure.what:40} {figure.goal:>12}  {figure.text:>16}  {figure.judged}")


if __name__ == "__main__":
    sys.exit(main())
