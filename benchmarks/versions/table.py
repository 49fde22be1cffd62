"""The record of both sides, and its table."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from benchmarks.versions.requirements import PROJECT
from benchmarks.versions.suite import folders_of_tests
from flexarm_env.files import write_whole

RECORD = PROJECT / "results" / "versions" / "versions.json"
SIDES = ("oldest", "newest")
#: Requirements that have a column.
SHOWN = ("numpy", "scipy", "numba", "gymnasium")


def keep(measured: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Put runs in their places of the record.

    A side that was not run keeps its own, and a run of some folders keeps the others, with the versions that were others then.

    Raises:
        InputError: if the record cannot be written.
    """
    before = json.loads(RECORD.read_text(encoding="utf-8")) if RECORD.is_file() else {}
    runs = {side: _joined(before.get(side), measured.get(side)) for side in SIDES if side in before or side in measured}
    RECORD.parent.mkdir(parents=True, exist_ok=True)
    write_whole(RECORD, json.dumps(runs, indent=1, ensure_ascii=False) + "\n")
    return runs


def _joined(before: Mapping[str, Any] | None, run: Mapping[str, Any] | None) -> Mapping[str, Any]:
    if before is None or run is None:
        return before or run or {}
    kept = {}
    if (before["python"], before["left_out"]) == (run["python"], run["left_out"]):
        for name, folder in before["folders"].items():
            then = before["requirements"] | folder["other_versions"]
            others = {each: version for each, version in then.items() if run["requirements"].get(each) != version}
            kept[name] = {**folder, "other_versions": others}
    return {**run, "folders": dict(sorted((kept | run["folders"]).items()))}


def markdown(runs: Mapping[str, Mapping[str, Any]]) -> str:
    """Tabulate the versions and the counts of each side, and say what was left out or not run."""
    lines = [
        f"| versions | Python | {' | '.join(SHOWN)} | passed | failed | skipped |",
        "|---|" + "---:|" * (len(SHOWN) + 4),
    ]
    for side, run in runs.items():
        versions = [run["python"], *(run["requirements"][name] for name in SHOWN)]
        lines.append(f"| {side} | {' | '.join(map(str, [*versions, *totals(run)]))} |")
    notes = []
    for side, run in runs.items():
        if missing := sorted(set(folders_of_tests()) - run["folders"].keys()):
            notes.append(f"With the {side} versions no tests of {', '.join(f'`{name}`' for name in missing)} were run.")
        for versions, names in _other_versions(run).items():
            notes.append(f"With the {side} versions the tests of {', '.join(names)} were run with {versions}.")
    left_out = [f"`{name}` with the {side}" for side, run in runs.items() for name in run["left_out"]]
    if left_out:
        words = f"Extras left out: {', '.join(left_out)}. A file of tests that needs one is skipped whole, and counts as one."
        notes.append(words)
    return "\n".join(lines) + "\n" + "".join(f"\n{note}\n" for note in notes)


def _other_versions(run: Mapping[str, Any]) -> dict[str, list[str]]:
    """Group the folders that were run before a version changed by the versions that were others then."""
    groups = dict[str, list[str]]()
    for name, folder in run["folders"].items():
        if others := folder["other_versions"]:
            groups.setdefault(", ".join(f"{each} {version}" for each, version in others.items()), []).append(f"`{name}`")
    return groups


def totals(run: Mapping[str, Any]) -> tuple[int, int, int]:
    """Add up the tests of a side that passed, failed and were skipped."""
    folders = run["folders"].values()
    return (
        sum(each["passed"] for each in folders),
        sum(len(each["failed"]) for each in folders),
        sum(sum(each["skipped"].values()) for each in folders),
    )
