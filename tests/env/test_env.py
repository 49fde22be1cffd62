"""The environments as users of Gymnasium meet them."""

from __future__ import annotations

import subprocess
import sys
import warnings

import gymnasium as gym
import numpy as np
import pytest
from env_steps import TROUBLE, actions, same
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode, SyncVectorEnv

import flexarm_env
from flexarm_env import Arm
from flexarm_env.env import FlexArmEnv
from flexarm_env.env import layout as at
from flexarm_env.registration import IDS
from flexarm_env.tasks import COMMON_TERMS

MODES = [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP]
#: Weights of the terms that the thesis's tasks have.
WEIGHTS = {term.name: term.weight for term in COMMON_TERMS}


@pytest.mark.parametrize("id", IDS)
def test_the_checker_of_gymnasium_is_silent(id: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gym.make(id).unwrapped)


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("arms", [1, 3, 64])
@pytest.mark.parametrize("id", IDS)
def test_vector_and_single_arms_give_the_same_bits(id: str, arms: int, mode: AutoresetMode) -> None:
    arguments = {"disturb": TROUBLE, "max_episode_steps": 25}
    batch = gym.make_vec(id, arms, vectorization_mode="vector_entry_point", autoreset_mode=mode, **arguments)
    singles = SyncVectorEnv([lambda: gym.make(id, **arguments)] * arms, autoreset_mode=mode)
    first, second = batch.reset(seed=5), singles.reset(seed=5)
    assert same(first[0], second[0])
    assert same(first[1], second[1])
    for action in actions(60, arms):
        for one, two in zip(batch.step(action), singles.step(action), strict=True):
            assert same(one, two)


def test_an_episode_depends_on_its_own_seed_alone() -> None:
    arguments = {"vectorization_mode": "vector_entry_point", "disturb": TROUBLE, "max_episode_steps": 20}
    few, many = (gym.make_vec("FlexArm/Slew-Random-v0", n, **arguments) for n in (2, 7))
    few.reset(seed=[11, 12])
    many.reset(seed=[1, 2, 11, 3, 4, 12, 5])
    for action in actions(50, 7):
        assert same(few.step(action[[2, 5]])[0], many.step(action)[0][[2, 5]])


def test_arms_that_wait_for_a_reset_are_reset_by_a_mask() -> None:
    envs = gym.make_vec(
        "FlexArm/Slew-v0", 3, vectorization_mode="vector_entry_point", autoreset_mode="Disabled", max_episode_steps=2
    )
    envs.reset(seed=0)
    for action in actions(2, 3):
        _, _, _, truncated, _ = envs.step(action)
    assert truncated.all()
    with pytest.raises(gym.error.ResetNeeded, match="reset_mask"):
        envs.step(actions(1, 3)[0])
    envs.reset(options={"reset_mask": truncated})
    envs.step(actions(1, 3)[0])


PROGRAM = """
import gymnasium as gym, numpy as np, flexarm_env, hashlib
envs = gym.make_vec("FlexArm/Track-Random-v0", 5, vectorization_mode="vector_entry_point", disturb={"tap_rate": 3.0})
seen, _ = envs.reset(seed=9)
digest = hashlib.sha256(seen.tobytes())
for k in range(40):
    seen, rewards, *_ = envs.step(np.full((5, 1), np.sin(k), dtype=np.float32))
    digest.update(seen.tobytes() + rewards.tobytes())
print(digest.hexdigest())
"""


def test_two_processes_give_the_same_bits() -> None:
    runs = [subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True) for _ in range(2)]
    assert runs[0].stdout == runs[1].stdout
    assert len(runs[0].stdout.strip()) == 64


def make(**arguments: object) -> gym.Env:
    return gym.make("FlexArm/Slew-v0", **arguments)


@pytest.mark.parametrize("varied", [{}, {"drive.gear_ratio": (3.0, 3.0)}, {"drive.torque_constant": (0.2, 0.6)}])
def test_a_tap_is_a_torque_on_the_hub_whatever_drive_was_drawn(varied: dict) -> None:
    env = FlexArmEnv("slew", randomise=varied, disturb={"tap_rate": 200.0, "tap_torque": 5.0, "tap_time": 0.005})
    env.reset(seed=3)
    command, tap = env.batch.arena[env.batch.env_offsets[at.AT_TAP_COMMANDS]], env.batch.own[0, at.TAP_TORQUE]
    drive = env.drawn_arm().constants["drive"]
    assert abs(tap) > 0.1
    assert command * drive["gear_ratio"] * drive["torque_constant"] == pytest.approx(tap)


def test_the_cost_of_vibration_is_by_the_length_that_was_drawn() -> None:
    env = FlexArmEnv("damp", randomise={"beam.length": (1.5, 2.0)})
    env.reset(seed=0)
    info = env.step(np.zeros(1))[4]
    length = env.drawn_arm().constants["beam"]["length"]
    assert 1.5 < length < 2.0
    assert info["reward_vibration"] == pytest.approx(-WEIGHTS["vibration"] * abs(info["tip_deflection"]) / length)


def test_an_action_beyond_the_limit_is_clipped() -> None:
    first, second = make(), make()
    first.reset(seed=0)
    second.reset(seed=0)
    assert same(first.step(np.array([7.0]))[0], second.step(np.array([1.0]))[0])


@pytest.mark.parametrize("id", IDS)
def test_nothing_is_ever_nan_under_the_roughest_actions(id: str) -> None:
    envs = gym.make_vec(id, 8, vectorization_mode="vector_entry_point", disturb={"tap_rate": 20.0, "tap_torque": 5.0})
    seen, _ = envs.reset(seed=2)
    for action in np.sign(actions(1500, 8)):
        seen, rewards, *_ = envs.step(action)
        assert np.isfinite(seen).all()
        assert np.isfinite(rewards).all()


def test_an_arm_that_turns_too_far_ends_its_episode() -> None:
    env = make()
    env.reset(seed=0)
    for _ in range(999):
        _, reward, terminated, truncated, info = env.step(np.ones(1))
        if terminated:
            break
    assert terminated
    assert not truncated
    assert abs(info["hub_angle"]) > np.pi
    assert info["reward_failure"] == -100.0
    assert reward == pytest.approx(sum(value for name, value in info.items() if name.startswith("reward_")))


def test_observations_are_the_readings_of_the_rig() -> None:
    env = make(physical=True)
    readings, truth = [], []
    env.reset(seed=0)
    for _ in range(600):
        seen, *_, info = env.step(np.zeros(1))
        readings.append(seen)
        truth.append(info["hub_angle"])
    readings = np.array(readings, dtype=float)
    sensors = Arm.load("thesis").sensors
    for column, sensor in enumerate(sensors.values()):  # at rest at zero: all that is seen is noise in steps
        steps = readings[:, column] / sensor["resolution"]
        assert np.allclose(steps, np.rint(steps), atol=1e-3)
        assert readings[:, column].std() == pytest.approx(np.hypot(sensor["noise"], sensor["resolution"] / 12**0.5), rel=0.15)
    assert np.abs(np.corrcoef(readings[:, :4].T) - np.eye(4)).max() < 0.2
    assert readings[0, 4] == np.float32(np.deg2rad(100.0))
    assert truth[-1] == 0.0


def test_a_late_sensor_shows_what_was() -> None:
    arm = Arm.load("thesis").with_values({f"sensors.{s}.{key}": 0.0 for s in Arm.load("thesis").sensors for key in QUIET})
    late = arm.with_values({"sensors.arm_angle.delay": 0.0175})  # 3.5 samples
    prompt, delayed = make(arm=arm, physical=True), make(arm=late, physical=True)
    prompt.reset(seed=0)
    delayed.reset(seed=0)
    seen = np.array([[env.step(np.full(1, 0.4))[0] for _ in range(40)] for env in (prompt, delayed)])[:, :, 0]
    assert seen[1, 10:] == pytest.approx(0.5 * (seen[0, 7:-3] + seen[0, 6:-4]), abs=1e-6)


QUIET = ("noise", "resolution")


def test_the_physics_is_that_of_simulate() -> None:
    arm = Arm.load("thesis").with_values({f"sensors.{s}.{key}": 0.0 for s in Arm.load("thesis").sensors for key in QUIET})
    recording = flexarm_env.simulate(arm, "pulse", duration=2.0, rate=200.0, noise=False)
    env = make(arm=arm, physical=True)
    seen = [env.reset(seed=0)[0]]
    seen += [env.step(np.array([command / 5.0]))[0] for command in recording.command[:-1]]
    for column, signal in enumerate(arm.signals):
        assert np.array(seen)[:, column] == pytest.approx(recording.signals[signal], rel=1e-6, abs=1e-6)


def test_a_corrected_arm_is_an_environment(tmp_path) -> None:
    path = tmp_path / "corrected.toml"
    Arm.load("thesis-fem").with_effect("backlash", gap=0.02).with_effect("input_delay", delay=0.012).save(path)
    env = make(arm=str(path), prior="thesis")
    env.reset(seed=0)
    for _ in range(50):
        seen, *_ = env.step(np.full(1, 0.5))
    assert np.isfinite(seen).all()
    assert env.unwrapped.prior.name == "thesis"


def test_the_payload_is_drawn_for_each_episode() -> None:
    env = gym.make("FlexArm/Slew-Random-v0")
    env.reset(seed=4)
    masses = []
    for _ in range(200):
        masses.append(env.unwrapped.drawn_arm().effects["payload"]["mass"])
        env.reset()
    assert len(set(masses)) == 200
    assert 0.0 <= min(masses) < 0.02
    assert 0.28 < max(masses) <= 0.3
    assert np.mean(masses) == pytest.approx(0.15, abs=0.02)


def test_taps_move_the_arm_and_dropouts_hold_a_reading() -> None:
    env = make(disturb={"tap_rate": 2.0, "tap_torque": 2.0, "dropout_rate": 2.0, "dropout_time": 0.1})
    env.reset(seed=1)
    moved, held, last = 0, 0, None
    for _ in range(900):
        seen, _, terminated, _, info = env.step(np.zeros(1))
        moved += info["hub_speed"] != 0.0
        held += last is not None and bool((seen[:4] == last[:4]).any())
        last = seen
        assert not terminated
    assert moved > 20
    assert held > 100
