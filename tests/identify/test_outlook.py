"""What could still hide in recordings, and the run to record next."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from flexarm_env import Arm, Recording, fit, simulate
from flexarm_env.experiments.next_run import propose
from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.explain.detection_limits import DetectionLimit, detection_limits
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.select.effect_size import EffectSize
from flexarm_env.identify.settings import SETTINGS

LEAST = SETTINGS.selecting.least_removed


@pytest.fixture(scope="module")
def arm() -> Arm:
    return Arm.load("thesis")


def recorded(arm: Arm) -> list[Recording]:
    return [simulate(arm, "square", duration=6.0, rate=200.0, seed=3), simulate(arm, "pulse", duration=6.0, rate=200.0, seed=4)]


@pytest.fixture(scope="module")
def hidden(arm) -> dict[str, DetectionLimit]:
    calibrator = Calibrator(*prepare(arm, recorded(arm)))
    return detection_limits(calibrator, calibrator.uncalibrated(calibrator.nominal))


@pytest.mark.parametrize("name", ["constant_torque", "tach_filter"])
def test_a_third_of_what_could_hide_does_and_thrice_as_much_does_not(arm, hidden, name):
    errors = []
    for factor in (1.0 / 3.0, 3.0):
        machine = arm.with_effect(name, **{hidden[name].parameter: factor * hidden[name].value})
        errors.append(fit(arm, recorded(machine)).error["refitted"])
    weak, strong = (error**2 - 1.0 for error in errors)
    assert weak < LEAST < strong


def test_few_steps_end_near_where_many_do(arm, hidden, monkeypatch):
    monkeypatch.setattr(EffectSize, "is_near", lambda size, other: abs(np.log(size.multiple / other.multiple)) < 0.03)
    settings = replace(SETTINGS, detection=replace(SETTINGS.detection, steps=10, window_steps=25))
    calibrator = Calibrator(*prepare(arm, recorded(arm), settings))
    found = detection_limits(calibrator, calibrator.uncalibrated(calibrator.nominal))
    both = hidden.keys() & found.keys()
    factors = np.array([abs(np.log(hidden[name].value / found[name].value)) for name in both])
    assert len(both) > 30
    assert np.median(factors) < 0.1
    assert np.quantile(factors, 0.9) < np.log(2.0)


@given(
    square=st.floats(0.0, 1e12),
    linear=st.floats(-1e6, 1e6),
    below=st.floats(0.0, 1.0),
    above=st.floats(1.0, 1e6) | st.just(np.inf),
    multiple=st.floats(1e-12, 1e6),
)
@example(square=9.258170937565495e-10, linear=0.19999999917875846, below=0.0, above=17.6, multiple=2.53e-5)
def test_a_step_goes_towards_what_is_wanted_between_sizes_that_are_known(square, linear, below, above, multiple):
    base = SimpleNamespace(objective=SimpleNamespace(dataset=SimpleNamespace(settings=SETTINGS)))
    size = EffectSize(base, "coulomb", {}, multiple, below * multiple, above * multiple)
    found = size.stepped(LEAST, square, linear)
    too_small = square + linear < LEAST
    assert found.low <= found.multiple <= found.high
    assert found.multiple > 0.0
    assert found.multiple >= multiple * (1.0 - 1e-9) if too_small else found.multiple <= multiple


def test_the_next_run_tells_apart_what_no_creeping_shows(arm):
    lag, offset = arm.with_effect("current_lag", time=0.01), arm.with_effect("input_delay", delay=0.01)
    found = propose({"current_lag": lag, "input_delay": offset}, 0.005)
    assert found is not None
    assert found.separates == ("current_lag", "input_delay")
    limit = arm.constants["drive"]["limit"]
    assert np.abs(found.command).max() <= limit
    played = Recording.from_arrays("next", found.time, found.input_kind, found.command, {}, require_signal=False)
    noise = [np.hypot(s["noise"], s["resolution"] / np.sqrt(12.0)) for s in arm.sensors.values()]
    runs = [np.stack(list(simulate(a, played, noise=False).signals.values()), axis=1) / noise for a in (lag, offset)]
    assert np.sqrt(np.mean((runs[0] - runs[1]) ** 2)) == pytest.approx(found.difference)
    assert f"{found.difference:.2g} × the noise" in found.why


def test_with_nothing_to_decide_it_is_the_run_that_shows_most(arm):
    found = propose({"": arm}, 0.005)
    assert found is not None
    assert found.separates == ()
    assert "breaks away" in found.why
