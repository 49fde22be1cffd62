"""Run the benchmark of machines, and write its table; an interrupted run resumes at the first missing answer."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from typing import Any

from benchmarks.answers.program import parsed, parser_of, print_figures, teller
from benchmarks.answers.run import run
from benchmarks.machines import table
from benchmarks.machines.cases import keys
from benchmarks.machines.lacks import COUNTS
from benchmarks.machines.method import by_diagnosis_or_failure
from flexarm_env.terminal.program import Program


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    parser = parser_of("machines", __doc__, 96, "cases, a multiple of 16 to have each kind in its share")
    parser.add_argument("--kind", choices=COUNTS, help="cases of this kind only; no table is written")
    return parsed(parser, arguments)


@Program(stopped="stopped; the same command goes on")
def main(arguments: Sequence[str]) -> None:
    """Answer the requested cases."""
    asked, say = _options(arguments), teller()
    chosen = keys(asked.seed, asked.count, asked.kind)
    folder = asked.out / f"seed-{asked.seed}"

    def answered(count: int, answer: dict[str, Any]) -> None:
        found, case = answer["found"], answer["case"]
        said, hidden = (", ".join(part["effects"]) for part in (found, case))
        what = f"{case['name']} {case['family']}, hidden {hidden or 'nothing'}: {found['verdict']} {said}"
        say(f"{count} of {len(chosen)}  {what}, error {found['error'].get('final')}")

    answers = run(chosen, by_diagnosis_or_failure, folder / "answers", asked.jobs, answered)
    if asked.kind is None:
        command = f"python -m benchmarks.machines --seed {asked.seed} --count {asked.count}"
        print_figures(table.write(folder, answers, asked.seed, command), 62)


if __name__ == "__main__":
    sys.exit(main())
