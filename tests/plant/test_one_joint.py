"""Links under gravity, elastic joints and servos against closed forms and an integrator that shares nothing with the plant."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from one_joint import LINK, elastic_joint, pendulum, servo
from scipy.integrate import solve_ivp
from scipy.special import ellipk

from flexarm_env import Arm, InputError, simulate
from flexarm_env.machine import GRAVITY

INTERVAL = 0.005
Rates = Callable[[np.ndarray, float], list[float]]


def swing(arm: Arm, start: float, samples: int, interval: float = INTERVAL) -> tuple[np.ndarray, np.ndarray]:
    """Angles and motor speeds of an arm that is let go at an angle without a command."""
    plant = arm.plant(interval)
    plant.place(np.array([start] + [0.0] * (plant.states - 1)))
    readings = plant.replay(np.zeros(samples))
    return readings[:, 0], readings[:, 1]


def period(angle: np.ndarray, interval: float = INTERVAL) -> float:
    """Mean time between crossings of zero in one direction."""
    places = np.flatnonzero((angle[:-1] > 0.0) & (angle[1:] <= 0.0))
    times = places + angle[places] / (angle[places] - angle[places + 1])
    return float(np.diff(times).mean()) * interval


def integrated(rates: Rates, start: list[float], commands: np.ndarray, interval: float = INTERVAL) -> np.ndarray:
    """Integrate ẋ = rates(x, command) over held commands, tightly; return the state at each sample."""
    states = [np.array(start)]
    for command in commands[:-1]:
        end = solve_ivp(lambda _, x, u=command: rates(x, u), (0.0, interval), states[-1], "DOP853", rtol=1e-11, atol=1e-13)
        states.append(end.y[:, -1])
    return np.array(states)


@pytest.mark.parametrize("tilt", [np.pi / 2, 0.3])
@pytest.mark.parametrize("amplitude", [0.01, 1.0, 2.5])
def test_a_pendulum_has_the_period_of_the_elliptic_integral(amplitude, tilt):
    arm = pendulum(vertical=True) if tilt == np.pi / 2 else pendulum().with_values({"link.tilt": tilt})
    angle, _ = swing(arm, amplitude, 6000)
    rate = np.sqrt(0.5 * 0.2 * GRAVITY * np.sin(tilt) / 0.025)
    assert period(angle) == pytest.approx(4.0 / rate * ellipk(np.sin(amplitude / 2.0) ** 2), rel=2e-6)


def test_a_pendulum_keeps_its_energy():
    angle, speed = swing(pendulum(), 2.0, 12000)
    energy = 0.5 * 0.025 * speed**2 - 0.5 * 0.2 * GRAVITY * np.cos(angle)
    assert np.ptp(energy) < 1e-6 * 0.5 * 0.2 * GRAVITY


def test_a_pendulum_hangs_where_the_arm_file_says():
    angle, _ = swing(pendulum(hangs_at=np.pi), np.pi + 1e-9, 2000)
    assert np.abs(angle - np.pi).max() < 2e-9
    angle, _ = swing(pendulum(hangs_at=np.pi), 1e-3, 2000)
    assert np.abs(angle).max() > 3.0, "it stands upright at 0, and falls"


def test_a_driven_pendulum_moves_as_the_integrator_says():
    arm = pendulum().with_effect("viscous", coefficient=0.02)
    commands = 0.8 * np.sign(np.sin(np.arange(600) * INTERVAL * 4.0))
    plant = arm.plant(INTERVAL)
    plant.place()

    def rates(x: np.ndarray, torque: float) -> list[float]:
        return [x[1], (torque - 0.02 * x[1] - 0.5 * 0.2 * GRAVITY * np.sin(x[0])) / 0.025]

    assert np.abs(plant.replay(commands) - integrated(rates, [0.0, 0.0], commands)).max() < 2e-6


def test_a_payload_hangs_from_the_tip_of_the_link():
    angle, _ = swing(pendulum().with_effect("payload", mass=0.3), 0.01, 6000)
    moment, inertia = 0.5 * 0.2 + 0.3 * 0.4, 0.025 + 0.3 * 0.4**2
    assert period(angle) == pytest.approx(2 * np.pi * np.sqrt(inertia / (moment * GRAVITY)), rel=1e-5)


def test_a_beam_in_gravity_is_one_on_a_tilted_base_of_its_own_weight():
    arm = Arm.load("thesis-fem")
    hanging = arm.with_values({"beam.tilt": 0.4, "beam.hangs_at": 0.2})
    torque = GRAVITY * np.sin(0.4) * 0.42381 / 2.0
    tilted = arm.with_effect("base_tilt", torque=torque, uphill=0.2 + np.pi)
    ends = []
    for one in (hanging, tilted):
        plant = one.plant(INTERVAL)
        plant.place()
        ends.append(plant.replay(np.full(100, 2.0)))
    assert np.allclose(*ends, rtol=1e-12, atol=1e-12)


def test_an_elastic_joint_rings_as_two_masses_on_a_spring():
    front, link = 70.0**2 * 4.6e-7 + 1e-4, 0.0038
    arm = elastic_joint(damping=0.0).with_values({"drive.torque_constant": 1e-9})
    frequencies, _ = arm.linearise("moving", INTERVAL).vibrations()
    assert frequencies[0] == pytest.approx(np.sqrt(1.3 * (1.0 / front + 1.0 / link)) / (2.0 * np.pi), rel=1e-6)
    damped = elastic_joint().with_values({"drive.torque_constant": 1e-9})
    _, ratios = damped.linearise("moving", INTERVAL).vibrations()
    rate = np.sqrt(1.3 * (1.0 / front + 1.0 / link))
    assert ratios[0] == pytest.approx(0.004 * (1.0 / front + 1.0 / link) / (2.0 * rate), rel=1e-6)


def test_an_elastic_joint_winds_up_under_its_load():
    arm = elastic_joint(damping=0.05).with_values({"link.tilt": np.pi / 2}).with_effect("coulomb", torque=5.0)
    plant = arm.plant(INTERVAL)
    plant.place(np.array([1.0, 1.0, 0.0, 0.0]))
    hub, link, _ = plant.replay(np.zeros(4000))[-1]
    assert hub == pytest.approx(1.0, abs=1e-9), "friction holds the hub in front of the spring"
    assert 1.3 * (hub - link) == pytest.approx(0.065 * 0.15 * GRAVITY * np.sin(link), rel=1e-6)


def test_an_elastic_joint_moves_as_the_integrator_says():
    arm, front = elastic_joint(), 70.0**2 * 4.6e-7 + 1e-4
    commands = 5.0 * np.sign(np.sin(np.arange(300) * INTERVAL * 6.0))
    plant = arm.plant(INTERVAL)
    plant.place()
    found = plant.replay(commands)
    back_emf = 70.0 * 0.00768

    def rates(x: np.ndarray, voltage: float) -> list[float]:
        spring = 1.3 * (x[0] - x[1]) + 0.004 * (x[2] - x[3])
        torque = 0.62 * back_emf * (voltage - back_emf * x[2]) / 2.6
        return [x[2], x[3], (torque - spring) / front, spring / 0.0038]

    states = integrated(rates, [0.0] * 4, commands)
    assert np.abs(found[:, 0] - states[:, 0]).max() < 1e-8
    assert np.abs(found[:, 1] - states[:, 1]).max() < 1e-8
    assert np.abs(found[:, 2] - 70.0 * states[:, 2]).max() < 1e-6


@pytest.mark.parametrize(
    ("changes", "limits"),
    [({}, (7.4, np.inf)), ({"largest_duty": 0.3}, (2.22, np.inf)), ({"current_limit": 0.4}, (7.4, 0.4))],
)
def test_a_servo_moves_as_the_integrator_says(changes, limits):
    arm = servo(derivative=3.0, **changes).with_effect("viscous", coefficient=0.0037)
    commands = np.repeat([1.2, -0.8, 0.3, 1.5], 100)
    plant = arm.plant(INTERVAL)
    plant.place()
    found = plant.replay(commands)[:, 0]
    gain, largest, current = 0.002877 * 7.4, limits[0], limits[1]

    def rates(x: np.ndarray, goal: float) -> list[float]:
        opposed = 0.387 * x[1]
        voltage = gain * (400.0 * (goal - x[0]) - 3.0 * x[1])
        voltage = np.clip(voltage, opposed - 4.02 * current, opposed + 4.02 * current)
        voltage = np.clip(voltage, -largest, largest)
        torque = 0.387 * (voltage - opposed) / 4.02 - 0.0037 * x[1] - 0.49 * 0.1 * GRAVITY * np.sin(x[0])
        return [x[1], torque / (0.00181 + 0.0049)]

    assert np.abs(found - integrated(rates, [0.0, 0.0], commands)[:, 0]).max() < 2e-5


def test_a_servo_gives_way_under_its_load():
    plant = servo().plant(INTERVAL)
    plant.place()
    angle = plant.replay(np.full(2000, 1.0))[-1, 0]
    torque = 0.387 / 4.02 * 400.0 * 0.002877 * 7.4 * (1.0 - angle)
    assert torque == pytest.approx(0.49 * 0.1 * GRAVITY * np.sin(angle), rel=1e-6)


def test_friction_by_load_feels_a_servo_s_torque():
    """At rest the arm stays where the servo's torque and gravity differ by less than the friction that they cause."""
    arm = servo().with_effect("load_friction", coefficient=0.3).with_effect("coulomb", torque=0.005)
    plant = arm.plant(INTERVAL)
    plant.place()
    angle = plant.replay(np.full(1500, 1.0))[-1, 0]
    torque = 0.387 / 4.02 * 400.0 * 0.002877 * 7.4 * (1.0 - angle)
    left = abs(torque - 0.49 * 0.1 * GRAVITY * np.sin(angle))
    assert 0.0 < left <= 0.3 * torque + 0.005 + 1e-9
    assert plant.physical()[1] == 0.0


def test_a_supply_sags_by_the_square_of_the_duty():
    drive = {"input": "voltage", "torque_constant": 0.05, "gear_ratio": 1.0, "motor_inertia": 0.0, "resistance": 2.0}
    table = {"drive": drive | {"supply_voltage": 12.0}, "hub": {"inertia": 0.01}, "sensors": {"arm_angle": {}, "motor_speed": {}}}
    arm = Arm.from_table(table, "motor").with_effect("supply_sag", resistance=1.5)
    plant = arm.plant(1e-3)
    plant.place()
    speed = plant.replay(np.full(3, 9.0))[1, 1]
    assert speed == pytest.approx(0.05 * 9.0 / (2.0 + 0.75**2 * 1.5) * 1e-3 / 0.01, rel=1e-3)


@pytest.mark.parametrize("held", [False, True])
def test_a_fixture_rings_with_what_stands_on_it(held):
    link, base, stiffness = 0.025, 0.08, 120.0
    arm = pendulum(vertical=False).with_effect("fixture_compliance", stiffness=stiffness, inertia=base, damping_time=1e-6)
    frequencies, _ = arm.linearise("stuck" if held else "moving", INTERVAL).vibrations()
    # a free link stays where it is in space: it has no spring to the fixture
    assert frequencies[0] == pytest.approx(np.sqrt(stiffness / (base + (link if held else 0.0))) / (2 * np.pi), rel=1e-6)


def test_a_rotor_turns_its_fixture_by_the_gear_ratio():
    """Angular momentum: a motor of N turns carries N times its inertia against the fixture, which is free here."""
    drive = {"input": "torque", "gear_ratio": 5.0, "motor_inertia": 2e-4}
    table = {"drive": drive, "hub": {"inertia": 0.01}, "sensors": {"arm_angle": {}}}
    arm = Arm.from_table(table, "rotor").with_effect("fixture_compliance", stiffness=0.01, inertia=0.05, damping_time=1e-6)
    plant = arm.plant(1e-4)
    plant.place()
    plant.replay(np.full(3, 1.0))
    rate, turn = plant.physical()[2:4]
    assert 0.01 * (rate + turn) + 2e-4 * (5.0 * rate + turn) + 0.05 * turn == pytest.approx(0.0, abs=1e-9 * rate)


def test_a_transmission_error_shakes_the_link_as_the_integrator_says():
    arm, front = elastic_joint().with_effect("kinematic_error", amplitude=0.01, phase=0.4), 70.0**2 * 4.6e-7 + 1e-4
    arm = arm.with_effect("stiffening", knee=0.2)
    commands, interval = np.full(200, 1.5), 0.002
    plant = arm.plant(interval)
    plant.place()
    found, back_emf = plant.replay(commands), 70.0 * 0.00768

    def rates(x: np.ndarray, voltage: float) -> list[float]:
        windup = x[0] - x[1]
        spring = 1.3 * (windup + windup**3 / 0.2**2 + 0.01 * np.sin(2.0 * 70.0 * x[0] + 0.4)) + 0.004 * (x[2] - x[3])
        torque = 0.62 * back_emf * (voltage - back_emf * x[2]) / 2.6
        return [x[2], x[3], (torque - spring) / front, spring / 0.0038]

    states = integrated(rates, [0.0] * 4, commands, interval)
    assert np.abs(found[:, 1] - states[:, 1]).max() < 1e-5 * np.abs(states[:, 1]).max()


def test_a_motor_s_current_is_what_voltage_and_back_emf_make_of_it():
    arm = Arm.load("cu-rigid")
    table = {"drive": {"input": "voltage", **dict(arm.constants["drive"])}, "hub": dict(arm.constants["hub"])}
    table["sensors"] = {"motor_speed": {}, "motor_current": {}, "hub_acceleration": {}}
    plant = Arm.from_table(table, "motor").plant(INTERVAL)
    plant.place()
    speed, acceleration, current = plant.replay(np.full(30, 5.0))[-1]
    assert current == pytest.approx((5.0 - 0.0107 * speed) / 3.29, rel=0.03)  # a filter of 1 ms, a time constant of 43 ms
    assert acceleration == pytest.approx(48.4 * 0.0107 * current / 0.0035, rel=1e-6)


def test_a_motor_that_is_off_carries_no_current():
    arm = Arm.load("cu-rigid")
    table = {"drive": {"input": "voltage", **dict(arm.constants["drive"]), "enabled": 0}, "hub": dict(arm.constants["hub"])}
    plant = Arm.from_table(table | {"sensors": {"motor_current": {}}}, "off").plant(INTERVAL)
    plant.place()
    assert not plant.replay(np.full(10, 5.0)).any()


MACHINES = (pendulum(), elastic_joint(), servo(), pendulum(vertical=False).with_effect("fixture_compliance"))
FRICTION = {"coulomb": {"torque": 0.01}, "load_friction": {"coefficient": 0.1}, "end_stop": {"stiffness": 5.0}}


def rough(arm: Arm) -> Arm:
    """Add friction, friction by load and stops."""
    for name, values in FRICTION.items():
        arm = arm.with_effect(name, **values)
    return arm


def steps(arm: Arm) -> np.ndarray:
    """Four steps of a command of the machine's own size."""
    return np.repeat(arm.constants["drive"]["limit"] * np.array([0.3, -0.5, 0.1, 0.4]), 40)


@pytest.mark.parametrize("arm", MACHINES, ids=lambda arm: arm.name)
def test_mirrored_commands_make_a_mirrored_motion(arm):
    found = []
    for sign in (1.0, -1.0):
        plant = rough(arm).plant(INTERVAL)
        plant.place()
        found.append(sign * plant.replay(sign * steps(arm)))
    assert np.abs(found[0] - found[1]).max() <= 1e-9 * np.abs(found[0]).max()


@pytest.mark.parametrize("arm", MACHINES, ids=lambda arm: arm.name)
def test_shorter_steps_make_the_same_motion(arm):
    """The same commands, each held for two samples of half the length."""
    whole, half = (rough(arm).plant(interval) for interval in (INTERVAL, INTERVAL / 2))
    for plant in (whole, half):
        plant.place()
    coarse, fine = whole.replay(steps(arm)), half.replay(np.repeat(steps(arm), 2))[::2]
    assert np.abs(coarse - fine).max() < 1e-4 * np.abs(fine).max()


@pytest.mark.parametrize("arm", MACHINES, ids=lambda arm: arm.name)
def test_uneven_samples_are_those_of_the_even_plant(arm):
    even, uneven = (rough(arm).plant(INTERVAL) for _ in range(2))
    for plant in (even, uneven):
        plant.place()
    commands = steps(arm)
    found = uneven.replay(commands, np.full(len(commands), INTERVAL))
    expected = even.replay(commands)
    assert np.abs(found - expected).max() < 1e-6 * np.abs(expected).max()


@pytest.mark.parametrize("arm", MACHINES, ids=lambda arm: arm.name)
def test_a_machine_is_read_back_bit_for_bit(arm, tmp_path):
    rough(arm).save(tmp_path / "arm.toml")
    assert Arm.load(tmp_path / "arm.toml") == rough(arm)


@pytest.mark.parametrize("arm", [servo(), elastic_joint().with_effect("stiffening")], ids=["servo", "spring"])
def test_derivatives_are_refused_where_there_are_none(arm):
    with pytest.raises(InputError, match=r"by which there are no derivatives: take differences"):
        simulate(arm, "pulse", duration=0.1, rate=200.0, derivatives=["link.inertia"])


def test_a_pendulum_has_derivatives():
    arm, step = pendulum(), 1e-5
    run, slopes = simulate(arm, "pulse", duration=1.5, rate=100.0, noise=False, derivatives=["link.mass", "link.inertia"])
    for path in ("link.mass", "link.inertia"):
        size = step * arm.value(path)
        ends = [simulate(arm.with_values({path: arm.value(path) + s * size}), run, noise=False) for s in (1.0, -1.0)]
        expected = (ends[0].signals["arm_angle"] - ends[1].signals["arm_angle"]) / (2.0 * size)
        assert np.abs(slopes[path]["arm_angle"] - expected).max() < 1e-4 * np.abs(expected).max()


@pytest.mark.parametrize("command", ["voltage", "position"])
def test_a_drive_that_is_off_neither_drives_nor_brakes(command):
    drive = dict(servo().constants["drive"]) if command == "position" else dict(elastic_joint().constants["drive"])
    table = {"drive": {"input": command, **drive, "enabled": 0}, "link": LINK, "sensors": {"arm_angle": {}, "motor_speed": {}}}
    plant = Arm.from_table(table, "off").plant(INTERVAL)
    plant.place(np.array([0.01, 0.0]))
    inertia = 0.025 + drive["gear_ratio"] ** 2 * drive["motor_inertia"]
    angle = plant.replay(np.full(4000, 1.0))[:, 0]
    assert period(angle) == pytest.approx(2.0 * np.pi * np.sqrt(inertia / (0.5 * 0.2 * GRAVITY)), rel=1e-4)
    assert np.abs(angle[-1000:]).max() == pytest.approx(0.01, rel=1e-3)
