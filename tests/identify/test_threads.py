"""Replays in threads are those that one thread makes."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from flexarm_env import Arm, simulate
from flexarm_env.identify.calibrate.objective import objective_at
from flexarm_env.identify.calibrate.parameters import free_parameters
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.error_measure import score
from flexarm_env.identify.threads import in_threads, threads


def test_results_come_in_the_order_of_the_tasks():
    last_began = threading.Event()

    def work(number: int) -> int:
        if number == 0:
            assert last_began.wait(10.0), "the others run meanwhile"
        if number == 3:
            last_began.set()
        return number

    with threads(2):
        assert in_threads(work, [(n,) for n in range(4)]) == [0, 1, 2, 3]


def test_no_thread_is_used_without_a_context_nor_within_a_thread():
    def here() -> int:
        return threading.get_ident()

    assert in_threads(here, [(), ()]) == [here(), here()]
    with threads(1):
        assert in_threads(here, [(), ()]) == [here(), here()]
    with threads(2):
        for own, inside in in_threads(lambda: (here(), in_threads(here, [(), ()])), [(), ()]):
            assert own != here()
            assert inside == [own, own]
    assert in_threads(here, [()]) == [here()]


def test_an_error_in_a_thread_is_raised_here():
    with threads(2), pytest.raises(ZeroDivisionError):
        in_threads(lambda number: 1 / number, [(1,), (0,), (1,)])


def test_runs_of_one_plant_are_replayed_at_once_as_one_by_one():
    arm = Arm.load("thesis")
    runs = [simulate(arm, "square", duration=2.0, rate=200.0, seed=seed) for seed in range(3)]
    nominal, dataset = prepare(arm, runs)
    assert len(dataset.plants(nominal)) == 1, "they share one plant"
    parameters = free_parameters(nominal, nominal, dataset)
    points = [parameters.position(nominal) + shift for shift in (0.0, 0.01, 0.02)]

    def results(count: int) -> list[np.ndarray]:
        with threads(count):
            objectives = [objective_at(nominal, dataset, parameters, noise) for noise in (0.0, 0.01)]
            alone = [each.residual(points[0]) for each in objectives]  # for which observers are then designed
            found = [residual for each in objectives for residual in each.residuals(points)]
            windows = score(nominal, dataset)
        return [*alone, *found, np.array([windows.windows, windows.free_run])]

    for alone, together in zip(results(1), results(4), strict=True):
        np.testing.assert_array_equal(alone, together)
