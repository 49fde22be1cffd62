"""Recordings made by an arm's model: the same bits from one seed, loops that replay to themselves, sensors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from work import calls

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.experiments.plans import SQUARE_ANGLE
from flexarm_env.experiments.simulate import simulate
from flexarm_env.recordings.recording import Recording
from flexarm_env.thesis_drive import DERIVATIVE, PROPORTIONAL

EXPERIMENTS = ("pulse", "square", "sweep")
RIGID = {
    "drive": {
        "input": "voltage",
        "torque_constant": 0.0107,
        "gear_ratio": 48.4,
        "motor_inertia": 1e-6,
        "resistance": 3.29,
        "limit": 10.0,
    },
    "hub": {"inertia": 0.0035},
    "sensors": {"arm_angle": {"noise": 0.001}, "motor_speed": {"noise": 0.05}},
    "effects": {"coulomb": {"torque": 0.02}},
}


@pytest.fixture(scope="module")
def arm() -> Arm:
    return Arm.load("thesis")


def rigid(**sensors: dict[str, float]) -> Arm:
    return Arm.from_table({**RIGID, "sensors": sensors or RIGID["sensors"]}, "rigid")


def bits(recording: Recording) -> list[bytes]:
    return [recording.time.tobytes(), recording.command.tobytes(), *(v.tobytes() for v in recording.signals.values())]


def with_sensors(arm: Arm, **settings: float) -> Arm:
    return replace(arm, sensors={signal: {**table, **settings} for signal, table in arm.sensors.items()})


@pytest.mark.parametrize("experiment", EXPERIMENTS)
def test_one_seed_gives_the_same_bits(arm, experiment):
    first, again, other = (simulate(arm, experiment, duration=2.0, seed=seed) for seed in (3, 3, 4))
    assert bits(first) == bits(again)
    assert bits(first) != bits(other)


def test_experiments_of_one_seed_have_noise_of_their_own(arm):
    still = replace(arm, constants={**arm.constants, "drive": {**arm.constants["drive"], "limit": 1e-9}})
    runs = [simulate(with_sensors(still, resolution=0.0), e, duration=2.0) for e in EXPERIMENTS]
    noise = np.array([run.signals["arm_angle"] for run in runs])
    assert np.abs(np.corrcoef(noise) - np.eye(3)).max() < 0.15


def test_a_sensor_more_leaves_the_noise_of_the_others(arm):
    fewer = replace(arm, sensors={s: table for s, table in arm.sensors.items() if s != "strain_mid"})
    one, two = simulate(arm, "pulse", duration=1.0), simulate(fewer, "pulse", duration=1.0)
    assert all((one.signals[s] == two.signals[s]).all() for s in fewer.signals)


def test_noise_and_steps_are_those_of_the_sensors(arm):
    run = simulate(arm, "pulse", duration=0.4, rate=5000.0)  # at rest until 0.5 s
    for signal, sensor in arm.sensors.items():
        steps = run.signals[signal] / sensor["resolution"]
        assert np.abs(steps - np.round(steps)).max() < 1e-9
        spread = np.hypot(sensor["noise"], sensor["resolution"] / np.sqrt(12.0))
        assert run.signals[signal].std() == pytest.approx(spread, rel=0.06)
        assert not np.signbit(run.signals[signal][run.signals[signal] == 0.0]).any()


def test_the_first_pulse_is_the_thesis_s(arm):
    run = simulate(arm, "pulse", duration=2.0)
    on = (run.time >= 0.5 - 1e-9) & (run.time < 1.0 - 1e-9)
    assert (run.command[on] == 3.0).all()
    assert (run.command[~on] == 0.0).all()
    assert run.reference is None
    clean = simulate(Arm.load("thesis"), "pulse", duration=2.5, noise=False)
    assert np.rad2deg(clean.signals["arm_angle"][-1]) == pytest.approx(157.9, abs=0.2)  # notes on the thesis, section 4


def test_later_pulses_vary_and_change_sign(arm):
    commands = [simulate(arm, "pulse", seed=seed, noise=False).command for seed in (0, 1)]
    assert (commands[0] != commands[1]).any()
    for command in commands:
        assert command.max() > 0.0 > command.min()


@pytest.mark.parametrize("experiment", ["square", "sweep"])
def test_the_command_is_pd_on_the_readings_within_the_limit(arm, experiment):
    run = simulate(arm, experiment, duration=6.0)
    assert run.reference is not None
    limit = arm.constants["drive"]["limit"]
    assert np.abs(run.command).max() <= limit
    error = run.reference - run.signals["arm_angle"]
    pd = PROPORTIONAL * error - DERIVATIVE * run.signals["motor_speed"]
    if experiment == "square":
        assert run.command == pytest.approx(np.clip(pd, -limit, limit), abs=1e-12)
        assert run.reference[0] == SQUARE_ANGLE == -run.reference[1300]
    else:
        feed = (run.command - pd)[np.abs(run.command) < limit]
        assert 0.5 < feed.std() < 3.0


@pytest.mark.parametrize("experiment", EXPERIMENTS)
def test_a_loop_replays_to_itself(arm, experiment):
    run = simulate(arm, experiment, duration=3.0, noise=False)
    assert bits(simulate(arm, run, noise=False)) == bits(run)


@pytest.mark.parametrize("offset", [-0.013, -0.004, 0.004, 0.0131])
def test_a_loop_replays_to_itself_when_clocks_differ(arm, offset):
    late = arm.with_effect("time_offset", offset=offset)
    run = simulate(late, "square", duration=3.0, noise=False)
    again = simulate(late, run, noise=False)
    # What answers the last commands of all lies beyond a recording whose readings are early.
    kept = slice(None, -10)
    assert all((again.signals[s][kept] == run.signals[s][kept]).all() for s in arm.signals)


def test_a_dead_time_shifts_readings(arm):
    late, half = with_sensors(arm, delay=0.01), with_sensors(arm, delay=0.011)
    now, then, between = (simulate(a, "pulse", duration=2.0, noise=False).signals["arm_angle"] for a in (arm, late, half))
    assert (then[5:] == now[:-5]).all()
    assert (then[:5] == now[0]).all()
    assert between[6:] == pytest.approx(0.5 * (now[:-6] + now[1:-5]), abs=1e-15)


def test_a_recording_s_commands_are_played_at_its_times(arm):
    steps = np.tile([0.002, 0.003, 0.0015], 400)
    times = np.concatenate([[0.0], np.cumsum(steps)])
    command = np.where(times < 0.6, 2.0, 0.0)
    given = Recording.from_arrays("mine", times, "current", command, {"arm_angle": np.zeros_like(times)})
    run = simulate(arm, given, noise=False)
    assert run.name == "mine"
    assert (run.time == given.time).all()
    assert (run.command == command).all()
    grid = np.arange(0.0, times[-1], 0.0005)
    held = command[np.searchsorted(times, grid + 1e-9) - 1]
    fine = Recording.from_arrays("fine", grid, "current", held, {"arm_angle": 0 * grid})
    expected = np.interp(times, grid, simulate(arm, fine, noise=False).signals["arm_angle"])
    assert run.signals["arm_angle"] == pytest.approx(expected, abs=1e-4)


def test_a_file_serves_as_input(arm, tmp_path):
    run = simulate(arm, "square", duration=1.0, noise=False)
    run.write(tmp_path / "run.csv")
    assert bits(simulate(arm, str(tmp_path / "run.csv"), noise=False)) == bits(run)


def test_a_file_of_commands_alone_serves_as_input(arm, tmp_path):
    run = simulate(arm, "square", duration=1.0, noise=False)
    rows = "".join(f"{t!r},{1000.0 * i!r}\n" for t, i in zip(run.time.tolist(), run.command.tolist(), strict=True))
    (tmp_path / "commands.csv").write_text("time [s],current [mA]\n" + rows)
    made = simulate(arm, tmp_path / "commands.csv", noise=False)
    assert made.command == pytest.approx(run.command, rel=1e-15)
    assert list(made.signals) == arm.signals
    assert all(made.signals[s] == pytest.approx(run.signals[s], abs=1e-9) for s in arm.signals)
    with pytest.raises(InputError, match="no measured signal"):
        Recording.read(tmp_path / "commands.csv")


@pytest.mark.parametrize("experiment", EXPERIMENTS)
def test_another_drive_gets_commands_of_its_own_size(experiment):
    run = simulate(rigid(), experiment, duration=5.0)
    assert run.input_kind == "voltage"
    assert 3.0 < np.abs(run.command).max() <= 10.0
    assert np.ptp(run.signals["arm_angle"]) > 0.5


def test_speed_comes_from_the_angle_where_there_is_no_tachometer():
    with_tach, without = rigid(), rigid(arm_angle={"noise": 0.0})
    ends = [simulate(a, "square", duration=2.4, noise=False).signals["arm_angle"][-1] for a in (with_tach, without)]
    assert ends[0] == pytest.approx(ends[1], abs=0.05)


def test_what_does_not_fit_is_refused(arm, tmp_path):
    blind = rigid(motor_speed={"noise": 0.1})
    simulate(blind, "pulse", duration=0.1)
    volts = simulate(blind, "pulse", duration=0.1)
    for made, words in (
        (lambda: simulate(blind, "square"), "arm_angle"),
        (lambda: simulate(arm, volts), "driven by current"),
        (lambda: simulate(arm, "pluse"), "did you mean 'pulse'"),
        (lambda: simulate(arm, tmp_path / "no.csv"), "no.csv"),
        (lambda: simulate(arm, duration=-1.0), "positive"),
        (lambda: simulate(arm, rate=float("nan")), "positive"),
        (lambda: simulate(arm, duration=1e9), "samples"),
        (lambda: simulate(arm, duration=1e-9), "samples"),
    ):
        with pytest.raises(InputError, match=words):
            made()


def test_a_sample_in_closed_loop_takes_a_few_calls(arm):
    samples = len(simulate(arm, "square", duration=1.0))  # compiles
    more = calls(lambda: simulate(arm, "square", duration=3.0)) - calls(lambda: simulate(arm, "square", duration=1.0))
    assert more < 20 * 2 * samples
