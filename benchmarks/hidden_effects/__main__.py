"""Run the benchmark of hidden effects, and write its table; an interrupted run resumes at the first missing answer."""

from __future__ import annotations

import argparse
import fnmatch
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.answers.program import print_figures, teller
from benchmarks.answers.run import by_diagnosis, run
from benchmarks.hidden_effects import baselines, sindy, table
from benchmarks.hidden_effects.calibrate import calibrate
from benchmarks.hidden_effects.cases import cases, sample
from flexarm_env.terminal.program import Program

METHODS = {
    "diagnose": by_diagnosis,
    "bic": baselines.stepwise,
    "sindy": sindy.sindy_on_residuals,
}
RESULTS = Path(__file__).resolve().parents[2] / "results" / "hidden_effects"


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.hidden_effects", description=__doc__)
    parser.add_argument("--seed", type=int, default=1, help="of the cases; 1 to 8 have been looked at")
    parser.add_argument("--method", choices=METHODS, default="diagnose", help="that answers them")
    parser.add_argument(
        "--only",
        default="*",
        metavar="PATTERN",
        help="names of cases, as 'backlash-*', or of effects to calibrate; no table is written",
    )
    parser.add_argument("--sample", type=int, metavar="COUNT", help="answer so many cases, drawn at random, and not all")
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    parser.add_argument("--output", type=Path, default=RESULTS, help="folder of answers and tables")
    parser.add_argument("--calibrate", action="store_true", help="find the sizes of the effects again instead")
    asked = parser.parse_args(arguments)
    if asked.sample is not None and asked.sample < 1:
        parser.error(f"--sample {asked.sample}: at least 1 case is needed")
    return asked


@Program(stopped="stopped; the same command goes on")
def main(arguments: Sequence[str]) -> None:
    """Answer the requested cases."""
    asked = _options(arguments)
    say = teller()
    if asked.calibrate:
        calibrate(asked.only, asked.jobs, say)
        return
    listed = cases(asked.seed) if asked.sample is None else sample(asked.seed, asked.sample)
    chosen = [case for case in listed if fnmatch.fnmatchcase(case.name, asked.only)]

    def answered(count: int, answer: dict[str, Any]) -> None:
        found, case = answer["found"], answer["case"]
        said = ", ".join(found["effects"]) or found["verdict"]
        say(f"{count} of {len(chosen)}  {case['name']}: {said}, error {found['error']['final']:.2f}")

    answers = run(chosen, METHODS[asked.method], _folder(asked, asked.method) / "answers", asked.jobs, answered)
    if asked.only == "*":
        _write(asked, asked.method, answers)
        if asked.method == "bic":
            _write(asked, "best-fit", [baselines.best_fit_wins(answer) for answer in answers])


def _folder(asked: argparse.Namespace, method: str) -> Path:
    output: Path = asked.output
    return output / f"{method}-{asked.seed}"


def _write(asked: argparse.Namespace, method: str, answers: list[dict[str, Any]]) -> None:
    """Write a method's table, and print it."""
    command = f"python -m benchmarks.hidden_effects --method {asked.method} --seed {asked.seed}"
    command += f" --sample {asked.sample}" if asked.sample else ""
    print(method)
    print_figures(table.write(_folder(asked, method), answers, method, asked.seed, command), 50)


if __name__ == "__main__":
    sys.exit(main())
