"""What every controller owes: the same bits in a batch, finite commands within the limit, one-line errors."""

from __future__ import annotations

import importlib.util
import sys
from dataclasses import replace

import numpy as np
import pytest
from controllers.loop import INTERVAL

from flexarm_env.arm import Arm
from flexarm_env.controllers import CONTROLLERS, make_controller
from flexarm_env.errors import InputError

#: Those that can be made with what is installed.
NAMES = [name for name in CONTROLLERS if importlib.util.find_spec("daqp") or not name.startswith("mpc")]
#: Laws that work without a gage, and those that weigh the payload by it.
WITHOUT_GAGE = ("pd", "pd_rate_limited", "shaped_zv", "shaped_zvd", "lqg", "pid_compensated")
WEIGH = ("lqg_scheduled", "mpc")

ARMS, SAMPLES = 7, 60


def observations(count=ARMS, samples=SAMPLES):
    """Readings that wander about, some at rest, (samples, count, 5)."""
    draw = np.random.default_rng(1)
    steps = draw.normal(size=(samples, count, 5)) * [0.02, 0.5, 0.1, 0.2, 0.0]
    steps[:, :, -1] = draw.choice([0.0, 0.0, 0.9], size=(samples, count))
    return np.cumsum(steps, axis=0)


@pytest.mark.parametrize("name", NAMES)
def test_a_batch_gives_the_bits_of_each_arm_alone(fine, name):
    controller, seen = make_controller(name, fine, INTERVAL), observations()
    controller.reset(ARMS)
    together = np.array([controller.act(one) for one in seen])
    for place in range(ARMS):
        controller.reset()
        alone = np.array([controller.act(one) for one in seen[:, place]])
        assert alone.shape == (SAMPLES,)
        assert alone.tobytes() == together[:, place].tobytes()


@pytest.mark.parametrize("name", NAMES)
def test_reset_forgets(thesis, name):
    controller, seen = make_controller(name, thesis, INTERVAL), observations()
    runs = []
    for _ in range(2):
        controller.reset(ARMS)
        runs.append(np.array([controller.act(one) for one in seen]))
    assert runs[0].tobytes() == runs[1].tobytes()


@pytest.mark.parametrize("name", NAMES)
def test_a_missing_reading_counts_as_the_last_one(thesis, name):
    controller, seen = make_controller(name, thesis, INTERVAL), observations()
    seen[20:23, 2, :4] = [np.nan, np.inf, -np.inf, np.nan]
    repeated = seen.copy()
    repeated[20:23, 2, :4] = seen[19, 2, :4]
    runs = []
    for each in (seen, repeated):
        controller.reset(ARMS)
        runs.append(np.array([controller.act(one) for one in each]))
    assert np.isfinite(runs[0]).all()
    np.testing.assert_array_equal(runs[0], runs[1])


@pytest.mark.parametrize("name", NAMES)
def test_commands_and_actions_keep_to_the_limit(fine, name):
    controller = make_controller(name, fine, INTERVAL)
    controller.reset(ARMS)
    commands = np.array([controller.act(30.0 * one) for one in observations()])
    assert np.abs(commands).max() == 5.0
    controller.reset(ARMS)
    actions = np.array([controller.action(30.0 * one) for one in observations()])
    assert actions.dtype == np.float32
    np.testing.assert_array_equal(actions, (commands / 5.0)[..., None].astype(np.float32))


@pytest.mark.parametrize("name", NAMES)
def test_signals_are_found_by_name(thesis, name):
    order = ["strain_base", "motor_speed", "strain_mid", "arm_angle"]
    other = replace(thesis, sensors={signal: thesis.sensors[signal] for signal in order})
    places = [list(thesis.signals).index(signal) for signal in order] + [4]
    runs = []
    for arm, seen in ((thesis, observations()), (other, observations()[:, :, places])):
        controller = make_controller(name, arm, INTERVAL)
        controller.reset(ARMS)
        runs.append(np.array([controller.act(one) for one in seen]))
    np.testing.assert_allclose(*runs, atol=1e-8)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("signal", ["arm_angle", "motor_speed", "strain"])
def test_a_missing_signal_is_said_in_one_line(thesis, name, signal):
    less = replace(thesis, sensors={s: table for s, table in thesis.sensors.items() if not s.startswith(signal)})
    if signal == "strain" and name.removesuffix("_tuned") in WITHOUT_GAGE:
        make_controller(name, less, INTERVAL).reset()
        return
    with pytest.raises(InputError, match=signal) as error:
        make_controller(name, less, INTERVAL)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("shipped", ["cu-flexible", "cu-rigid", "emps"])
def test_other_arms_are_driven_or_refused(name, shipped):
    arm = Arm.load(shipped)
    gages = arm.has("strain")
    lacks = None
    if "motor_speed" not in arm.signals:
        lacks = "motor_speed"
    elif not gages and name.startswith(("vibration", *WEIGH)):
        lacks = "strain"
    elif not arm.has("beam") and name.startswith("shaped"):
        lacks = "beam"
    if lacks:
        with pytest.raises(InputError, match=lacks) as error:
            make_controller(name, arm, INTERVAL)
        assert "\n" not in str(error.value)
        return
    controller = make_controller(name, arm, INTERVAL)
    controller.reset(3)
    assert np.isfinite(controller.act(np.full((3, len(arm.signals) + 1), 0.1))).all()


def test_names_and_options_are_checked(thesis):
    with pytest.raises(InputError, match="did you mean 'vibration_dual'"):
        make_controller("vibration_duel", thesis, INTERVAL)
    with pytest.raises(InputError, match="did you mean 'proportional'"):
        make_controller("vibration_filtered", thesis, INTERVAL, proportionl=1.0)
    assert make_controller("vibration_filtered", thesis, INTERVAL, proportional=1.0).proportional == 1.0


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("pd_rate_limited", {"rate": 0.0}),
        ("vibration_dual", {"delay": -1.0}),
        ("shaped_zv", {"mode": "free"}),
        ("lqg", {"design": {"angel": 0.1}}),
        ("lqg", {"design": {"angle": 0.0}}),
        ("lqg", {"design": 3.0}),
        ("pid_compensated", {"design": {"bandwidth": float("nan")}}),
    ],
)
def test_bad_options_are_refused(thesis, name, options):
    with pytest.raises(InputError):
        make_controller(name, thesis, INTERVAL, **options)


def test_bad_use_is_refused(thesis):
    controller = make_controller("pd", thesis, INTERVAL)
    with pytest.raises(InputError, match="shape"):
        controller.act(np.zeros(5))  # before reset
    with pytest.raises(InputError, match="at least 1"):
        controller.reset(0)
    controller.reset(2)
    with pytest.raises(InputError, match="needed is"):
        controller.act(np.zeros(5))
    with pytest.raises(InputError, match="interval"):
        make_controller("pd", thesis, float("nan"))
    free = thesis.with_values({"drive.limit": 0.0})
    unlimited = make_controller("pd", free, INTERVAL)
    unlimited.reset()
    assert unlimited.act(np.array([0.0, 0.0, 0.0, 0.0, 10.0])) == pytest.approx(25.308)
    with pytest.raises(InputError, match="limit"):
        unlimited.action(np.zeros(5))


def test_without_its_solver_mpc_is_refused_in_one_line(thesis, monkeypatch):
    monkeypatch.setitem(sys.modules, "daqp", None)
    with pytest.raises(InputError, match=r"flexarm-env\[control\]") as error:
        make_controller("mpc", thesis, INTERVAL)
    assert "\n" not in str(error.value)
