"""Every way through the kernel gives the same motion: short cut or not, tabulated or not, jitted or not."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numba import njit
from plant_arms import FRICTION, law, noise, pulse, relative, thesis_plant
from work import ends

from flexarm_env import Arm
from flexarm_env.effects import catalogue
from flexarm_env.plant import layout as at
from flexarm_env.plant.compose import compose, source_of
from flexarm_env.plant.inner_product import inner_product
from flexarm_env.plant.propagate import RESPONSE

ARMS = {
    "base": {},
    "four elements": {"elements": 4},
    "rigid": {"elements": 0},
    "cable, lag, damping": {"hub_stiffness": 0.5, "current_lag": 0.004, "beam_damping": 1e-4},
    "root": {"elements": 2, "root_compliance": 0.01},
    "gears": {"gear_compliance": 1 / 300},
    "backlash": {"gear_gap": 0.01},
    "drive": {"laws": (*FRICTION, law("saturation", 2.5)), "resistance": 1.2},
    "constant torque": {"laws": (*FRICTION, law("constant", 0.05))},
    "stribeck": {"laws": (*FRICTION, law("stribeck", 0.05, 0.3))},
    "drag, cogging": {"elements": 2, "laws": (*FRICTION, law("air_drag", 0.05), law("cogging", 0.03, 12.0))},
}
SMOOTH = [name for name in ARMS if name not in ("stribeck", "drag, cogging")]


@pytest.mark.parametrize("name", ARMS)
def test_tabulated_and_untabulated_steps_agree(name):
    current = noise(0, 100)
    even = thesis_plant(**ARMS[name]).replay(current)
    uneven = thesis_plant(**ARMS[name]).replay(current, np.full(100, 0.005))
    assert relative(uneven, even) < 1e-9


@pytest.mark.parametrize("name", SMOOTH)
@pytest.mark.parametrize("current", [pulse(300), noise(1, 100)], ids=["pulse", "noise"])
def test_halving_the_step_changes_nothing(name, current):
    whole = thesis_plant(**ARMS[name]).replay(current)
    halves = thesis_plant(**ARMS[name], interval=0.0025).replay(np.repeat(current, 2))[::2]
    assert relative(halves, whole) < (1e-6 if name == "backlash" else 1e-8)  # impacts amplify rounding


@pytest.mark.parametrize("name", ["stribeck", "drag, cogging"])
def test_fitted_forces_converge(name):
    current = pulse(300)
    fine = thesis_plant(**ARMS[name], interval=0.000625).replay(np.repeat(current, 8))[::8]
    errors = []
    for parts in (2, 4):
        plant = thesis_plant(**ARMS[name], interval=0.005 / parts)
        errors.append(relative(plant.replay(np.repeat(current, parts))[::parts], fine))
    assert errors[0] < 1e-4
    assert errors[1] < errors[0] / 4


@pytest.mark.parametrize("name", ARMS)
def test_short_cut_agrees_with_the_long_way(name):
    current = np.concatenate([pulse(200), noise(2, 50)])
    plant, slow = thesis_plant(**ARMS[name]), thesis_plant(**ARMS[name])
    slow.layout[at.STEADY_BODIES] = 0
    assert relative(plant.replay(current), slow.replay(current)) < 1e-9


@pytest.mark.parametrize(("delay", "shift"), [(0.005, 1), (0.015, 3)])
def test_delay_of_whole_samples_shifts_the_motion(delay, shift):
    prompt = thesis_plant().replay(pulse())
    late = thesis_plant(input_delay=delay).replay(pulse())
    assert np.array_equal(late[shift:], prompt[:-shift])


@pytest.mark.parametrize("name", ["base", "stribeck", "backlash"])
def test_delay_of_part_of_a_sample_is_a_finer_shift(name):
    current = pulse(300)
    late = thesis_plant(**ARMS[name], input_delay=0.0075).replay(current)
    fine = thesis_plant(**ARMS[name], interval=0.0025).replay(np.repeat(current, 2))
    moved = np.vstack([np.zeros((3, fine.shape[1])), fine[:-3]])
    assert relative(late, moved[::2]) < 1e-8


def test_feedback_of_a_perfect_measurement_corrects_nothing():
    plant = thesis_plant(4)
    gains = np.full((plant.modes, 2 * plant.blocks + plant.bodies, len(plant.signals)), 0.1)
    readings = plant.replay(noise(3, 100))
    plant.place()
    assert np.array_equal(plant.replay(noise(3, 100), gains=gains, measured=readings), readings)


def test_replay_may_be_cut_anywhere():
    current = noise(4, 200)
    whole = thesis_plant(4).replay(current)
    plant = thesis_plant(4)
    parts = [plant.replay(current[:71]), plant.replay(current[70:])[1:]]
    assert np.array_equal(np.vstack(parts), whole)


@pytest.mark.parametrize("effect", ["asymmetric_coulomb", "asymmetric_viscous", "load_friction", "shear_thinning"])
@pytest.mark.parametrize("name", ["cu-rigid", "cu-flexible"])
def test_a_hub_at_rest_without_a_push_takes_whole_steps_though_no_friction_holds_it(name, effect):
    """Time then adds up as whole steps do, to the last bit; a recording that begins at rest would else be full of events."""
    arm, interval = Arm.load(name), 0.003
    plant = arm.with_effect(effect, **arm.known[effect].starts()[0]).plant(interval)
    plant.place()
    plant.replay(np.zeros(1001))
    assert plant.state[at.TIME] == sum([interval] * 1000)


@pytest.mark.parametrize("beside", [0.0, 1e-6, 1e9])
@pytest.mark.parametrize("damping", [-0.05, 0.0, 1e-7, 0.3, 3.0, 40.0])
@pytest.mark.parametrize("stiffness", [0.0, 1e-8, 1e-4, 0.09, 1.0, 400.0])
def test_response_of_a_block_solves_its_equation(stiffness, damping, beside):
    """Its integrals, and the composition of two steps into one, however fast or slow the block beside it is."""
    time, kernel = 0.7, compose(catalogue().laws)
    blocks = np.array([stiffness / time**2, beside / time**2, damping / time, 0.0])

    def response(time):
        table = np.zeros(2 * RESPONSE)
        kernel.respond(blocks, 0, 2, 2, time, table, 0)
        return table[::2]

    c0, c1 = blocks[0], blocks[2]
    c, s, r0, r1, r2 = response(time)
    assert c + c0 * r0 == pytest.approx(1.0, rel=1e-12)
    assert s + c1 * r0 + c0 * r1 == pytest.approx(time, rel=1e-12)
    assert r0 + c1 * r1 + c0 * r2 == pytest.approx(time**2 / 2, rel=1e-12)
    twice = response(2 * time)
    assert twice[0] == pytest.approx(c * c - c0 * s * s, abs=1e-12)
    assert twice[2] == pytest.approx(r0 + c * r0 + s * s, rel=1e-11)


@pytest.mark.parametrize("frequency", [0.0, 1e-3, 1.0, 40.0, 3e3])
@pytest.mark.parametrize("ratio", [0.0, 1e-6, 0.02, 0.7])
def test_response_of_a_block_is_the_closed_form(frequency, ratio):
    """C = Ṡ + c₁ S, S and ∫S of a damped vibration after 2 ms [rad/s], beside the fastest of the thesis's beam."""
    time, kernel = 2e-3, compose(catalogue().laws)
    blocks = np.array([frequency**2, 1e4**2, 2.0 * ratio * frequency, 0.0])
    table = np.zeros(2 * RESPONSE)
    kernel.respond(blocks, 0, 2, 2, time, table, 0)
    decay, turned = np.exp(-ratio * frequency * time), frequency * np.sqrt(1.0 - ratio**2)
    s = decay * time * np.sinc(turned * time / np.pi)
    c = decay * np.cos(turned * time) + ratio * frequency * s
    assert table[0] == pytest.approx(c, abs=2e-14)
    assert table[2] == pytest.approx(s, rel=2e-13, abs=1e-14 * time)
    if frequency >= 1.0:
        assert table[4] == pytest.approx((1.0 - c) / frequency**2, rel=1e-10)


@given(st.lists(st.tuples(*2 * (st.floats(-1e3, 1e3),)), max_size=40), st.integers(0, 3))
def test_an_inner_product_is_that_of_python_to_the_last_bit(pairs, shift):
    one, two = (np.array([0.0] * shift + [pair[i] for pair in pairs]) for i in (0, 1))
    assert compiled_product(one, two, shift, len(pairs)) == inner_product(one, shift, two, shift, len(pairs))


@njit
def compiled_product(one, two, first, count):
    return inner_product(one, first, two, first, count)


SCRIPT = """
import sys
import numpy as np
from plant_arms import noise, thesis_plant
from test_kernel_paths import ARMS
runs = [thesis_plant(**ARMS[name]).replay(noise(5, 40)) for name in ("base", "stribeck", "backlash")]
np.save(sys.argv[1], np.vstack(runs))
"""


@pytest.mark.slow
def test_jitted_kernel_equals_python(tmp_path):
    tests = Path(__file__).resolve().parent
    path = os.pathsep.join([str(tests.parent), str(tests), str(tests.parent.parent)])
    environment = os.environ | {"NUMBA_DISABLE_JIT": "1", "PYTHONPATH": path, "FLEXARM_CACHE": str(tmp_path)}
    subprocess.run([sys.executable, "-c", SCRIPT, str(tmp_path / "python.npy")], env=environment, check=True)
    jitted = np.vstack([thesis_plant(**ARMS[n]).replay(noise(5, 40)) for n in ("base", "stribeck", "backlash")])
    assert relative(jitted, np.load(tmp_path / "python.npy")) < 1e-12


def test_no_two_kernels_share_a_name():
    text = source_of(catalogue().laws)
    names = re.findall(r"^def (\w+)", text, re.MULTILINE)
    assert len(names) == len(set(names))  # one module holds them all: a second would shadow the first in Python


@pytest.mark.parametrize("offset", [-1e-8, 1e-8])
def test_a_hole_takes_no_longer_where_clocks_differ_by_next_to_nothing(offset):
    intervals = np.full(100, 0.01)
    intervals[50] = 2.0

    def readings(arm, count=100):
        plant = arm.plant(0.01)
        plant.state[at.COMMAND] = 1.0  # before the first sample, too
        return plant.replay(np.ones(count), intervals[:count])[:, :2]

    arms = [Arm.load("thesis"), Arm.load("thesis").with_effect("time_offset", offset=offset)]
    for arm in arms:
        readings(arm, 2)  # compiles
    with ends():
        prompt, late = map(readings, arms)
    np.testing.assert_allclose(late, prompt, rtol=1e-5, atol=1e-6)
