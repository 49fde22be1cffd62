"""Samples at fault in words, and the line that leaves them out."""

from __future__ import annotations

import tomllib

import numpy as np
import pytest

from flexarm_env import Recording
from flexarm_env.identify.inspect.report import ignore, row_list, stretches

#: Ten samples at 10 Hz, the first one at 0.
TEN = Recording.from_arrays("ten", 0.1 * np.arange(10), "current", np.zeros(10), {"arm_angle": np.arange(10)})


@pytest.mark.parametrize(
    ("rows", "most", "words"),
    [
        ([0], 3, "sample 1"),
        ([9], 1, "sample 10"),
        ([0, 1], 3, "samples 1 to 2"),
        ([0, 2], 3, "samples 1, 3"),
        ([0, 1, 2, 5, 7, 8], 3, "samples 1 to 3, 6, 8 to 9"),
        ([0, 1, 2, 5, 7, 8], 2, "samples 1 to 3, 6 and 1 more"),
        ([0, 2, 4, 6, 8], 2, "samples 1, 3 and 3 more"),
    ],
)
def test_samples_are_counted_from_1(rows, most, words):
    assert row_list(np.array(rows), most) == words


@pytest.mark.parametrize(
    ("rows", "spans"),
    [
        ([0], [(-0.05, 0.05)]),
        ([9], [(0.85, 0.95)]),
        ([2, 3, 4], [(0.15, 0.45)]),
        ([2, 4], [(0.15, 0.25), (0.35, 0.45)]),
        ([0, 1, 5, 8, 9], [(-0.05, 0.15), (0.45, 0.55), (0.75, 0.95)]),
    ],
)
def test_a_stretch_ends_between_two_samples(rows, spans):
    assert np.array(stretches(TEN, rows)) == pytest.approx(np.array(spans))


@pytest.mark.parametrize("rows", [[0], [9], [2, 3, 4], [0, 1, 5, 8, 9]])
def test_the_line_leaves_out_those_samples_alone(tmp_path, rows):
    path = tmp_path / "ten.csv"
    TEN.write(path)
    read = Recording.read(path, tomllib.loads(ignore(TEN, "arm_angle", np.array(rows), most=3)))
    assert np.flatnonzero(np.isnan(read.signals["arm_angle"])).tolist() == rows


def test_a_line_longer_than_a_person_reads_is_not_written():
    assert ignore(TEN, "arm_angle", np.array([0, 2]), most=2)
    assert ignore(TEN, "arm_angle", np.array([0, 2, 4]), most=2) == ""
