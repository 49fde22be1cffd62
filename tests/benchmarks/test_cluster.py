"""Work spread over the workers of a cluster by joblib's Dask backend, as `docs/cluster.md` shows."""

from __future__ import annotations

import logging
import os
import signal
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest
from joblib import Parallel, delayed, parallel_config

from benchmarks.answers.run import run
from benchmarks.hidden_effects.cases import cases
from flexarm_env import Arm, Recording, diagnose, simulate

distributed = pytest.importorskip("distributed", reason="needs the extra cluster: pip install flexarm-env[cluster]")
#: joblib before 1.6 warns of its own backend for Dask.
pytestmark = pytest.mark.filterwarnings("ignore:`apply_async` is deprecated:DeprecationWarning")


@pytest.fixture(scope="module")
def client(tmp_path_factory) -> Iterator[object]:
    """Two workers, each a process of its own."""
    folder = str(tmp_path_factory.mktemp("dask"))
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=folder, silence_logs=logging.CRITICAL
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


def count_samples(arm: Arm, recordings: list[Recording], mark: Path | None = None) -> dict[str, object]:
    """Answer a case at once; the first time, where there is a mark to leave, the worker is killed."""
    if mark is not None and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return {"verdict": "unknown", "effects": [], "samples": [len(recording) for recording in recordings]}


def without_times(answers: list[dict[str, object]]) -> list[dict[str, object]]:
    return [{key: value for key, value in answer.items() if key != "cpu_seconds"} for answer in answers]


@pytest.mark.parametrize("killed", [False, True])
def test_a_benchmark_on_a_cluster_is_that_of_one_machine_though_a_worker_is_killed(client, tmp_path, killed):
    chosen, mark = cases(1)[:4], tmp_path / "mark"
    with parallel_config(backend="dask"):
        spread = run(chosen, partial(count_samples, mark=mark if killed else None), tmp_path / "cluster", 2, lambda *_: None)
    alone = run(chosen, count_samples, tmp_path / "alone", 1, lambda *_: None)
    assert mark.exists() == killed
    assert without_times(spread) == without_times(alone)


def test_machines_are_diagnosed_on_a_cluster_to_the_last_bit(client):
    arm = Arm.load("cu-rigid")
    machines = [arm.with_effect("viscous", coefficient=0.01), arm.with_effect("coulomb", torque=0.05)]
    recordings = [simulate(machine, "square", duration=3.0, rate=100.0, seed=1) for machine in machines]
    with parallel_config(backend="dask"):
        spread = Parallel(n_jobs=2)(delayed(diagnose)(arm, [one], jobs=1) for one in recordings)
    alone = [diagnose(arm, [one], jobs=1) for one in recordings]
    assert [found.constants for found in spread] == [found.constants for found in alone]
    assert [found.trace for found in spread] == [found.trace for found in alone]
