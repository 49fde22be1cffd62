"""Laws that hold for every arm, whatever its numbers: energy, reversal of time, symmetry, and parts that make the whole."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from plant_arms import energy_with_gears

from flexarm_env import Arm, Recording, simulate
from flexarm_env.plant.plant import NO_GAINS, NO_INTERVALS, NOT_MEASURED, Plant

INTERVAL = 0.005
ARMS = ("thesis", "thesis-fem", "cu-flexible", "cu-rigid", "emps")
#: Effects that take energy from an arm and give it none.
PASSIVE = ("viscous", "coulomb", "stiction", "stribeck", "air_drag", "beam_damping", "load_friction")
#: Effects that act alike on both sides. The others have a phase, an offset or a direction.
EVEN = (
    *PASSIVE,
    *(
        "presliding",
        "backlash",
        "gear_compliance",
        "root_compliance",
        "payload",
        "tip_inertia",
        "dead_zone",
        "saturation",
        "rate_limit",
    ),
    *("current_lag", "input_delay", "brush_drop", "friction_warmup", "higher_modes", "tach_filter", "strain_lag"),
)
few = settings(max_examples=15)


@st.composite
def arms(draw: st.DrawFn, names: tuple[str, ...] = ARMS, effects: tuple[str, ...] = EVEN) -> Arm:
    """Draw an arm with other constants and up to three effects of any usual size."""
    arm = replace(Arm.load(draw(st.sampled_from(names))), effects={})
    scaled = ("hub.inertia", "drive.torque_constant", "beam.mass_per_length", "beam.bending_stiffness", "beam.length")
    for path in scaled:
        section, key = path.split(".")
        if key in arm.constants.get(section, {}):
            arm = arm.with_values({path: arm.value(path) * draw(st.floats(0.5, 2.0))})
    gages = [signal for signal in arm.signals if arm.sensor(signal).strain]  # a shorter beam may end before them
    arm = replace(arm, sensors={signal: values for signal, values in arm.sensors.items() if signal not in gages})
    possible = [name for name in effects if arm.can_have(name)]
    for name in draw(st.lists(st.sampled_from(possible), max_size=3, unique=True)) if possible else []:
        share = draw(st.floats(0.1, 3.0))
        parameters = arm.known[name].parameters
        sizes = {key: min(max(p.typical * share, p.low), p.high) for key, p in parameters.items() if p.null is not None}
        arm = arm.with_effect(name, **({} if name == "higher_modes" else sizes))
    return arm


def commands(draw: st.DrawFn, arm: Arm, count: int) -> np.ndarray:
    """Draw steps of a command of the arm's own size."""
    largest = arm.constants["drive"]["limit"] or 5.0
    shares = draw(st.lists(st.floats(-1.0, 1.0), min_size=4, max_size=4))
    return np.repeat(largest * np.array(shares), count // 4)


@st.composite
def driven(draw: st.DrawFn, make: Callable[[], st.SearchStrategy[Arm]] = arms, count: int = 120) -> tuple[Arm, np.ndarray]:
    arm = draw(make())
    return arm, commands(draw, arm, count)


def placed(arm: Arm) -> Plant:
    plant = arm.plant(INTERVAL)
    plant.place()
    return plant


@few
@given(driven(lambda: arms(effects=PASSIVE)))
def test_an_arm_left_alone_gains_no_energy(drawn):
    arm, command = drawn
    plant, structure = placed(arm), arm.structure()
    plant.replay(command)
    levels = []
    for _ in range(100):
        plant.replay(np.zeros(2))
        levels.append(energy_with_gears(plant, structure))
    assert np.diff(levels).max() <= 1e-9 * levels[0] + 1e-15


@few
@given(driven(lambda: arms(("thesis", "thesis-fem"), ())))
def test_an_arm_without_friction_runs_backwards_as_it_came(drawn):
    arm, command = drawn
    arm = arm.with_values({"drive.gear_stiffness": 0.0})  # gears that wind up have a damping
    plant = arm.plant(INTERVAL)
    size = len(plant.model.names)
    start = np.zeros(plant.states)
    start[0], start[size] = 0.3, -0.7
    plant.place(start)
    forth = plant.replay(np.append(command, 0.0))  # the state is now that of the last sample
    turned = plant.physical()
    turned[size : 2 * size] *= -1.0
    plant.place(turned)
    back = plant.replay(np.append(command[::-1], 0.0))
    angle = arm.signals.index("arm_angle")
    assert np.abs(back[::-1, angle] - forth[:, angle]).max() < 1e-8 * max(1.0, np.abs(forth[:, angle]).max())


@few
@given(driven())
def test_mirrored_commands_make_a_mirrored_motion(drawn):
    arm, command = drawn
    there, mirrored = placed(arm).replay(command), placed(arm).replay(-command)
    assert np.abs(there + mirrored).max() <= 1e-9 * max(1.0, np.abs(there).max())


@few
@given(driven(), st.integers(1, 118))
def test_a_motion_in_two_parts_is_the_motion(drawn, split):
    arm, command = drawn
    whole, plant = placed(arm).replay(command), placed(arm)
    command = plant.delayed(command)
    parts = [plant.play(part, NO_INTERVALS, NO_GAINS, NOT_MEASURED) for part in (command[: split + 1], command[split:])]
    assert np.array_equal(np.concatenate([parts[0][:-1], parts[1]]), whole)


@few
@given(
    st.sampled_from(["s", "ms", "us", "min"]),
    st.sampled_from(["A", "mA"]),
    st.sampled_from(["rad", "deg", "mrad", "turn"]),
    st.sampled_from(["rad/s", "rpm", "deg/s"]),
)
def test_a_recording_in_any_units_is_the_same(tmp_path_factory, time, current, angle, speed):
    run = simulate(Arm.load("thesis"), "square", duration=0.5, rate=200.0)
    size = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, "A": 1.0, "mA": 1e-3, "rad": 1.0, "deg": np.pi / 180.0}
    size |= {"mrad": 1e-3, "turn": 2.0 * np.pi, "rad/s": 1.0, "rpm": np.pi / 30.0, "deg/s": np.pi / 180.0}
    columns = {
        f"time [{time}]": run.time / size[time],
        f"current [{current}]": run.command / size[current],
        f"arm_angle [{angle}]": run.signals["arm_angle"] / size[angle],
        f"motor_speed [{speed}]": run.signals["motor_speed"] / size[speed],
    }
    rows = "\n".join(",".join(map(repr, row)) for row in np.stack(list(columns.values()), axis=1).tolist())
    path = tmp_path_factory.mktemp("units") / "run.csv"
    path.write_text(f"{','.join(columns)}\n{rows}\n")
    found = Recording.read(path)
    assert np.allclose(found.time, run.time, rtol=1e-12, atol=1e-12)
    assert np.allclose(found.command, run.command, rtol=1e-12, atol=1e-12)
    for signal in ("arm_angle", "motor_speed"):
        assert np.allclose(found.signals[signal], run.signals[signal], rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("order", [("dead_zone", "saturation"), ("saturation", "dead_zone")])
def test_a_dead_zone_acts_before_a_limit_whichever_was_added_first(order: tuple[str, str]) -> None:
    sizes = {"dead_zone": {"width": 0.2}, "saturation": {"limit": 1.0}}
    bare = Arm.load("cu-rigid")
    limited = bare.with_effect(order[0], **sizes[order[0]]).with_effect(order[1], **sizes[order[1]])
    command = 2.0 * np.sin(2.0 * np.pi * 0.7 * INTERVAL * np.arange(400))
    acting = np.clip(np.sign(command) * np.maximum(np.abs(command) - 0.2, 0.0), -1.0, 1.0)
    np.testing.assert_array_equal(replayed(limited, command), replayed(bare, acting))


def replayed(arm: Arm, command: np.ndarray) -> np.ndarray:
    """Replay an arm from rest."""
    plant = arm.plant(INTERVAL)
    plant.place()
    return plant.replay(command)
