"""Diagnose servos on soft gears, and write their table; an interrupted run resumes at the first missing answer."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from benchmarks.answers.program import parsed, parser_of, print_figures, teller
from benchmarks.answers.run import by_diagnosis, run
from benchmarks.elastic_joint.cases import Key
from benchmarks.elastic_joint.score import write
from flexarm_env.terminal.program import Program


@Program(stopped="stopped; the same command goes on")
def main(arguments: Sequence[str]) -> None:
    """Answer the requested cases."""
    asked, say = parsed(parser_of("elastic_joint", __doc__, 40, "servos"), arguments), teller()
    folder = asked.out / f"seed-{asked.seed}"

    def answered(count: int, answer: dict[str, Any]) -> None:
        found, named = answer["found"], ", ".join(answer["found"]["effects"])
        what = f"servo {answer['case']['name']}: {found['verdict']} {named}, error {found['error'].get('final')}"
        say(f"{count} of {asked.count}  {what}")

    answers = run([Key(asked.seed, i) for i in range(asked.count)], by_diagnosis, folder / "answers", asked.jobs, answered)
    command = f"python -m benchmarks.elastic_joint --seed {asked.seed} --count {asked.count}"
    print_figures(write(folder, answers, asked.seed, command), 40)


if __name__ == "__main__":
    sys.exit(main())
