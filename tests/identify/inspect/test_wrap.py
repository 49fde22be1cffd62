"""A wrap of any modulus is found, and undone."""

from __future__ import annotations

import math
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from flexarm_env import Arm, Recording, inspect_recordings, simulate
from flexarm_env.identify.inspect.inspection import reading_faults
from flexarm_env.identify.inspect.series import Inspected

CU = Arm.load("cu-rigid")
TIME = np.arange(0.0, 4.0, 0.004)
FEW = 3


def swinging(amplitude: float, rate: float, noise: float, step: float) -> Recording:
    angle = amplitude * np.sin(rate * TIME) + 0.3 * amplitude * TIME
    angle += np.random.default_rng(0).normal(0.0, noise, len(TIME))
    coarse = np.round(angle / step) * step if step else angle
    return Recording.from_arrays("run", TIME, "voltage", np.sin(TIME), {"arm_angle": coarse})


def wrapped(recording: Recording, modulus: float, low: float) -> Recording:
    angle = recording.signals["arm_angle"]
    return replace(recording, signals={"arm_angle": low + np.mod(angle - low, modulus)})


@given(
    amplitude=st.floats(0.5, 50.0),
    share=st.floats(0.2, 0.9),
    start=st.floats(0.1, 0.9),
    rate=st.floats(0.5, 4.0),
    noise=st.floats(0.0, 0.002),
)
def test_a_wrap_of_any_modulus_is_found_and_undone(amplitude, share, start, rate, noise):
    sound = swinging(amplitude, rate, noise * amplitude, 0.0)
    angle = sound.signals["arm_angle"]
    modulus = share * float(np.ptp(angle))
    assume(np.abs(np.diff(angle)).max() < 0.2 * modulus)
    turns = np.floor((angle - angle.min()) / modulus - start)
    assume(np.diff(np.flatnonzero(np.diff(turns))).min(initial=len(turns)) > FEW)  # fewer readings beyond it are spikes
    (fault,), mended = reading_faults(CU, Inspected.of(wrapped(sound, modulus, float(angle.min()) + start * modulus)))
    assert (fault.kind, fault.signal) == ("wrap", "arm_angle")
    assert fault.value == pytest.approx(modulus, rel=0.02)
    off = mended.signals["arm_angle"] - angle
    turns = len(fault.rows) * abs(fault.value - modulus)
    assert np.ptp(off) <= turns + 1e-6 * modulus


@pytest.mark.parametrize("low", [-math.pi, 0.0])
def test_an_angle_within_a_turn_is_named_as_that(low):
    """From 0 to 2π it flickers between both ends while it rests at 0."""
    sound = swinging(4.0, 1.5, 0.002, 0.001)
    (fault,) = inspect_recordings(CU, [wrapped(sound, math.tau, low)]).faults
    assert (fault.kind, fault.value) == ("wrap", math.tau)
    assert fault.hint == 'arm_angle = { wrap = "6.2831853 rad" }'


def test_a_single_step_to_another_run_is_no_wrap(thesis, pulse, square):
    assert abs(pulse.signals["arm_angle"][-1]) > 0.5
    signals = {name: np.r_[values, square.signals[name]] for name, values in pulse.signals.items()}
    time = np.r_[pulse.time, pulse.duration + 0.002 + square.time]
    both = Recording.from_arrays("both", time, "current", np.r_[pulse.command, square.command], signals)
    assert [fault.kind for fault in inspect_recordings(thesis, [both]).faults] == ["glued"]


@pytest.mark.parametrize(
    ("per_radian", "modulus"),
    [(4096 * 48.4 / math.tau, 2.0**16), (math.degrees(10.0), 360.0)],
    ids=["counts", "degrees"],
)
def test_a_counter_has_one_line_for_its_modulus_and_its_factor(tmp_path, per_radian, modulus):
    """The modulus is in SI, after the scale: two lines, each right by itself, would be wrong together."""
    arm = Arm.load("cu-rigid")
    sound = simulate(arm, "square", duration=6.0, seed=1)
    counted = np.mod(np.round(per_radian * sound.signals["arm_angle"], 1) + 0.9 * modulus, modulus)
    faulty = replace(sound, signals=sound.signals | {"arm_angle": counted})
    wrap, factor = inspect_recordings(arm, [faulty]).faults
    assert (wrap.kind, wrap.value, factor.kind) == ("wrap", modulus, "factor")
    assert wrap.hint == factor.hint
    columns = tomllib.loads(wrap.hint)
    faulty.write(tmp_path / "run.csv")
    assert not inspect_recordings(arm, [Recording.read(tmp_path / "run.csv", columns)]).faults
