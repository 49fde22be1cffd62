"""The share of lines that tests execute."""

from __future__ import annotations

from benchmarks.lines import record, words

REPORT = {
    "files": {
        "flexarm_env/plant/beam.py": {"summary": {"num_statements": 50, "covered_lines": 49}},
        "flexarm_env/plant/tangents/steps.py": {"summary": {"num_statements": 50, "covered_lines": 41}},
        "flexarm_env/units.py": {"summary": {"num_statements": 0, "covered_lines": 0}},
        "agents/cells.py": {"summary": {"num_statements": 100, "covered_lines": 100}},
    }
}


def test_lines_are_summed_by_part():
    found = record(REPORT, "0123456789ab")
    assert found["total"] == {"lines": 200, "executed": 190}
    assert found["parts"]["flexarm_env/plant"] == {"lines": 100, "executed": 90}
    assert list(found["parts"]) == ["agents", "flexarm_env", "flexarm_env/plant"]


def test_parts_below_the_goal_are_named():
    text = " ".join(words(record(REPORT, "0123456789ab")).split())
    assert "95.0 % of 200 lines" in text
    assert "commit 012345678," in text
    assert text.split("Below the goal: ")[1] == "`flexarm_env/plant` 90 %."
