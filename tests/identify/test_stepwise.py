"""Effects that are added one by one."""

from __future__ import annotations

from contextlib import nullcontext
from types import SimpleNamespace

import pytest

from flexarm_env.identify.progress import Progress
from flexarm_env.identify.select import stepwise
from flexarm_env.identify.settings import SETTINGS

NEAR, CLOSE = SETTINGS.errors.near, SETTINGS.errors.close


@pytest.mark.parametrize(
    ("left", "polished"), [(0.9 * NEAR, False), (1.01 * NEAR, True), (0.99 * CLOSE, True), (1.1 * CLOSE, False)]
)
def test_a_calibration_that_comes_close_is_continued_until_it_is_near(monkeypatch, left, polished):
    """One at the noise has no need of it, and one far off no use."""
    trial = SimpleNamespace(effect="coulomb", cost=1.0, arm="arm")
    monkeypatch.setattr(stepwise, "screen", lambda calibrator, starts, progress: SimpleNamespace(trials=[trial]))
    monkeypatch.setattr(stepwise, "judge", lambda effects, found, dataset: SimpleNamespace(calibration=found, score=found))
    ends = {False: SimpleNamespace(windows=left), True: SimpleNamespace(windows=0.5)}
    calibrator = SimpleNamespace(
        settings=SETTINGS,
        dataset=None,
        workers=SimpleNamespace(threads=nullcontext),
        calibrate=lambda arm: ends[False],
        polish=lambda found: ends[True],
    )
    step = stepwise._best_addition(calibrator, SimpleNamespace(calibration=None), Progress())
    assert step.score is ends[polished]
