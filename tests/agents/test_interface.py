"""What a policy sees, and what becomes of its actions."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")

from agents.learning.episodes import RATE
from flexarm_env import Arm
from flexarm_env.controllers import make_controller
from flexarm_env.tasks import TASKS
from flexarm_env.trials.rollout import roll_out
from flexarm_env.trials.sets import SETS
from flexarm_env.wrappers import InterfaceOptions, PolicyInterface


def test_an_action_of_nothing_leaves_the_base_controller_alone() -> None:
    arm = Arm.load("thesis")
    interface = PolicyInterface(InterfaceOptions(base="lqg", authority=0.3), arm, 1.0 / RATE)

    class Idle:
        def reset(self, count: int | None = None) -> None:
            interface.start(count or 1)

        def action(self, observation: np.ndarray) -> np.ndarray:
            interface.see(observation)
            return interface.send(np.zeros((interface.count, 1)))

    alone = roll_out(make_controller("lqg", arm, 1.0 / RATE), TASKS["slew"], arm, SETS["randomised"], 3)
    assert np.array_equal(roll_out(Idle(), TASKS["slew"], arm, SETS["randomised"], 3).tip, alone.tip)


def test_a_base_controller_knows_what_the_policy_adds() -> None:
    """Under the same commands in all, the filter of an LQG with something added agrees with a filter of its own."""
    arm = Arm.load("thesis")
    interface = PolicyInterface(InterfaceOptions(base="lqg", authority=0.3), arm, 1.0 / RATE)
    draw = np.random.default_rng(0)
    interface.start(2)
    for _ in range(50):
        interface.see(draw.normal(size=(2, 5)) * [1.0, 1.0, 0.1, 0.1, 0.0])
        interface.send(draw.uniform(-1.0, 1.0, (2, 1)))
    assert interface.base is not None
    assert np.allclose(interface.base.estimator.state, interface.estimator.state, rtol=1e-9, atol=1e-9)


def test_lags_show_what_was_read_that_many_samples_ago() -> None:
    arm = Arm.load("thesis")
    options = InterfaceOptions(lags=(0, 2), command_lags=(1,), estimate=False)
    interface = PolicyInterface(options, arm, 1.0 / RATE)
    interface.start(1)
    shown = []
    for k in range(5):
        interface.see(np.array([[0.01 * k, 0.0, 0.0, 0.0, 0.0]]))
        shown.append(interface.features()[0])
        interface.send(np.array([[0.1 * k]]))
    assert shown[4][4] == shown[2][0]
    assert shown[4][-1] == pytest.approx(0.2)


def test_a_pulse_is_sent_in_the_first_sample_that_an_action_is_held_for() -> None:
    interface = PolicyInterface(InterfaceOptions(authority=0.1, pulse=0.3, repeat=3), Arm.load("thesis"), 1.0 / RATE)
    interface.start(2)
    action = np.array([[0.5, 1.0], [-1.0, -0.5]])
    sent = []
    for _ in range(4):
        interface.see(np.zeros((2, 5)))
        sent.append(interface.send(action)[:, 0])
    pulse, held = [0.05 + 0.3, -0.1 - 0.15], [0.05, -0.1]
    np.testing.assert_allclose(sent, [pulse, held, held, pulse], rtol=1e-6)
