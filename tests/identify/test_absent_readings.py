"""A reading that is absent weighs nothing, is not counted, and corrects nothing."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flexarm_env import Arm, Recording, compare, diagnose, fit, simulate
from flexarm_env.errors import InputError
from flexarm_env.identify.explain.hub_torque import hub_torque
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.error_measure import score
from flexarm_env.identify.replay.observer import observer_gains
from flexarm_env.identify.replay.preflight import preflight
from flexarm_env.identify.replay.readings import bounded
from flexarm_env.identify.replay.replay import replay
from flexarm_env.identify.settings import FAILED_ERROR

RATE = 500.0


@pytest.fixture(scope="module")
def arm() -> Arm:
    return Arm.load("thesis-fem")


@pytest.fixture(scope="module")
def run(arm) -> Recording:
    return simulate(arm, "square", duration=3.0, rate=RATE, seed=3)


def masked(recording: Recording, absent: dict[str, np.ndarray]) -> Recording:
    """The recording without the readings that are marked, by signal."""
    signals = {name: np.where(absent.get(name, False), np.nan, values) for name, values in recording.signals.items()}
    return replace(recording, signals=signals)


def slow(recording: Recording, names: tuple[str, ...] = ("strain_mid", "strain_base"), every: int = 10) -> Recording:
    """The recording with some sensors at a lower rate."""
    return masked(recording, dict.fromkeys(names, np.arange(len(recording)) % every != 3))


def ignored(recording: Recording, names: tuple[str, ...], start: float, stop: float) -> Recording:
    return masked(recording, dict.fromkeys(names, (recording.time >= start) & (recording.time < stop)))


ALL = ("arm_angle", "motor_speed", "strain_mid", "strain_base")
CASES = {
    "slow strain": lambda r: slow(r),
    "slow angle": lambda r: slow(r, ("arm_angle",)),
    "all slow": lambda r: slow(r, ALL, every=5),
    "no angle in the first second": lambda r: ignored(r, ("arm_angle",), 0.0, 1.0),
    "no strain for a second": lambda r: ignored(r, ("strain_base",), 1.0, 2.0),
    "nothing in the first half second": lambda r: ignored(r, ALL, 0.0, 0.5),
    "nothing for half a second": lambda r: ignored(r, ALL, 1.0, 1.5),
    "nothing at the end": lambda r: ignored(r, ALL, 2.0, 9.0),
}


@pytest.mark.parametrize("case", CASES)
def test_the_right_arm_fits_to_its_noise(arm, run, case):
    recording = CASES[case](run)
    result = compare(arm, [recording])
    readings = sum(int(np.isfinite(values).sum()) for values in recording.signals.values())
    whole = result.rows[-1]
    assert whole.samples == readings
    within = 3.0 / np.sqrt(2.0 * readings) + 0.015
    assert result.error == pytest.approx(1.0, abs=within)
    assert result.free_run == pytest.approx(1.0, abs=within)
    for row in result.rows:
        if row.samples > 300 and row.signal in ALL:
            assert row.error == pytest.approx(1.0, abs=0.2), row
            assert not row.fit < 90.0


def test_a_slow_sensor_has_bands_up_to_half_its_own_rate(arm, run):
    bands = [row.part for row in compare(arm, [slow(run)]).rows if row.signal == "strain_base" and "Hz" in row.part]
    assert bands == ["0-2 Hz", "2-5 Hz", "5-15 Hz", "15-25 Hz"]


def test_readings_out_of_their_window_change_no_other_error(arm, run):
    """What another signal lacks late does not change the free run before."""
    whole, part = compare(arm, [run]), compare(arm, [ignored(run, ("strain_mid",), 1.0, 9.0)])
    for signal in ALL:
        assert np.array_equal(whole.replays[0].free[signal], part.replays[0].free[signal])
    row = next(r for r in part.rows if (r.signal, r.part) == ("strain_mid", "all"))
    first = run.time < 1.0
    off = (run.signals["strain_mid"] - whole.replays[0].free["strain_mid"])[first] / whole.noise["strain_mid"]
    assert row.samples == first.sum()
    assert row.free_run == pytest.approx(np.sqrt(np.mean(off**2)), rel=1e-12)


def test_an_absent_reading_corrects_nothing(arm, run):
    """Until a reading comes, a corrected replay is a free one, whatever the gains; then it is not."""
    reduced, data = prepare(arm, [ignored(run, ALL, 0.3, 1.0)])
    one, plant = data.runs[0], data.plants(reduced)[()]
    gains = observer_gains(reduced, plant, data, 0.05)
    dropped = prepare(arm, [ignored(run, ALL, 0.3, 9.0)])[1].runs[0]
    corrected, lost = replay(plant, one, data, gains), replay(plant, dropped, data, gains)
    assert np.isfinite(corrected).all()
    at = round(1.0 * RATE)
    assert np.array_equal(corrected[: at + 1], lost[: at + 1])
    assert not np.array_equal(corrected[at + 1 :], lost[at + 1 :])


@settings(max_examples=5, deadline=None)
@given(seed=st.integers(0, 10_000), share=st.floats(0.0, 0.6))
def test_whichever_readings_are_absent_the_error_stays_at_the_noise(arm, run, seed, share):
    absent = np.random.default_rng(seed).random(len(run)) < share
    result = compare(arm, [masked(run, {"motor_speed": absent})])
    count = len(run) - int(absent.sum())
    row = next(r for r in result.rows if (r.signal, r.part) == ("motor_speed", "all"))
    assert row.samples == count
    assert row.free_run == pytest.approx(1.0, abs=4.5 / np.sqrt(2.0 * count))


def test_nothing_masked_changes_no_bit(arm, run):
    whole, same = compare(arm, [run]), compare(arm, [masked(run, {"arm_angle": np.zeros(len(run), dtype=bool)})])
    assert [(row.error, row.free_run, row.samples) for row in same.rows if row.free_run == row.free_run] == [
        (r.error, r.free_run, r.samples) for r in whole.rows if r.free_run == r.free_run
    ]
    for signal in ALL:
        assert np.array_equal(whole.replays[0].windows[signal], same.replays[0].windows[signal])


def test_the_held_out_share_is_one_of_the_time_with_readings(arm, run):
    data = prepare(arm, [ignored(run, ALL, 0.0, 1.0)])[1]
    train = data.runs[0].train
    assert run.time[train][-1] == pytest.approx(1.0 + 0.65 * 2.0, abs=0.01)
    late = prepare(arm, [ignored(run, ALL, 1.0, 9.0)])[1]
    assert run.time[late.runs[0].train][-1] == pytest.approx(0.65, abs=0.01)
    assert late.readings(held_out=True) == pytest.approx(0.35 * 4 * RATE, abs=8)


def test_the_regime_comes_from_the_readings_that_there_are(arm, run):
    whole = compare(arm, [run]).replays[0].regime
    for recording in (slow(run, ("motor_speed",)), slow(run, ("arm_angle",))):
        assert np.mean(compare(arm, [recording]).replays[0].regime == whole) > 0.9


def test_too_few_readings_are_refused(arm, run):
    with pytest.raises(InputError, match=r"square has 25 samples with a reading of .*; at least 50 are needed"):
        prepare(arm, [ignored(run, ALL, 0.05, 9.0)])


def test_motion_that_was_not_measured_is_none(arm):
    pulse = simulate(arm, "pulse", duration=2.0, rate=RATE, seed=1)
    begins = float(pulse.time[np.argmax(np.abs(pulse.command) > 0.0)])
    assert begins > 0.2
    assert preflight(prepare(arm, [pulse])[1]).too_poor is False
    assert preflight(prepare(arm, [ignored(pulse, ALL, begins, 9.0)])[1]).too_poor is True


def test_the_torque_on_the_hub_is_estimated_from_what_there_is(arm, run):
    (whole,), (part,) = hub_torque(arm, [run]), hub_torque(arm, [slow(run)])
    assert np.isfinite(part.torque).all()
    assert np.sqrt(np.mean((part.torque - whole.torque) ** 2)) < 0.25 * np.std(whole.torque)


def test_a_failed_replay_is_a_large_error_and_no_infinite_one():
    found = bounded(np.array([np.nan, np.inf, -np.inf, 2.0]))
    assert found.tolist() == [FAILED_ERROR, FAILED_ERROR, -FAILED_ERROR, 2.0]


@pytest.mark.parametrize("every", [1, 5])
def test_innovations_of_the_right_arm_stay_below_their_standard_deviation(arm, every):
    """Between the readings of slow sensors the state grows uncertain, and so does the next innovation.

    The observer also allows for torques on the beam, which are not simulated, so the right arm stays below 1.
    """
    linear = arm.without_effect("stiction").without_effect("coulomb")
    shaken = linear.with_values({"drive.torque_noise": 0.02})
    runs = [simulate(shaken, "sweep", duration=4.0, rate=RATE, seed=seed) for seed in (1, 2)]
    reduced, data = prepare(shaken, [slow(one, ALL, every) if every > 1 else one for one in runs])
    wrong = reduced.with_values({"drive.torque_constant": 1.3 * reduced.value("drive.torque_constant")})
    for held_out in (False, True):
        assert 0.6 < score(reduced, data, held_out).windows < 1.02
        assert score(wrong, data, held_out).windows > 1.3


@pytest.fixture(scope="module")
def others(arm) -> list[Recording]:
    machine = arm.with_values({"beam.bending_stiffness": 0.9 * arm.value("beam.bending_stiffness")})
    return [simulate(machine, name, duration=4.0, rate=RATE, seed=5) for name in ("square", "sweep")]


@pytest.mark.slow(minutes=1)
@pytest.mark.parametrize("case", ["slow strain", "no angle in the first second"])
def test_a_fit_finds_the_constants(arm, others, case):
    recordings = [CASES[case](one) for one in others]
    found = fit(arm, recordings)
    truth = 0.9 * arm.value("beam.bending_stiffness")
    estimate = next(e for e in found.estimates if e.path == "beam.bending_stiffness")
    assert found.error["nominal"] > 2.0
    assert found.error["refitted"] < 1.1  # on what the fit had not seen, from 2.6 s
    assert compare(found.arm, recordings).error == pytest.approx(1.0, abs=0.03)
    assert estimate.low < truth < estimate.high
    assert estimate.value == pytest.approx(truth, rel=0.05)


@pytest.mark.slow(minutes=3)
def test_a_hidden_effect_is_named_with_a_slow_sensor(arm):
    machine = arm.with_effect("backlash", gap=0.05)
    runs = [slow(simulate(machine, name, duration=4.0, rate=RATE, seed=7)) for name in ("square", "sweep")]
    found = diagnose(arm, runs, jobs=1)
    assert found.verdict == "effects"
    assert found.effects == ["backlash"]
    gap = next(e for e in found.ranking[0].estimates if e.path.endswith("gap"))
    assert gap.value == pytest.approx(0.05, rel=0.1)


def test_a_file_with_empty_cells_is_compared_as_the_recording_is(arm, run, tmp_path: Path):
    recording = slow(run)
    recording.write(tmp_path / "square.csv")
    again = Recording.read(tmp_path / "square.csv")
    assert compare(arm, [again]).error == compare(arm, [recording]).error


@pytest.mark.parametrize(("first", "words"), [(0.001, "1 sample"), (0.003, "2 samples")])
def test_one_sample_is_not_samples(arm, run, first, words):
    with pytest.raises(InputError, match=f"square has {words} with a reading of"):
        prepare(arm, [ignored(run, ALL, first, 9.0)])
