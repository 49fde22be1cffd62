"""Recordings that do not start at rest: an arm that is known must meet them from their first sample on."""

from __future__ import annotations

import numpy as np
import pytest

from flexarm_env import Arm, Recording, compare, simulate
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.initial_state import find_start
from flexarm_env.identify.replay.replay import replay
from flexarm_env.identify.replay.start_fit import _mode_directions
from flexarm_env.identify.settings import SETTINGS
from flexarm_env.plant.plant import Plant
from flexarm_env.thesis.arms import motor_alone

PULSE_ENDS = 1.0  # [s], of simulate's first pulse
NOISE = np.array([2e-3, 0.03, 1e-2, 1e-2])
SIGNALS = ["arm_angle", "motor_speed", "strain_mid", "strain_base"]


def cut(recording: Recording, first: float, signals: list[str] | None = None) -> Recording:
    later = recording.time >= first
    kept = {name: values[later] for name, values in recording.signals.items() if signals is None or name in signals}
    return Recording.from_arrays(
        recording.name, recording.time[later] - recording.time[later][0], recording.input_kind, recording.command[later], kept
    )


def error(arm: Arm, recording: Recording) -> float:
    rows = compare(arm, [recording]).rows
    return max(row.free_run for row in rows if row.part == "all")


@pytest.mark.parametrize("name", ["thesis", "thesis-fem"])
@pytest.mark.parametrize("first", [0.7, 0.95, 2.4])  # driven, driven at speed, stuck and vibrating
def test_a_known_arm_is_met_from_wherever_the_recording_starts(name: str, first: float) -> None:
    arm = Arm.load(name)
    recording = cut(simulate(arm, "pulse", duration=3.0), first)
    assert error(arm, recording) < 1.8


def test_the_speed_at_the_start_is_found_without_a_tachometer() -> None:
    arm = Arm.load("thesis")
    recording = cut(simulate(arm, "pulse", duration=3.0), 0.9, ["arm_angle", "strain_base"])
    assert error(arm, recording) < 1.8


def test_an_arm_that_is_driven_at_once_starts_at_rest() -> None:
    time = np.arange(200) / 500.0
    measured = np.column_stack([4.0 * time**2, 12.0 * time, 2.0 * (1.0 - np.cos(60.0 * time)), 3.0 * (1.0 - np.cos(60.0 * time))])
    start = find_start(time, np.ones(200), measured, SIGNALS, NOISE, SETTINGS.initial_states)
    assert (start.angle, start.speed, start.moving, start.vibrating) == (0.0, 0.0, False, False)


def test_an_offset_of_a_gage_is_no_vibration() -> None:
    time = np.arange(200) / 500.0
    draw = np.random.default_rng(0)
    measured = NOISE * draw.standard_normal((200, 4)) + np.array([0.5, 0.0, 0.3, -0.2])
    start = find_start(time, np.ones(200), measured, SIGNALS, NOISE, SETTINGS.initial_states)
    assert start.angle == pytest.approx(0.5, abs=1e-3)
    assert not start.moving
    assert not start.vibrating


@pytest.mark.parametrize(("driven_from", "ringing"), [(0.4, 0.0), (0.0, 0.0), (0.4, 0.05)])
def test_the_beam_of_a_driven_arm_is_no_vibration_at_the_start(driven_from: float, ringing: float) -> None:
    """A push bends the beam before the hub has left its place; a beam that rings did so before the first command."""
    time = np.arange(400) / 500.0
    strain = np.where(time > 0.4, 3.0 * (1.0 - np.cos(60.0 * (time - 0.4))), 0.0) + ringing * np.cos(60.0 * time)
    angle = 4.0 * np.maximum(time - 0.42, 0.0) ** 2
    measured = np.column_stack([angle, np.zeros(400), strain, strain])
    command = np.where(time >= driven_from, 1.0, 0.0)
    start = find_start(time, command, measured, SIGNALS, NOISE, SETTINGS.initial_states)
    assert start.vibrating == (driven_from == 0.0 or ringing > 0.0)
    assert start.samples == (201 if driven_from else 246)
    assert not start.moving


@pytest.mark.parametrize("signals", [SIGNALS, [s for s in SIGNALS if s != "motor_speed"]])
@pytest.mark.parametrize("offset", [0.05, 0.3])
def test_an_offset_of_a_gage_is_no_motion_of_an_arm_that_is_driven_at_once(offset: float, signals: list[str]) -> None:
    times = 0.002 * np.arange(1500)
    push = Recording.from_arrays("push", times, "current", np.where(times < 0.5, -2.0, 1.0), {}, require_signal=False)
    offsets = dict.fromkeys(SIGNALS, 0.0) | {"strain_mid": offset}
    arm = Arm.load("thesis").with_effect("sensor_offset", **offsets)
    nominal, data = prepare(arm, [cut(simulate(arm, push, seed=1), 0.0, signals)])
    (run,) = data.runs
    assert not run.start.moving
    plant = data.plants(nominal)[run.stated]
    stretch = data.stretch(run)
    stretch.place(plant, stretch.fit(plant))
    assert not np.any(plant.physical())


@pytest.mark.parametrize(("effect", "value"), [("input_delay", {"delay": 0.003}), ("rate_limit", {"rate": 300.0})])
def test_no_command_acts_before_the_first_where_the_arm_rests(effect, value) -> None:
    """At rest, a first command of 2 A was not there before: what is late meets the arm late."""
    arm = Arm.load("thesis").with_effect(effect, **value)
    current = np.concatenate([np.full(150, 2.0), np.zeros(250)])
    times = 0.005 * np.arange(len(current))
    given = Recording.from_arrays("push", times, "current", current, {}, require_signal=False)
    assert error(arm, simulate(arm, given)) < 1.2


@pytest.mark.parametrize(("effect", "value"), [("input_delay", {"delay": 0.0025}), ("time_offset", {"offset": 0.0025})])
def test_no_command_acts_before_the_first_of_an_arm_that_leaves_at_once(effect, value) -> None:
    """A quick axis, whose angle alone is measured, moves by many counts between two samples: it seems to have moved before."""
    drive = {"input": "torque", "limit": 4.0, "gear_ratio": 1.0}
    axis = {"drive": drive, "hub": {"inertia": 2e-3}, "sensors": {"arm_angle": {"resolution": 1e-4, "noise": 1e-4}}}
    arm = Arm.from_table(axis | {"effects": {"viscous": {"coefficient": 0.005}}}, "axis").with_effect(effect, **value)
    time = np.arange(0.0, 4.0, 0.008)
    command = 0.7 * np.cos(2.0 * np.pi * 0.9 * time)
    asked = Recording.from_arrays("run", time, "torque", command, {"arm_angle": np.zeros(len(time))})
    recording = simulate(arm, asked, seed=1)
    _, data = prepare(arm, [recording])
    assert data.runs[0].start.moving
    assert error(arm, recording) < 1.3


def test_a_tachometer_alone_shows_that_the_arm_moves_at_the_start() -> None:
    arm = motor_alone()
    assert error(arm, cut(simulate(arm, "pulse", duration=3.0), 0.9, ["motor_speed"])) < 1.5


def test_a_start_is_found_however_slow_the_sampling() -> None:
    """A quarter of a second apart, no sample but the first lies in the stretch to which a start is otherwise fitted."""
    arm, times = motor_alone(), 0.25 * np.arange(80)
    given = Recording.from_arrays("steady", times, "current", np.full(80, 0.4), {}, require_signal=False)
    assert error(arm, cut(simulate(arm, given), 3.0, ["motor_speed"])) < 1.5


def changed(arm: Arm, share: float) -> Arm:
    names = ["drive.torque_constant", "hub.inertia", *(["beam.bending_stiffness"] if arm.has("beam") else [])]
    return arm.with_values({name: arm.value(name) * (1.0 + share) for name in names})


@pytest.mark.parametrize(("name", "first"), [("thesis", 0.95), ("cu-flexible", 0.7), ("cu-rigid", 0.95)])
def test_a_start_follows_the_constants_as_well_as_if_it_were_fitted_anew(name: str, first: float) -> None:
    arm = Arm.load(name)
    arm = arm if arm.effects else arm.with_effect("coulomb", torque=0.03)
    arm, data = prepare(arm, [cut(simulate(arm, "pulse", duration=3.0), first)])
    (run,) = data.runs
    stretch = data.stretch(run)
    kept = stretch.fit(changed(arm, -0.02).plant(data.interval))
    plant = arm.plant(data.interval)

    def left(start) -> float:
        count = run.start.samples
        errors = run.errors(replay(plant, run, data, start=start), data.noise)[:count]
        return float(np.sum(errors**2))

    anew = left(stretch.fit(plant))
    assert left(kept) > 2.0 * anew
    assert left(stretch.follow(plant, kept)) < 1.05 * anew


def test_a_start_that_is_carried_along_takes_few_replays(monkeypatch) -> None:
    arm = Arm.load("thesis-fem")
    arm, data = prepare(arm, [cut(simulate(arm, "pulse", duration=3.0), 0.95)])
    (run,) = data.runs
    stretch = data.stretch(run)
    fitted = stretch.fit(arm.plant(data.interval))
    played, play = [], Plant.play
    monkeypatch.setattr(Plant, "play", lambda *arguments: played.append(1) or play(*arguments))
    stretch.follow(changed(arm, 1e-3).plant(data.interval), fitted)
    assert 2 <= len(played) <= 4


def test_shapes_of_modes_keep_their_sign() -> None:
    arm = Arm.load("thesis-fem")
    plants = [changed(arm, share).plant(0.002) for share in np.linspace(-0.5, 1.0, 40)]
    tips = np.array([_mode_directions(plant, 4)[0::2, len(plant.model.names) - 2] for plant in plants])
    assert (tips > 0.0).all()
