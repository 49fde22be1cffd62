"""What README.md and docs/thesis.md say of the thesis is what results/thesis/thesis.json holds.

`python tests/thesis/test_documentation.py` writes it there.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

PROJECT = Path(__file__).resolve().parents[2]
RESULTS = PROJECT / "results" / "thesis" / "thesis.json"
PLACES = {"thesis": PROJECT / "README.md", "claims": PROJECT / "docs" / "thesis.md", "errata": PROJECT / "docs" / "thesis.md"}
VERDICTS = ("holds", "holds in part", "does not hold")


def block(name: str) -> re.Pattern[str]:
    return re.compile(f"(?<=<!-- {name} -->).*?(?=<!-- /{name} -->)", re.DOTALL)


def number(value: float) -> str:
    from flexarm_env.pictures.words import number as shown

    return shown(value, 4)


def summary(results: Mapping[str, Any]) -> str:
    found = [row["verdict"] for row in results["claims"]]
    held, part, failed = (found.count(verdict) for verdict in VERDICTS)
    return f"Of {len(found)} claims {held} hold, {part} hold in part and {failed} do not."


def claims(results: Mapping[str, Any]) -> str:
    lines = ["", "| | the thesis | here | verdict |", "|---|---|---|---|"]
    for row in results["claims"]:
        parts = "; ".join(f"{'✓' if part['holds'] else '✗'} {part['ours']}" for part in row["parts"])
        verdict = f"**{row['verdict']}**, because {row['because'].rstrip('.')}"
        cells = [row["claim"], f"{row['thesis']} ({row['where']})", parts, verdict]
        lines.append(f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |")
    return "\n".join(lines) + "\n"


def errata(results: Mapping[str, Any]) -> str:
    lines = [
        "",
        "| | where | printed | should be | changes | as printed | mended | figures |",
        "|---|---|---|---|---|---:|---:|---|",
    ]
    for row in results["errata"]:
        cells = [row["number"], row["where"], row["says"], row["should"], row["effect"], number(row["printed"])]
        lines.append(f"| {' | '.join([*cells, number(row['mended']), ', '.join(row['figures'])])} |")
    return "\n".join(lines) + "\n"


WRITERS = {"thesis": summary, "claims": claims, "errata": errata}


def wanted() -> dict[str, str]:
    results = json.loads(RESULTS.read_text(encoding="utf-8"))
    return {name: write(results) for name, write in WRITERS.items()}


def test_documents_have_the_numbers_of_the_results():
    for name, text in wanted().items():
        (written,) = block(name).findall(PLACES[name].read_text(encoding="utf-8"))
        assert written == text, f"{PLACES[name].name}: python tests/thesis/test_documentation.py"


def test_the_results_are_those_of_the_model():
    """The committed verdicts and misprints come out again; what switches at zero speed may differ in the third digit."""
    from flexarm_env.thesis.claims import ROWS
    from flexarm_env.thesis.errata import errata as found

    results = json.loads(RESULTS.read_text(encoding="utf-8"))
    made = [row().as_json() for row in ROWS[:-1]]  # but for T19, which measures this machine
    for row, kept in zip(made, results["claims"], strict=False):
        assert row["verdict"] == kept["verdict"], row["claim"]
        for part, before in zip(row["parts"], kept["parts"], strict=True):
            assert part["numbers"] == pytest.approx(before["numbers"], rel=0.02, abs=1e-6), row["claim"]
    for row, kept in zip(found(), results["errata"], strict=True):
        assert (row.printed, row.mended) == pytest.approx((kept["printed"], kept["mended"]), rel=0.02, abs=1e-6)


if __name__ == "__main__":
    for name, text in wanted().items():
        place = PLACES[name]
        place.write_text(block(name).sub(lambda _, text=text: text, place.read_text(encoding="utf-8")), encoding="utf-8")
