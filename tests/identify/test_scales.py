"""A typical size does the same to machines of any size: its torque is the same share of the drive's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flexarm_env import Arm, Recording
from flexarm_env.identify.replay.dataset import Dataset, prepare
from flexarm_env.identify.select.starts import starts_of

TIME = np.arange(0.0, 4.0, 0.01)


def recorded(length: float, current: float, angle: float) -> tuple[Arm, Dataset]:
    """An arm of a length [m], driven by currents [A] through angles [rad]."""
    arm = Arm.load("thesis-fem").with_values({"beam.length": length})
    signals = {"arm_angle": angle * np.sin(2.0 * TIME), "motor_speed": 2.0 * angle * np.cos(2.0 * TIME)}
    run = Recording.from_arrays("run", TIME, "current", current * np.sign(np.sin(2.0 * TIME)), signals)
    return prepare(arm, [run])


def sizes(length: float, current: float, angle: float) -> dict[str, float]:
    """Sizes of such an arm."""
    return dict(recorded(length, current, angle)[1].scales)


@pytest.mark.parametrize("angle", [0.01, 1.0, 40.0])
def test_stops_are_tried_within_the_travel_of_a_machine_of_any_size(angle):
    arm, dataset = recorded(1.0, 1.0, angle)
    places = [start["upper"] / angle for start in starts_of(arm, "end_stop", dataset)]
    assert places == pytest.approx([0.24, 0.48, 0.96], rel=0.01)  # 0.3, 0.6 and 1.2 rad of the 1.25 rad of the thesis's arm


def test_stops_and_a_cables_rest_are_tried_around_the_middle_of_the_travel():
    arm, dataset = recorded(1.0, 1.0, 1.0)
    aside = replace(dataset, runs=tuple(replace(run, measured=run.measured + np.array([3.0, 0.0])) for run in dataset.runs))
    for effect, place in (("end_stop", "upper"), ("end_stop", "lower"), ("cable_stiffness", "rest_angle")):
        pairs = zip(starts_of(arm, effect, dataset), starts_of(arm, effect, aside), strict=True)
        assert all(moved[place] - start[place] == pytest.approx(3.0) for start, moved in pairs)


def shares(scales: dict[str, float], length: float) -> dict[str, float]:
    """Torque [Nm] of each kind of effect of typical size, at the speed and angle of the data, over the drive's."""
    speed, angle, torque = scales["rad/s"], 1.0 / scales["1/rad"], scales["N*m"]
    return {
        "viscous": scales["N*m*s"] * speed / torque,
        "spring": scales["N*m/rad"] * angle / torque,
        # the drag on a length dx at a distance x is c (x ω)² dx, so its torque is c ω² L⁴ / 4
        "drag": scales["N*s**2/m**3"] * speed**2 * length**4 / torque,
        # a body of m at the tip has the inertia m L²
        "payload": scales["kg"] * length**2 / scales["kg*m**2"],
    }


@pytest.mark.parametrize(("length", "current", "angle"), [(2.0, 1.0, 1.0), (1.0, 3.0, 1.0), (1.0, 1.0, 0.4), (1.3, 0.5, 1.7)])
def test_a_typical_effect_is_the_same_share_of_the_drive_at_any_size(length, current, angle):
    expected = shares(sizes(1.0, 1.0, 1.0), 1.0)
    assert shares(sizes(length, current, angle), length) == pytest.approx(expected, rel=1e-9)


def test_sizes_follow_the_machine():
    one, longer, stronger, wider = sizes(1.0, 1.0, 1.0), sizes(2.0, 1.0, 1.0), sizes(1.0, 3.0, 1.0), sizes(1.0, 1.0, 0.5)
    assert longer["kg*m**2"] > 4.0 * one["kg*m**2"]
    assert stronger["N*m"] == pytest.approx(3.0 * one["N*m"])
    assert wider["rad/s"] == pytest.approx(0.5 * one["rad/s"])
