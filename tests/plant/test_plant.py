"""The plant against an independent solver and against what must hold of any such arm."""

from __future__ import annotations

import numpy as np
import pytest
from plant_arms import FRICTION, STATIC, TORQUE_PER_AMP, energy, law, noise, pulse, relative, thesis_plant
from reference import ReferenceArm, pulse_current, white_noise_current

from flexarm_env import Arm
from flexarm_env.plant import assembly, flat_arrays
from flexarm_env.plant import layout as at


def assert_follows_reference(elements, current):
    wanted = ReferenceArm(elements=elements).simulate(current, 0.005)
    found = thesis_plant(elements).replay(np.append(current, 0.0))
    assert relative(found[:, 0], wanted["hub_angle"]) < 1e-9
    assert relative(found[:, 1] / 1.5, wanted["hub_speed"]) < 1e-9
    assert relative(found[:, 2], wanted["moment_mid"]) < 1e-9
    assert relative(found[:, 3], wanted["moment_base"]) < 1e-9
    assert relative(found[:, 4] + found[:, 0], wanted["tip"]) < 1e-9
    assert np.array_equal(found[1:, 1] == 0.0, wanted["stuck"][1:] & (wanted["hub_speed"][1:] == 0.0))


@pytest.mark.parametrize("elements", [1, 4])
def test_pulse_agrees_with_reference(elements):
    assert_follows_reference(elements, pulse_current(seconds=2.5))


@pytest.mark.parametrize(("elements", "seed"), [(1, 0), (4, 1)])
def test_white_noise_agrees_with_reference(elements, seed):
    assert_follows_reference(elements, white_noise_current(seed, 200, 2.0))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("elements", [1, 4])
def test_white_noise_agrees_with_reference_over_many_seeds(elements, seed):
    assert_follows_reference(elements, white_noise_current(100 + seed, 300, 2.0))


@pytest.mark.parametrize(
    ("elements", "payload", "free", "clamped"),
    [(1, 0.0, [8.964, 29.62], [2.429, 23.94]), (4, 0.0, [8.69, 20.27], [2.418, 15.17]), (1, 0.3, [6.911], [1.225])],
)
def test_frequencies_are_those_of_the_thesis(elements, payload, free, clamped):
    """Table of the notes on the thesis; its second modes of three and more elements are 20.25 and 15.15 Hz."""
    plant = thesis_plant(elements, laws=(), viscous=0.0, tip_mass=payload)
    for mode, wanted in ((0, free), (1, clamped)):
        start = plant.layout[at.MODES] + mode * plant.layout[at.STRIDE] + plant.layout[at.C0]
        squares = np.sort(plant.constants[start : start + plant.blocks])
        found = np.sqrt(squares[squares > 1.0])[: len(wanted)] / (2 * np.pi)
        assert found == pytest.approx(wanted, rel=1e-3)


@pytest.mark.parametrize("elements", [1, 4])
def test_hub_under_less_than_static_friction_never_moves(elements):
    hour = np.full(720_000, 0.99 * STATIC / TORQUE_PER_AMP)
    readings = thesis_plant(elements).replay(hour)
    assert not readings.any()


@pytest.mark.parametrize("elements", [0, 1, 4])
def test_hub_breaks_away_above_static_friction(elements):
    readings = thesis_plant(elements).replay(np.full(4, 1.01 * STATIC / TORQUE_PER_AMP))
    assert readings[1, 0] > 0.0


@pytest.mark.parametrize("changes", [{}, {"gear_gap": 0.01}, {"gear_compliance": 0.003}])
def test_arm_without_friction_stays_at_rest(changes):
    assert not thesis_plant(laws=(), **changes).replay(np.zeros(2000)).any()


def test_open_gears_without_friction_still_move_the_hub():
    readings = thesis_plant(laws=(), gear_gap=0.01).replay(np.full(200, 1.0))
    assert readings[-1, 0] > 0.1


@pytest.mark.parametrize("laws", [(), FRICTION, (*FRICTION, law("stribeck", 0.05, 0.3), law("air_drag", 0.05))])
@pytest.mark.parametrize("elements", [1, 4])
def test_energy_never_rises_without_input(elements, laws):
    plant = thesis_plant(elements, laws=laws)
    size = len(plant.model.names)
    start = np.zeros(plant.states)
    start[size:] = np.random.default_rng(0).normal(0.0, 2.0, size)
    plant.place(start)
    energies = [energy(plant, start)]
    for _ in range(1500):
        plant.replay(np.zeros(2))
        energies.append(energy(plant, plant.physical()))
    assert np.max(np.diff(energies)) < 1e-12 * energies[0]


def test_energy_of_an_ideal_arm_stays():
    plant = thesis_plant(4, laws=(), viscous=0.0)
    start = np.random.default_rng(1).normal(0.0, 1.0, plant.states)
    plant.place(start)
    plant.replay(np.zeros(100_001))
    assert energy(plant, plant.physical()) == pytest.approx(energy(plant, start), rel=1e-9)


def test_negative_damping_makes_the_arm_swing_up():
    """Kelvin–Voigt time below zero: the bounds on curvature must hold for blocks that grow, too."""
    plant = thesis_plant(laws=FRICTION, beam_damping=-1e-4)
    halved = thesis_plant(laws=FRICTION, beam_damping=-1e-4, interval=0.0025)
    current = noise(3, 300)
    assert relative(plant.replay(current), halved.replay(np.repeat(current, 2))[::2]) < 1e-7


@pytest.mark.parametrize("viscous", [0.0, 1e-9])
def test_damping_that_vanishes_is_smooth(viscous):
    nearly = thesis_plant(viscous=viscous).replay(pulse())
    assert relative(nearly, thesis_plant(viscous=1e-8).replay(pulse())) < 1e-5


@pytest.mark.parametrize(
    ("interval", "laws", "bound"),
    [
        (1e-5, FRICTION, 1e-11),
        # After the n-th event of an interval the kernel is blind to the next for 1e-11 s · 2ⁿ. Here n is at most 4, and nothing
        # changes by more than 150 of its largest value in a second: 2.4e-8. In 0.1 s n reaches 13.
        (0.02, FRICTION, 2.4e-8),
        (0.1, (), 1e-12),
    ],
)
@pytest.mark.parametrize("seed", range(10))
def test_length_of_the_interval_does_not_matter(seed, interval, laws, bound):
    current = noise(seed, 40)
    whole = thesis_plant(4, laws=laws, interval=interval).replay(current)
    parts = thesis_plant(4, laws=laws, interval=interval / 8).replay(np.repeat(current, 8))[::8]
    assert relative(whole, parts) < bound


@pytest.mark.slow
@pytest.mark.parametrize(
    ("laws", "changes"),
    [
        (FRICTION, {}),
        ((law("coulomb", 0.28),), {}),
        ((law("coulomb", 50.0),), {}),
        ((), {}),
        (FRICTION, {"gear_gap": 0.01}),
        ((), {"gear_gap": 0.01}),
    ],
)
@pytest.mark.parametrize("elements", [1, 4])
def test_white_noise_never_hangs(elements, laws, changes):
    plant = thesis_plant(elements, laws=laws, **changes)
    for seed in range(2 if changes else 100 if laws is FRICTION else 10):
        assert np.isfinite(plant.replay(noise(seed, 100_000))).all()


@pytest.mark.parametrize("name", ["thesis-fem", "cu-flexible", "cu-rigid"])
def test_a_plant_does_not_depend_on_those_before_it(name: str) -> None:
    """What plants share is kept: an arm after others has the numbers of the first in a fresh cache, to the last bit."""
    arm = Arm.load(name)
    sensor = arm.signals[-1]
    arms = [
        arm,
        arm.with_values({"hub.inertia": 1.1 * arm.value("hub.inertia")}),
        arm.with_values({f"sensors.{sensor}.offset": 0.1}),
        arm.with_values({f"sensors.{sensor}.filter": 0.01}),
        arm.with_effect("coulomb", torque=0.01),
        arm.with_effect("stribeck", extra=0.01, falloff_speed=0.1),
        arm.with_effect("current_lag", time=0.01),
        *(
            arm.with_values({f"sensors.{sensor}.filter": filter}).with_effect("current_lag", time=1e-10)  # too short to count
            for filter in (0.02, 0.03)
        ),
        arm.with_effect("base_tilt", torque=0.01, uphill=0.2),
    ]
    alone = []
    for one in arms:
        for cache in (assembly._assemble_one, flat_arrays._linear_numbers_of_one, flat_arrays._decomposed_one):
            cache.cache_clear()
        alone.append(one.plant(0.002))
    for fresh, one in zip(alone, arms, strict=True):
        again = one.plant(0.002)
        assert np.array_equal(fresh.constants, again.constants)
        assert np.array_equal(fresh.layout, again.layout)
    assert flat_arrays._linear_numbers_of_one.cache_info().hits > 0
    assert flat_arrays._decomposed_one.cache_info().hits > 0
    assert len({plant.constants.tobytes() for plant in alone}) == len(arms)
