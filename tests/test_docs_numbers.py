"""The documents' tables are those of the results; `python tests/test_docs_numbers.py` writes them anew.

A table stands between two comments that name it.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest
from documents import PROJECT, README

RESULTS = PROJECT / "results"


def demo_table(numbers: str) -> str:
    """What README.md says of the demo, from the numbers in results/demo/demo.json."""
    from flexarm_env.demo.story import HIDDEN
    from flexarm_env.pictures.words import number

    results = json.loads(numbers)
    diagnosis, added = results["diagnose"], results["add"]
    steps = {
        "model as given": "nominal",
        "constants refitted": "refitted",
        f"`{added['effect']}` added, all refitted": "final",
    }
    rows = [f"| {name} | {number(added['error'][k])} | {number(added['free_run'][k])} |" for name, k in steps.items()]
    effect, key, size, unit = HIDDEN
    found = f"The verdict is `{diagnosis['verdict']}`: {', '.join(diagnosis['effects']) or 'none named'}."
    hidden = f"Hidden was {effect}, {key} {size} {unit}"
    if added["effect"] == effect:
        value = added["parameters"][key]
        low, high = (number(value[end], 4) for end in ("low", "high"))
        hidden += f"; found {number(value['value'], 4)} {unit} (90 % interval {low} to {high})"
    lines = [
        "| held-out error over noise | windows of 1 s | one free run |",
        "|---|---:|---:|",
        *rows,
        "",
        f"{found} {hidden}.",
        f"The diagnosis took {number(diagnosis['seconds'], 2)} s in two processes.",
    ]
    return "\n".join(lines) + "\n"


def baselines_table(numbers: str) -> str:
    """What README.md says of the baselines, from the numbers in results/baselines/baselines.json."""
    from agents.report import summary_of

    result = json.loads(numbers)
    words = (
        f"The slew over 100°, means over {result['arms']} arms: as in the file (nominal), or with up to 0.3 kg at the tip\n"
        "and constants that differ (randomised). An arm that never settles counts with 5 s."
    )
    return f"{words}\n\n{summary_of(result)}"


@dataclass(frozen=True)
class Table:
    """A table of a document: its name in the comments, the numbers it is made of, and how."""

    name: str
    document: Path
    numbers: Path
    make: Callable[[str], str]

    @property
    def place(self) -> re.Pattern[str]:
        return re.compile(rf"(?<=<!-- {self.name} -->\n).*?(?=<!-- /{self.name} -->)", re.DOTALL)

    @property
    def text(self) -> str:
        return self.make(self.numbers.read_text(encoding="utf-8"))


TABLES = (
    Table("demo", README, RESULTS / "demo" / "demo.json", demo_table),
    Table("baselines", README, RESULTS / "baselines" / "baselines.json", baselines_table),
)


@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.name)
def test_documents_have_the_numbers_of_the_results(table):
    (written,) = table.place.findall(table.document.read_text(encoding="utf-8"))
    assert written == table.text, f"{table.document.name} is not of {table.numbers.name}; write it anew: python {__file__}"


def write(table: Table) -> None:
    """Put the table of the results into its document."""
    made = table.text
    before = table.document.read_text(encoding="utf-8")
    table.document.write_text(table.place.sub(lambda _: made, before), encoding="utf-8")


if __name__ == "__main__":
    sys.path.insert(0, str(PROJECT))
    for each in TABLES:
        write(each)
