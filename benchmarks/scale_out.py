"""Independent diagnoses on two workers of a Dask cluster over one, in turns."""

from __future__ import annotations

import contextlib
import hashlib
import json
import logging
import os
import signal
import time
from collections.abc import Callable, Iterator, Sequence
from multiprocessing import resource_tracker
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.report import origin
from flexarm_env import Arm, Recording, diagnose, simulate
from flexarm_env.errors import InputError
from flexarm_env.files import write_whole

Task = tuple[Callable[..., Any], tuple[Any, ...]]
Say = Callable[[str], None]

STORED = Path(__file__).resolve().parent.parent / "results" / "speed"
#: Diagnoses of a turn, of half a second each: so many that the last one, at which the other worker may wait, weighs little.
COUNT = 40
#: Turns of each cluster, an even number: each comes first as often as the other.
ROUNDS = 6
#: Bytes of purely parallel work, which measures the share of the cores that is free, and how often a task hashes them: half a
#: second, as a diagnosis.
BYTES, HASHES = 50_000_000, 10


def diagnoses(count: int) -> list[Task]:
    """Make diagnoses of one machine by recordings that differ in their noise alone, so that all take alike."""
    arm = Arm.load("cu-rigid")
    hidden = arm.with_effect("viscous", coefficient=0.01)
    recordings = [simulate(hidden, "square", duration=3.0, rate=100.0, seed=seed) for seed in range(count)]
    return [(_diagnosis, (arm, recording)) for recording in recordings]


def _diagnosis(arm: Arm, recording: Recording) -> str:
    return diagnose(arm, [recording], jobs=1).verdict


def _hash(times: int) -> None:
    block = bytes(BYTES)
    for _ in range(times):
        hashlib.sha256(block)


@contextlib.contextmanager
def clusters() -> Iterator[dict[int, Any]]:
    """Start clusters of one and of two worker processes, of one thread each; yield their clients by the number of workers.

    Raises:
        InputError: where Dask is not installed.
    """
    try:
        from distributed import Client, LocalCluster
    except ImportError:
        raise InputError("--scale-out needs Dask; install it: pip install flexarm-env[cluster]") from None
    with contextlib.ExitStack() as stack:
        clients = {}
        for workers in (1, 2):
            options = {"threads_per_worker": 1, "dashboard_address": "127.0.0.1:0", "silence_logs": logging.CRITICAL}
            with _ctrl_c_withheld():
                cluster = stack.enter_context(LocalCluster(n_workers=workers, **options))
            clients[workers] = stack.enter_context(Client(cluster, set_as_default=False))
        yield clients


@contextlib.contextmanager
def _ctrl_c_withheld() -> Iterator[None]:
    """Withhold Ctrl-C for good from workers that the block starts, which would show tracebacks; our own comes after the block."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # where the first worker starts it, it lets Ctrl-C through to that worker
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def seconds_of(client: Any, tasks: Sequence[Task]) -> float:
    """Time tasks on a cluster [s]. Dask is handed them itself: joblib keeps to its own process where a cluster has one worker."""
    began = time.perf_counter()
    client.gather([client.submit(function, *given, pure=False) for function, given in tasks])
    return time.perf_counter() - began


def in_turns(clients: dict[int, Any], tasks: Sequence[Task], rounds: int) -> dict[int, list[float]]:
    """Time tasks on each cluster [s], which changes its place from turn to turn; starting and warming up do not count."""
    function, given = tasks[0]
    for client in clients.values():
        client.run(function, *given)  # on every worker
    times: dict[int, list[float]] = {workers: [] for workers in clients}
    for turn in range(rounds):
        for workers in sorted(clients, reverse=bool(turn % 2)):
            times[workers].append(seconds_of(clients[workers], tasks))
    return times


def ratio(times: dict[int, list[float]]) -> float:
    """Compute how much faster two workers are than one: the median over the turns."""
    return float(np.median(np.array(times[1]) / np.array(times[2])))


def measure(say: Say, count: int = COUNT, rounds: int = ROUNDS, folder: Path = STORED) -> dict[str, Any]:
    """Measure the ratio, and the one that hashes alone get; write both with all times to a folder.

    Args:
        say: called with progress, a line each.
        count: diagnoses of a turn.
        rounds: turns of each cluster.
        folder: of the record.
    """
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else None
    with clusters() as clients:
        say(f"scale-out: {count} diagnoses on one worker and on two, {rounds} times")
        times = in_turns(clients, diagnoses(count), rounds)
        say("scale-out: hashes alone")
        possible = in_turns(clients, [(_hash, (HASHES,))] * count, 2)
    found = {"scale_out": ratio(times), "scale_out_possible": ratio(possible), "scale_out_load": load}
    content = {
        **origin("python -m benchmarks --scale-out"),
        "diagnoses": count,
        "rounds": rounds,
        "seconds": {str(workers): [round(one, 3) for one in each] for workers, each in times.items()},
        **found,
    }
    folder.mkdir(parents=True, exist_ok=True)
    write_whole(folder / "scale_out.json", json.dumps(content, indent=1, ensure_ascii=False) + "\n")
    return found


def words(result: dict[str, Any]) -> str:
    """Say in a paragraph what came of a run."""
    return (
        f"{result['diagnoses']} diagnoses took two workers {np.median(result['seconds']['2']):.1f} s, and one worker"
        f" {result['scale_out']:.2f} times as long (median of {result['rounds']} turns;\nthe goal is 1.8). Hashes alone got"
        f" {result['scale_out_possible']:.2f} times.\n"
    )
