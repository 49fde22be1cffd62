"""Step every environment, half of the steps disturbed, and hold each step to its promise; the exit code is 1 where one breaks it.

Every observation, reward and state is to be finite, no call to hang, and none to take 1000 times as long as the median one of
its environment. An interrupted run resumes at the first part without an outcome, of a million steps at most.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from joblib import Parallel, delayed

import flexarm_env
from benchmarks.endurance import table
from benchmarks.endurance.measure import endure
from benchmarks.endurance.parts import Part, parts_of
from benchmarks.report import machine
from flexarm_env.files import read_json, write_whole
from flexarm_env.terminal.outputs import make_folder
from flexarm_env.terminal.program import Program
from flexarm_env.terminal.progress import time_left
from flexarm_env.terminal.provenance import commit

RESULTS = Path(__file__).resolve().parents[2] / "results" / "endurance"
#: Seconds after which a part hangs: more than thirty times what the slowest takes.
LONGEST = 300.0


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.endurance", description=__doc__)
    parser.add_argument("--steps", type=int, default=100_000_000, help="of all environments together")
    parser.add_argument("--seed", type=int, default=1, help="of arms and actions")
    parser.add_argument("--jobs", type=int, default=2, help="processes; with one, a call that hangs is waited for")
    parser.add_argument("--out", type=Path, default=RESULTS, help="folder of the record, the table and the parts' outcomes")
    asked = parser.parse_args(arguments)
    for name in ("steps", "jobs"):
        if getattr(asked, name) < 1:
            parser.error(f"--{name} {getattr(asked, name)}: at least 1 is needed")
    if asked.seed < 0:
        parser.error(f"--seed {asked.seed}: give a whole number from 0 up")
    return asked


@Program(stopped="stopped; the same command goes on")
def main(arguments: Sequence[str]) -> int:
    """Take the requested steps; write the record and the table."""
    asked = _options(arguments)
    make_folder(asked.out / "parts", "the outcomes")
    made_by = {"version": flexarm_env.__version__, "commit": commit()}
    outcomes, hung = measured(parts_of(asked.steps, asked.seed), asked.out / "parts", asked.jobs, made_by)
    if not outcomes:
        print(f"{hung} hung; there is nothing to write", file=sys.stderr)
        return 1
    result = {
        "command": f"python -m benchmarks.endurance --steps {asked.steps} --seed {asked.seed}",
        **made_by,
        "machine": machine(),
        "seed": asked.seed,
        "steps_requested": asked.steps,
    } | table.record(outcomes, hung)
    write_whole(asked.out / "endurance.json", json.dumps(result, indent=1, ensure_ascii=False) + "\n")
    write_whole(asked.out / "endurance.md", table.markdown(result))
    print(table.words(result), end="")
    return 0 if table.kept(result) else 1


def measured(parts: Sequence[Part], folder: Path, jobs: int, made_by: dict[str, Any]) -> tuple[list[dict[str, Any]], str]:
    """Collect the outcome of each part, those of the same program from a folder.

    Args:
        parts: in their order.
        folder: of outcomes.
        jobs: processes.
        made_by: version and commit of the program.

    Returns:
        The outcomes, and the name of the part that hung and ended the run; "" for none.
    """
    found = {part: kept for part in parts if (kept := _kept(folder / f"{part.name}.json", part.as_json() | made_by))}
    missing = [part for part in parts if part not in found]
    steps, began, done = sum(part.steps for part in missing), time.perf_counter(), 0
    tasks = [delayed(_outcome)(part, folder, made_by) for part in missing]
    results = iter(Parallel(n_jobs=jobs, return_as="generator", batch_size=1, timeout=LONGEST if jobs > 1 else None)(tasks))
    for part in missing:
        try:
            found[part] = next(results)
        except multiprocessing.TimeoutError:
            return [found[each] for each in parts if each in found], part.name
        done += part.steps
        ratio, elapsed = found[part]["slowest"] / found[part]["median"], time.perf_counter() - began
        what = f"{part.name}: slowest call {ratio:.0f} × the median; not finite: {found[part]['not_finite'] or 'none'}"
        line = f"{elapsed:5.0f} s  {len(found)} of {len(parts)}  {what}  {time_left(elapsed, done / steps)}"
        print(line.rstrip(), file=sys.stderr, flush=True)
    return [found[each] for each in parts], ""


def _kept(path: Path, wanted: dict[str, Any]) -> dict[str, Any] | None:
    if not path.exists():
        return None
    kept = read_json(path, "delete it, and it is made anew")
    return kept if kept.items() >= wanted.items() else None


def _outcome(part: Part, folder: Path, made_by: dict[str, Any]) -> dict[str, Any]:
    envs = part.make()
    outcome = part.as_json() | made_by | endure(part, envs).as_json()
    envs.close()
    write_whole(folder / f"{part.name}.json", json.dumps(outcome, indent=1) + "\n")
    return outcome


if __name__ == "__main__":
    sys.exit(main())
