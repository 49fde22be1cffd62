"""What environments and tasks refuse: one clear line each."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest

from flexarm_env import Arm, InputError
from flexarm_env.tasks import Task
from flexarm_env.wrappers import Shaped

#: Environments with one number an action, as they are and as policies are trained on them, and their arguments.
WITH_ONE_NUMBER = {"FlexArm/Slew-v0": {}, "FlexArm/Slew-Shaped-v0": {"interface": {"pulse": 0.0}}}


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"randomize": {}}, ["'randomize'", "randomise"]),
        ({"arm": "thesys"}, ["thesys", "thesis"]),
        ({"randomise": {"payload.mass": (-0.1, 0.3)}}, ["payload.mass", "-0.1", "bounds"]),
        ({"randomise": {"payload.mas": (0.0, 0.3)}}, ["payload.mas", "payload.mass"]),
        ({"randomise": {"payload.mass": 0.3}}, ["payload.mass", "two numbers"]),
        ({"randomise": {"payload.mass": (0.3, 0.1)}}, ["lowest"]),
        ({"randomise": {"beam.elements": (1, 3)}}, ["beam.elements", "built"]),
        ({"randomise": {"sensors.arm_angle.noise": (0.0, 0.1)}}, ["sensors.arm_angle.noise"]),
        ({"vary": {"hub.inertia": 1.5}}, ["hub.inertia", "share"]),
        ({"disturb": {"taps": 1.0}}, ["'taps'", "tap_rate"]),
        ({"disturb": {"tap_rate": -1.0}}, ["tap_rate"]),
        ({"control_rate": 0.0}, ["control_rate"]),
        ({"control_rate": float("nan")}, ["control_rate"]),
        ({"control_rate": "fast"}, ["control_rate", "fast"]),
        ({"arm": 3}, ["arm = 3"]),
        ({"randomise": 5}, ["randomise = 5", "payload.mass"]),
        ({"vary": {"hub.inertia": "a"}}, ["hub.inertia", "share"]),
        ({"disturb": 3}, ["disturb = 3"]),
        ({"disturb": {"tap_rate": "often"}}, ["tap_rate", "often"]),
        ({"task": "track"}, ["task", "slew"]),
        ({"randomise": {"drive.limit": (1.0, 2.0)}}, ["drive.limit", "arm file"]),
        ({"randomise": {5: (1.0, 2.0)}}, ["5", "no path"]),
        ({"randomise": {"payload.mass": (0.0, 0.1), "effects.payload.mass": (0.0, 0.2)}}, ["payload.mass", "twice"]),
        ({"randomise": {"sensors.strain_mid.position": (0.5, 6.0)}}, ["strain_mid", "6 m", "1 m"]),
        ({"randomise": {"beam.length": (0.3, 0.9)}}, ["strain_mid", "0.3 m"]),
        ({"disturb": {5: 1.0}}, ["5", "tap_rate"]),
        ({"disturb": {"tap_time": 1e308}}, ["tap_time", "1e+308"]),
        ({"physical": "False"}, ["physical", "True or False"]),
        ({"control_rate": True}, ["control_rate", "True"]),
        ({"duration": "long"}, ["duration", "long"]),
        ({"duration": 0.0}, ["duration = 0.0"]),
        ({"arm": "emps"}, ["'emps'", "drive.limit", "with_values", "[A]"]),
        ({"arm": {"drive": {}}}, ["drive.", "missing"]),
        ({"goals": "12"}, ["goals = '12'", "two angles"]),
        ({"goals": b"\1\2"}, ["goals = b", "two angles"]),
        ({"goals": {1: 2, 2: 3}}, ["goals = {1: 2, 2: 3}", "two angles"]),
        ({"goals": ("1", "2")}, ["goals = '1'", "two angles"]),
        ({"goals": (True, 2)}, ["goals = True", "two angles"]),
        ({"goals": [[1], [1, 2]]}, ["goals = [1]", "two angles"]),
        ({"goals": (10**400, 1)}, ["goals is beyond any float"]),
        ({"randomise": {"payload.mass": "03"}}, ["payload.mass = '03'", "two numbers"]),
        ({"randomise": {"payload.mass": {0.0: 1, 0.1: 2}}}, ["payload.mass = {", "two numbers"]),
        ({"randomise": {"payload.mass": (0, 10**400)}}, ["payload.mass is beyond any float"]),
        ({"vary": {"hub.inertia": 10**400}}, ["hub.inertia is beyond any float", "share"]),
        ({"vary": {"hub.inertia": True}}, ["hub.inertia = True", "share"]),
        ({"disturb": {"tap_rate": 10**400}}, ["tap_rate is beyond any float"]),
        ({"control_rate": 10**400}, ["control_rate is beyond any float", "[Hz]"]),
        ({"control_rate": np.complex128(200)}, ["control_rate", "[Hz]"]),
        ({"duration": 10**400}, ["duration is beyond any float", "[s]"]),
        ({"arm": "x" * 5000}, ["no arm 'xxx"]),
        ({"prior": 3}, ["prior = 3"]),
    ],
)
def test_bad_arguments_give_one_clear_line(arguments: dict, words: list[str]) -> None:
    with pytest.raises(InputError) as caught:
        gym.make("FlexArm/Slew-v0", **arguments)
    message = str(caught.value)
    assert "\n" not in message
    for word in words:
        assert word in message


@pytest.mark.parametrize("drawn", [{}, {"backlash.gap": (0.01, 0.05)}, {"stribeck.extra": (0.0, 0.1)}])
def test_a_share_of_what_the_arm_lacks_is_refused(drawn: dict) -> None:
    """And one of what it has is that share, though another value of the effect is drawn as well."""
    arm = Arm.load("thesis").with_effect("friction_warmup", share=0.4, time_constant=50.0)
    for path in ("backlash.gap", "stribeck.falloff_speed"):
        with pytest.raises(InputError, match=f"vary: {path} is a share .* 'thesis' has no {path.partition('.')[0]}; give"):
            gym.make("FlexArm/Slew-v0", arm=arm, randomise=drawn, vary={path: 0.1})
    drawn = {"friction_warmup.share": (0.1, 0.2)}
    env = gym.make("FlexArm/Slew-v0", arm=arm, randomise=drawn, vary={"friction_warmup.time_constant": 0.1})
    assert env.unwrapped.setup.variation.ranges[1] == ("effects.friction_warmup.time_constant", 45.0, pytest.approx(55.0))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"seed": 1.5}, "whole number"),
        ({"seed": [1, "a"]}, "whole number"),
        ({"seed": [1, 2, 3]}, "3 seeds for 2 arms"),
        ({"seed": 2**64}, "seed = 18446744073709551616; give a whole number from 0 to 2"),
        ({"seed": 2**64 - 1}, "seed of arm 1 = 18446744073709551616"),
        ({"seed": [4, -1]}, "seed of arm 1 = -1"),
        ({"seed": np.array([0.0, 1.0])}, "whole number"),
        ({"seed": [[1], [2, 3]]}, r"seed of arm 0 = \[1\]"),
        ({"seed": {1: 2, 3: 4}}, "one for each arm"),
        ({"seed": [True, 2]}, "seed of arm 0 = True"),
        ({"options": "abc"}, "reset_mask"),
        ({"options": {"reset_mask": [True]}}, "2 booleans"),
    ],
)
def test_bad_resets_of_many_arms_give_one_clear_line(arguments: dict, words: str) -> None:
    envs = gym.make_vec("FlexArm/Slew-v0", 2, vectorization_mode="vector_entry_point")
    with pytest.raises(InputError, match=words):
        envs.reset(**arguments)


@pytest.mark.parametrize("mode", ["x", None, 3, np.array([1, 2])])
def test_an_autoreset_mode_that_is_none_is_refused(mode: object) -> None:
    with pytest.raises(InputError, match=r"autoreset_mode = .*; allowed: Next"):
        gym.make_vec("FlexArm/Slew-v0", 2, vectorization_mode="vector_entry_point", autoreset_mode=mode)


@pytest.mark.parametrize("seed", [2**64, -1, 1.5, "1", True, [1]])
def test_a_seed_that_is_none_is_refused(seed: object) -> None:
    """It would have the draws of another."""
    with pytest.raises(InputError, match=r"seed = .*; give a whole number from 0 to 2\*\*64"):
        gym.make("FlexArm/Slew-v0").unwrapped.reset(seed=seed)


@pytest.mark.parametrize(
    ("numbers", "words"),
    [
        ({"duration": 0.0}, "duration = 0.0"),
        ({"duration": 1e308}, "duration = 1e"),
        ({"duration": 5.0, "target": float("nan")}, "target = nan"),
        ({"duration": 5.0, "pulse_time": -1.0}, "pulse_time = -1.0"),
        ({"duration": 5.0, "weights": {"effort": float("inf")}}, "weight of effort"),
        ({"duration": 5.0, "weights": {"efort": 1.0}}, "did you mean 'effort'"),
    ],
)
def test_bad_tasks_give_one_clear_line(numbers: dict, words: str) -> None:
    with pytest.raises(InputError, match=words):
        Task("mine", **numbers)
    assert Task("mine", 5.0, range=float("inf")).range == float("inf")


@pytest.mark.parametrize(
    "action",
    [
        *(np.zeros(2), np.zeros((1, 1)), np.array(0.5), np.array([np.nan]), np.array([np.inf]), np.array([1e30]), None),
        *([10**400], "1", ["1"], [1j], np.ma.masked_array([0.5], mask=[True]), [[0.5], [0.5, 1]]),
    ],
)
def test_bad_actions_are_refused(action: object) -> None:
    for id, arguments in WITH_ONE_NUMBER.items():
        env = gym.make(id, disable_env_checker=True, **arguments)
        env.reset(seed=0)
        with pytest.raises(InputError, match="action"):
            env.step(action)


@pytest.mark.parametrize(
    "action",
    [
        *(np.zeros(3), np.zeros((3, 2)), None, "abc", [["0"], ["0"], ["0"]], [[0.5], [0.5, 1], [0.5]], [[10**400], [0.0], [0.0]]),
        *(np.zeros((3, 1), dtype=complex), np.ma.masked_array(np.zeros((3, 1)), mask=[[True], [False], [False]])),
        *(np.array([[0.0], [bad], [0.0]]) for bad in (np.nan, -np.inf, 1e30, np.float32(-1e30))),
    ],
)
def test_bad_actions_of_many_arms_are_refused(action: np.ndarray) -> None:
    for id, arguments in WITH_ONE_NUMBER.items():
        envs = gym.make_vec(id, 3, vectorization_mode="vector_entry_point", **arguments)
        with pytest.raises(gym.error.ResetNeeded):
            envs.step(np.zeros((3, 1)))
        envs.reset(seed=0)
        with pytest.raises(InputError, match="action"):
            envs.step(action)


def test_a_step_before_the_first_reset_is_refused() -> None:
    bare = gym.make("FlexArm/Slew-v0", physical=True).unwrapped
    for env in (bare, Shaped(bare)):
        with pytest.raises(gym.error.ResetNeeded, match="reset"):
            env.step(np.zeros(1))
