"""Put small faults into the program and count those that tests find: python -m benchmarks.mutants --seed 1 --count 300.

An interrupted run resumes at the first mutant without an outcome.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from joblib import Parallel, delayed

import flexarm_env
from benchmarks.mutants.judge import judged
from benchmarks.mutants.measure import measured
from benchmarks.mutants.mutant import PARTS, Mutant, sample
from benchmarks.mutants.reach import PROJECT, Reach
from flexarm_env.files import write_whole
from flexarm_env.terminal.program import Program
from flexarm_env.terminal.provenance import commit

RESULTS = PROJECT / "results" / "mutants"
#: Seconds of tests, as they take on the sound program, to which a mutant is put.
BUDGET = 60.0


@Program(stopped="stopped; the same command goes on")
def main(arguments: Sequence[str]) -> None:
    """Judge a sample of mutants, and write their outcomes and the share that was found."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.mutants", description=__doc__)
    parser.add_argument("--seed", type=int, default=1, help="of the sample")
    parser.add_argument("--count", type=int, default=300, help="mutants, as many of each part")
    parser.add_argument("--part", choices=PARTS, help="mutants of this part only; no table is written")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--out", type=Path, default=RESULTS, help="folder of outcomes and tables, by seed")
    asked = parser.parse_args(arguments)
    folder = asked.out / f"seed-{asked.seed}"
    reach = measured(asked.out / "reach.json")
    parts = PARTS if asked.part is None else (asked.part,)
    mutants = [mutant for part in parts for mutant in sample(asked.seed, part, asked.count // len(PARTS))]
    (folder / "outcomes").mkdir(parents=True, exist_ok=True)
    began, outcomes = time.perf_counter(), []
    tasks = [delayed(_outcome)(mutant, reach, folder / "outcomes", asked.out / "cache") for mutant in mutants]
    for outcome in Parallel(n_jobs=asked.jobs, return_as="generator", batch_size=1)(tasks):
        outcomes.append(outcome)
        what = f"{outcome['name']} {outcome['file']}:{outcome['line']} {outcome['verdict']} {outcome['by']}"
        print(f"{time.perf_counter() - began:5.0f} s  {len(outcomes)} of {len(mutants)}  {what}", file=sys.stderr, flush=True)
    if asked.part is None:
        write(folder / "table.json", outcomes, asked.seed, asked.count)


def _outcome(mutant: Mutant, reach: Reach, folder: Path, cache: Path) -> dict[str, Any]:
    path = folder / f"{mutant.name}.json"
    if path.exists():
        kept: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        if kept.items() >= mutant.as_json().items():
            return kept
    cache.mkdir(parents=True, exist_ok=True)
    outcome = mutant.as_json() | judged(mutant, reach.tests(mutant.file, mutant.line, BUDGET), cache).as_json()
    write_whole(path, json.dumps(outcome, indent=1) + "\n")
    return outcome


def write(path: Path, outcomes: list[dict[str, Any]], seed: int, count: int) -> None:
    """Write the share of mutants found, by part, and those that were not."""
    shares = {}
    for part in PARTS:
        verdicts = Counter(outcome["verdict"] for outcome in outcomes if outcome["name"].startswith(part))
        total = sum(verdicts.values())
        shares[part] = dict(verdicts) | {"mutants": total, "found_percent": round(100 * (1 - verdicts["survived"] / total), 1)}
        print(f"{part:12} {total:4} mutants, {shares[part]['found_percent']:5.1f} % found, {verdicts['hung']} of them by hanging")
    content = {
        "command": f"python -m benchmarks.mutants --seed {seed} --count {count}",
        "version": flexarm_env.__version__,
        "commit": commit(),
        "parts": shares,
        "survivors": [outcome for outcome in outcomes if outcome["verdict"] == "survived"],
    }
    write_whole(path, json.dumps(content, indent=1) + "\n")


if __name__ == "__main__":
    sys.exit(main())
