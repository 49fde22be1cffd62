"""The rows of a comparison: each recording, and all of several taken together."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env import Arm, Recording, compare, simulate
from flexarm_env.terminal import plain_data, tables


@pytest.fixture(scope="module")
def arm() -> Arm:
    return Arm.load("thesis")


@pytest.fixture(scope="module")
def runs(arm) -> list[Recording]:
    """Two recordings of another arm, of different length."""
    other = arm.with_effect("coulomb", torque=0.2)
    return [simulate(other, name, duration=t, rate=200.0, name=name) for name, t in (("pulse", 1.5), ("square", 2.5))]


def test_several_recordings_have_a_pooled_row_for_each_signal(arm, runs):
    result = compare(arm, runs)
    for signal in arm.signals:
        rows = {row.recording: row for row in result.rows if row.signal == signal and row.part == "all"}
        assert list(rows) == ["pulse", "square", "all"]
        each, pooled = [rows["pulse"], rows["square"]], rows["all"]
        assert pooled.samples == sum(row.samples for row in each) == 800
        for kind in ("error", "free_run"):
            squares = sum(row.samples * getattr(row, kind) ** 2 for row in each)
            assert getattr(pooled, kind) == pytest.approx(np.sqrt(squares / pooled.samples), rel=1e-12)
        measured = np.concatenate([run.signals[signal] for run in runs])
        off = pooled.free_run * result.noise[signal] / measured.std()
        assert pooled.fit == pytest.approx(100.0 * (1.0 - off), rel=1e-9)


def test_one_recording_is_not_pooled_with_itself(arm, runs):
    rows = [row for row in compare(arm, runs[:1]).rows if row.signal in arm.signals and row.part == "all"]
    assert [row.recording for row in rows] == ["pulse"] * len(arm.signals)


def test_the_pooled_rows_are_shown_and_written(arm, runs):
    result = compare(arm, runs)
    pooled = next(row for row in result.rows if (row.recording, row.signal, row.part) == ("all", "arm_angle", "all"))
    assert vars(pooled) in plain_data.of_comparison(result)["rows"]
    by_recording = tables.comparison(result)[3]
    columns = [[str(cell) for cell in column.cells] for column in by_recording.columns]
    assert columns[0] == ["pulse", "square", "all"]
    assert columns[1][2] == f"{pooled.error:.3g}"
    by_signal = tables.comparison(result)[1]
    assert next(iter(by_signal.columns[3].cells)).plain == f"{pooled.fit:.1f} %"
