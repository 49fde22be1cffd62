"""A beam in its slowest vibrations, against the whole one."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import eigh

from flexarm_env import Arm
from flexarm_env.plant.assembly import assemble
from flexarm_env.plant.reduction import beam_coordinates, reduce_beam, reduce_state
from flexarm_env.plant.structure import LinearModel

ARMS = ("thesis-fem", "cu-flexible")


def model_of(arm: Arm) -> LinearModel:
    return assemble(arm.structure())


def squares_of(model: LinearModel, hub_is_held: bool) -> np.ndarray:
    """Squared frequencies, of an arm whose motor is held, too, or free, without the gears between."""
    part = beam_coordinates(model) if hub_is_held else slice(0, None)
    return eigh(model.stiffness[part, part], model.mass[part, part], eigvals_only=True)


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("effects", [{}, {"payload": {"mass": 0.2}}, {"root_compliance": {"compliance": 0.01}}])
def test_vibrations_against_a_held_hub_are_kept_exactly_and_those_of_a_free_one_from_above(name, effects):
    arm = Arm.load(name)
    for effect, values in effects.items():
        arm = arm.with_effect(effect, **values)
    whole, kept = model_of(arm), 4
    reduced = reduce_beam(whole, kept)
    assert squares_of(reduced, True) == pytest.approx(squares_of(whole, True)[:kept], rel=1e-9)
    free, exact = squares_of(reduced, False)[-kept:], squares_of(whole, False)[-len(squares_of(whole, True)) :][:kept]
    assert (free >= exact * (1.0 - 1e-9)).all()  # Rayleigh's quotient over fewer shapes
    assert free[0] == pytest.approx(exact[0], rel=2e-3)


def test_a_rigid_turn_has_the_whole_inertia():
    whole = model_of(Arm.load("thesis-fem"))
    reduced = reduce_beam(whole, 1)
    turn = np.eye(len(whole.names))[:, 0]
    assert reduced.mass[0, 0] == pytest.approx(turn @ whole.mass @ turn, rel=1e-12)
    assert np.array_equal(reduced.stiffness[:, 0], np.zeros(len(reduced.names)))


@pytest.mark.parametrize("count", [12, 50])
def test_an_arm_with_no_more_vibrations_is_the_same_to_the_last_bit(count):
    whole = model_of(Arm.load("thesis-fem"))
    assert reduce_beam(whole, count) is whole


@given(place=st.integers(0, 3), size=st.floats(-0.05, 0.05), speed=st.floats(-1.0, 1.0))
def test_a_motion_of_slow_vibrations_keeps_its_readings(place, size, speed):
    whole = model_of(Arm.load("thesis-fem"))
    beam = beam_coordinates(whole)
    shape = eigh(whole.stiffness[beam, beam], whole.mass[beam, beam])[1][:, place]
    state = np.zeros(2 * len(whole.names))
    state[0] = 0.3
    state[: len(whole.names)][beam], state[len(whole.names) :][beam] = size * shape, speed * shape
    reduced = reduce_beam(whole, 4)
    readings = reduced.output @ reduce_state(whole, state, 4)
    assert readings == pytest.approx(whole.output @ state, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("name", ARMS)
def test_readings_come_near_those_of_the_whole_arm_with_each_vibration(name):
    arm, command = Arm.load(name), 1.5 * np.sin(2.0 * np.pi * 0.8 * 0.002 * np.arange(500))
    played = []
    most = len(squares_of(model_of(arm), True))
    for count in (0, 2, 4, most - 1):
        plant = arm.plant(0.002, count)
        plant.place()
        played.append(plant.replay(command))
    off = [np.abs(readings - played[0]).max(axis=0) for readings in played[1:]]
    assert (off[0] >= off[1]).all()
    assert (off[1] >= off[2]).all()
    assert (off[2] <= 2e-3 * np.abs(played[0]).max(axis=0)).all()
