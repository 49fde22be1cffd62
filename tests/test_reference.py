"""The reference solver against the notes' figures, exact identities, and a second solver."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from reference import ReferenceArm, frequencies, pulse_current, white_noise_current, witness
from reference.arm import Array

DT = 0.005  # s
SIGNALS = ("hub_angle", "hub_speed", "tip", "tip_slope")
CLOSE = 1e-12 if np.finfo(np.longdouble).eps < 1e-18 else 1e-9  # the witness is as good as its long double
COUPLED = np.array([[0.02, 0.004, -0.001], [0.004, 0.003, 0.0], [-0.001, 0.0, 0.002]])
ARMS = {
    "thesis": ReferenceArm(),
    "payload": ReferenceArm(elements=2, payload=0.3),
    "three elements": ReferenceArm(elements=3),
    "no stiction": ReferenceArm(static=0.282, coulomb=0.282),
    "no friction": ReferenceArm(static=0.0, coulomb=0.0, viscous=0.0),
    "damped beam": ReferenceArm(elements=2, beam_damping=1e-3),
    "cable": ReferenceArm(cable_stiffness=2.0),
    "coupled damping": ReferenceArm(extra_damping=COUPLED, cable_stiffness=0.5, beam_damping=1e-4),
}


def distance(a: dict[str, Any], b: dict[str, Any]) -> float:
    """Largest difference of a signal, relative to that signal's largest value; the worst signal's."""
    return max(np.abs(a[name] - b[name]).max() / np.abs(b[name]).max() for name in SIGNALS)


def loaded(arm: ReferenceArm, force: float) -> Array:
    """Static shape q (size,) under a force [N] at the tip, hub at 0 rad."""
    load = np.zeros(arm.size - 1)
    load[-2] = force
    return np.concatenate([[0.0], np.linalg.solve(arm.K[1:, 1:], load)])


@pytest.fixture(scope="module")
def pulse() -> dict[str, Any]:
    """The thesis's pulse through the thesis's arm, at the tighter tolerance."""
    return ReferenceArm().simulate(pulse_current(), DT, rtol=1e-13)


@pytest.mark.parametrize(
    ("elements", "hub", "payload", "expected"),
    [
        (1, "bare", 0.0, [12.06, 48.19]),
        (1, "free", 0.0, [8.964, 29.62]),
        (1, "clamped", 0.0, [2.429, 23.93]),
        (1, "free", 0.3, [6.911]),
        (1, "clamped", 0.3, [1.225]),
        (16, "bare", 0.0, [10.60, 34.36]),
        (16, "free", 0.0, [8.690, 20.25]),
        (16, "clamped", 0.0, [2.418, 15.15]),
    ],
)
def test_frequencies_of_the_notes(elements: int, hub: str, payload: float, expected: list[float]) -> None:
    found = frequencies(elements, hub, payload)
    assert [float(f"{value:.4g}") for value in found[: len(expected)]] == expected


def test_frequencies_converge_to_the_continuous_beam() -> None:
    scale = np.sqrt(68.944e9 * 1.1475e-10 / 0.42381) / (2 * np.pi)
    roots = {"bare": [3.926602, 7.068583], "clamped": [1.875104, 4.694091]}  # of tan = tanh, cos cosh = -1
    for hub, beta in roots.items():
        np.testing.assert_allclose(frequencies(32, hub)[:2], scale * np.square(beta), rtol=5e-6)


def test_frequencies_refuses_an_unknown_hub() -> None:
    with pytest.raises(ValueError, match="clamped"):
        frequencies(1, "pinned")


def test_one_element_has_the_matrices_and_torques_of_the_notes() -> None:
    arm = ReferenceArm(payload=0.3)
    mass = 0.42381 / 420 * np.array([[4, 13, -3], [13, 156, -22], [-3, -22, 4]])
    mass += np.diag([1.5**2 * 0.00193 + 0.00129, 0.3, 0.0])
    stiffness = 68.944e9 * 1.1475e-10 * np.array([[4, -6, 2], [-6, 12, -6], [2, -6, 4]])
    np.testing.assert_allclose(arm.M, mass, rtol=1e-14)
    np.testing.assert_allclose(arm.K, stiffness, rtol=1e-14)
    np.testing.assert_allclose(arm.B, np.diag([0.1018, 0.0, 0.0]), rtol=1e-14)
    np.testing.assert_allclose([arm.coulomb, arm.static], [0.282, 0.358045], rtol=1e-14)


def test_static_below_coulomb_is_refused() -> None:
    with pytest.raises(ValueError, match="total"):
        ReferenceArm(static=0.1, coulomb=0.2)


@pytest.mark.parametrize("elements", [1, 2, 3, 7])
def test_beam_turns_freely_and_keeps_its_inertia(elements: int) -> None:
    arm = ReferenceArm(elements=elements)
    np.testing.assert_allclose(arm.K_beam @ arm.rigid, 0.0, atol=1e-11)
    assert arm.rigid @ arm.M_bare @ arm.rigid == pytest.approx(0.42381 / 3, rel=1e-13)


@pytest.mark.parametrize("elements", [1, 3, 4])
def test_moment_of_a_static_tip_force(elements: int) -> None:
    arm = ReferenceArm(elements=elements)
    q = np.array([loaded(arm, 1.3), loaded(arm, 1.3) + 0.7 * arm.rigid])  # the second one turned by 0.7 rad
    np.testing.assert_allclose(arm.moment_at(0.55, q), 0.45 * 1.3, rtol=1e-12)
    np.testing.assert_allclose(arm.moment_at(0.0, q), 1.3, rtol=1e-12)
    assert q[0, -2] == pytest.approx(1.3 / (3 * arm.rigidity), rel=1e-12)


def test_pulse_ends_where_the_notes_say(pulse: dict[str, Any]) -> None:
    assert np.degrees(pulse["hub_angle"][-1]) == pytest.approx(157.9, abs=0.05)
    assert pulse["event_times"][-1] == pytest.approx(2.19, abs=0.005)
    assert pulse["event_kinds"].tolist() == [1, 0, 1, 0]
    assert pulse["events"] == 4
    np.testing.assert_array_equal(pulse["stuck"], pulse["hub_speed"] == 0.0)
    rest = pulse["time"] > pulse["event_times"][-1]
    assert np.unique(pulse["hub_angle"][rest]).size == 1  # no creep, to the last bit


def test_pulse_agrees_at_two_tolerances_and_with_the_witness(pulse: dict[str, Any]) -> None:
    looser = ReferenceArm().simulate(pulse_current(), DT, rtol=1e-12)
    assert distance(looser, pulse) < 5e-12
    assert distance(witness(ReferenceArm(), pulse_current(), DT), pulse) < CLOSE


def test_stuck_beam_keeps_its_energy_and_frequency() -> None:
    arm = ReferenceArm()
    start = np.concatenate([loaded(arm, 0.2), np.zeros(3)])
    run = arm.simulate(np.zeros(200), DT, start=start)
    assert run["stuck"].all()
    assert run["events"] == 0
    np.testing.assert_allclose(run["energy"], run["energy"][0], rtol=2e-11)
    squares, shapes = np.linalg.eig(np.linalg.solve(arm.M[1:, 1:], arm.K[1:, 1:]))
    modal = np.linalg.solve(shapes, start[1:3])
    exact = np.cos(np.outer(run["time"], np.sqrt(squares))) * modal @ shapes.T
    np.testing.assert_allclose(run["state"][:, 1:3], exact, atol=1e-11 * np.abs(exact).max())


def test_slipping_hub_obeys_the_balance_of_angular_momentum() -> None:
    arm = ReferenceArm(elements=2, payload=0.1)
    start = np.concatenate([np.zeros(arm.size), 2.0 * arm.rigid])
    run = arm.simulate(np.full(100, 3.0), DT, start=start)
    assert run["events"] == 0
    momentum = run["state"][:, arm.size :] @ arm.M @ arm.rigid + arm.viscous * run["hub_angle"]
    torque = 1.5 * 0.33 * 3.0 - arm.coulomb
    np.testing.assert_allclose(momentum, momentum[0] + torque * run["time"], rtol=1e-12)


@pytest.mark.parametrize("name", ["thesis", "payload", "no stiction", "damped beam", "cable", "coupled damping"])
def test_energy_never_grows_without_current(name: str) -> None:
    arm = ARMS[name]
    start = np.concatenate([loaded(arm, 6.0), 0.5 * arm.rigid])
    run = arm.simulate(np.zeros(200), DT, start=start)
    assert run["events"] > 0
    assert np.diff(run["energy"]).max() <= 1e-12 * run["energy"][0]
    assert run["energy"][-1] < 0.9 * run["energy"][0]


@pytest.mark.parametrize("name", ARMS)
def test_two_solvers_agree_under_white_noise(name: str) -> None:
    current = white_noise_current(seed=7, steps=80)
    run = ARMS[name].simulate(current, DT, rtol=1e-13)
    assert run["events"] > 10
    assert distance(run, witness(ARMS[name], current, DT)) < CLOSE


def test_touch_of_zero_speed_inside_a_solver_step_is_seen() -> None:
    arm, coasting = ReferenceArm(), np.zeros(12)

    def start(hub_speed: float) -> Array:
        return np.concatenate([-loaded(arm, 0.15), hub_speed * arm.rigid])

    touches, misses = 0.6, 0.8  # rad/s: the vibration takes the slower hub to rest, not the faster
    while misses - touches > 1e-9:  # to a dip of 1e-9 rad/s that lasts about 1e-5 s, where a step lasts 1e-3 s
        middle = 0.5 * (touches + misses)
        found = arm.simulate(coasting, DT, start=start(middle))["events"] > 0
        touches, misses = (middle, misses) if found else (touches, middle)
    runs = [arm.simulate(coasting, DT, start=start(speed)) for speed in (touches, misses)]
    assert [run["events"] for run in runs] == [2, 0]  # it sticks, then breaks away
    for run, speed in zip(runs, (touches, misses), strict=True):
        assert distance(run, witness(arm, coasting, DT, start(speed))) < 1e-9


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(100, 105))
def test_break_away_without_stiction_does_not_livelock(seed: int) -> None:
    arm, current = ARMS["no stiction"], white_noise_current(seed, 400)
    run = arm.simulate(current, DT, rtol=1e-13)
    assert run["events"] > 100
    assert distance(run, witness(arm, current, DT)) < 100 * CLOSE


@pytest.mark.slow
@pytest.mark.parametrize(("elements", "steps"), [(1, 800), (4, 200)])
@pytest.mark.parametrize("seed", range(10))
def test_two_solvers_agree_over_hundreds_of_mode_changes(elements: int, steps: int, seed: int) -> None:
    arm, current = ReferenceArm(elements=elements), white_noise_current(seed, steps)
    run = arm.simulate(current, DT)
    assert run["events"] > steps / 3
    assert distance(run, witness(arm, current, DT)) < 100 * CLOSE
