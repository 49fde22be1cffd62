"""The ratio of two workers of a cluster over one."""

from __future__ import annotations

import contextlib
import json

import numpy as np
import pytest

from benchmarks import __main__ as program
from benchmarks import scale_out

#: joblib before 1.6 warns of its own backend for Dask.
pytestmark = pytest.mark.filterwarnings("ignore:`apply_async` is deprecated:DeprecationWarning")


class Client:
    """A cluster whose tasks take 6 s over its workers, and another second in its first turn."""

    def __init__(self, workers: int, turns: list[int]) -> None:
        self.workers, self.turns, self.warmed = workers, turns, 0

    def run(self, function, *given) -> None:
        self.warmed += 1

    def seconds(self) -> float:
        first = self.workers not in self.turns
        self.turns.append(self.workers)
        return 6.0 / self.workers + first


def test_clusters_take_turns_and_the_ratio_is_the_median(monkeypatch):
    turns: list[int] = []
    clients = {workers: Client(workers, turns) for workers in (1, 2)}
    monkeypatch.setattr(scale_out, "seconds_of", lambda client, tasks: client.seconds())
    times = scale_out.in_turns(clients, [(print, ())], 3)
    assert turns == [1, 2, 2, 1, 1, 2]
    assert times == {1: [7.0, 6.0, 6.0], 2: [4.0, 3.0, 3.0]}
    assert [client.warmed for client in clients.values()] == [1, 1]
    assert scale_out.ratio(times) == 2.0


def test_a_record_has_the_times_and_the_ratio_of_both_clusters(tmp_path, monkeypatch):
    turns: list[int] = []
    clients = {workers: Client(workers, turns) for workers in (1, 2)}
    monkeypatch.setattr(scale_out, "clusters", lambda: contextlib.nullcontext(clients))
    monkeypatch.setattr(scale_out, "seconds_of", lambda client, tasks: client.seconds())
    found = scale_out.measure(lambda line: None, count=4, rounds=3, folder=tmp_path)
    record = json.loads((tmp_path / "scale_out.json").read_text())
    assert record["seconds"] == {"1": [7.0, 6.0, 6.0], "2": [4.0, 3.0, 3.0]}
    assert found["scale_out"] == record["scale_out"] == record["scale_out_possible"] == 2.0
    assert "4 diagnoses took two workers 3.0 s, and one worker 2.00 times as long" in scale_out.words(record)


@pytest.mark.slow(minutes=1)
def test_clusters_run_the_tasks(tmp_path, monkeypatch):
    pytest.importorskip("distributed", reason="needs the extra cluster: pip install flexarm-env[cluster]")
    monkeypatch.setattr(scale_out, "HASHES", 1)
    found = scale_out.measure(lambda line: None, count=2, rounds=1, folder=tmp_path)
    record = json.loads((tmp_path / "scale_out.json").read_text())
    assert {workers: len(each) for workers, each in record["seconds"].items()} == {"1": 1, "2": 1}
    assert found.items() <= record.items()


def test_the_tasks_are_diagnoses_with_an_answer():
    tasks = scale_out.diagnoses(2)
    assert [function(*given) for function, given in tasks] == ["parameters", "parameters"]
    first, second = (recording for _, (_, recording) in tasks)
    assert not any(np.array_equal(first.signals[name], second.signals[name]) for name in first.signals)


def test_it_is_measured_on_request_alone(monkeypatch, capsys):
    monkeypatch.setattr(scale_out, "measure", lambda say: {"scale_out": 1.7, "scale_out_possible": 1.9, "scale_out_load": 0.0})
    assert program.main(["--scale-out"]) == 0
    out = capsys.readouterr().out
    (row,) = (line for line in out.splitlines() if "independent diagnoses" in line and "≥" in line)
    assert row.split()[-6:] == ["1.7", "×", "≥", "1.8", "×", "MISSED"]
    assert "where hashes alone got 1.90 ×" in out
    assert "scale_out" not in program.PARTS
