"""The truth simulator against closed forms, energy, its own promises, and the practice recordings."""

from __future__ import annotations

import ast
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import rig
from rig.beam import CLAMPED_ROOTS, PINNED_ROOTS, build
from rig.make_case import main
from scipy.linalg import eigh
from work import ends

EI, DENSITY = 7.911, 0.42381  # Nm², kg/m
TIMESCALE = np.sqrt(EI / DENSITY)  # of a beam of 1 m [1/s]
NO_FRICTION = dict.fromkeys(("tmf", "tms", "taf", "tas", "bm", "bs"), 0.0)
EVERY = rig.EXAMPLES | rig.OUTSIDE
HERE = Path(__file__).resolve().parent


def push(amps: float, seconds: float, rest: float, rate: float = 500.0) -> np.ndarray:
    """Current [A] for some seconds, then none."""
    return np.concatenate([np.full(round(seconds * rate), amps), np.zeros(round(rest * rate))])


def peak(signal: np.ndarray, rate: float = 500.0) -> float:
    """Frequency [Hz] of the largest line, by parabola through the windowed spectrum's three largest points."""
    spectrum = np.log(np.abs(np.fft.rfft((signal - signal.mean()) * np.hanning(signal.size), 8 * signal.size)))
    k = 1 + int(spectrum[1:-1].argmax())
    a, b, c = spectrum[k - 1 : k + 2]
    return (k + 0.5 * (a - c) / (a - 2 * b + c)) * rate / (8 * signal.size)


@pytest.fixture(scope="module")
def nominal() -> dict[str, np.ndarray]:
    return rig.simulate({}, "sweep", seed=1, duration=6.0)


def test_clamped_frequencies_match_the_closed_form() -> None:
    exact = np.square(CLAMPED_ROOTS) * TIMESCALE
    fine = np.sqrt(build(EI, DENSITY, 1.0, elements=24).omega2[:6])
    practice = np.sqrt(build(EI, DENSITY, 1.0).omega2[:6])
    np.testing.assert_allclose(fine, exact, rtol=3e-4)
    np.testing.assert_allclose(practice[:3], exact[:3], rtol=3e-3)


def test_pinned_frequencies_match_the_closed_form() -> None:
    beam = build(EI, DENSITY, 1.0, elements=24, modes=48)
    mass = np.eye(49)
    mass[0, 0] = beam.inertia
    mass[0, 1:] = mass[1:, 0] = beam.coupling
    omega2 = eigh(np.diag([0.0, *beam.omega2]), mass, eigvals_only=True)
    np.testing.assert_allclose(np.sqrt(omega2[1:4]), np.square(PINNED_ROOTS) * TIMESCALE, rtol=1e-4)


def test_payload_and_root_spring_lower_the_clamped_frequency() -> None:
    payload = build(EI, DENSITY, 1.0, payload=0.3).omega2[0]
    assert np.sqrt(payload) / 2 / np.pi == pytest.approx(1.225, rel=2e-3)
    soft = build(EI, DENSITY, 1.0, root_compliance=0.02).omega2[0]
    assert soft < 0.9 * build(EI, DENSITY, 1.0).omega2[0]


def test_free_hub_rings_pinned_and_stuck_hub_clamped() -> None:
    free = rig.simulate(NO_FRICTION, push(1.0, 0.05, 7.95), 0)
    assert peak(free["true_strain_mid"][500:]) == pytest.approx(8.69, rel=3e-3)
    stuck = rig.simulate({"beam_damp": 1e-3}, push(3.0, 0.5, 9.5), 0)
    assert not stuck["true_hub_speed"][3000:].any()
    assert peak(stuck["true_strain_base"][3000:]) == pytest.approx(2.418, rel=2e-3)


@pytest.mark.parametrize("settings", [{}, {"gap": 0.06}, {"beam_damp": 0.01}, {"drag": 0.3}], ids=str)
def test_energy_never_rises_without_input(settings: dict[str, float]) -> None:
    energy = rig.simulate(settings, push(3.0, 0.4, 2.6), 0)["true_energy"][201:]
    assert np.diff(energy).max() < 1e-5 * energy.max()
    assert energy[-1] < 0.5 * energy[0]


def test_energy_stays_without_losses() -> None:
    energy = rig.simulate(NO_FRICTION | {"mesh_c": 0.0}, push(3.0, 0.2, 4.0), 0)["true_energy"][101:]
    np.testing.assert_allclose(energy, energy[0], rtol=1e-3)


def test_hub_sticks_exactly_under_load_and_breaks_away() -> None:
    held = rig.simulate({}, np.full(1000, 0.4), 0)
    assert not held["true_arm_angle"].any()
    assert not held["true_motor_speed"][-100:].any()
    assert held["true_strain_base"][-1] == 0.0
    assert rig.simulate({}, np.full(1000, 0.8), 0)["true_arm_angle"][-1] > 0.1


def test_same_seed_same_bits_other_seed_other_run() -> None:
    one, again, other = (rig.simulate({"gap": 0.05}, "sweep", seed, duration=0.5) for seed in (3, 3, 4))
    assert all(np.array_equal(one[name], again[name]) for name in one)
    assert not np.array_equal(one["current"], other["current"])
    assert not np.array_equal(one["arm_angle"], other["arm_angle"])


def test_fixed_experiments_do_not_depend_on_the_seed() -> None:
    one, other = (rig.simulate({}, "pulse", seed, duration=1.2, vary=False) for seed in (3, 4))
    assert np.array_equal(one["true_arm_angle"], other["true_arm_angle"])
    assert one["current"][250] == 3.0
    assert one["current"][500] == 0.0


def test_every_catalogue_effect_has_a_setting_and_an_example() -> None:
    assert rig.CATALOGUE.keys() == rig.EXAMPLES.keys()
    assert all(rig.CATALOGUE[effect] in example for effect, example in rig.EXAMPLES.items())
    assert all(name in str(rig.__doc__) for example in EVERY.values() for name in example)
    with pytest.raises(KeyError, match="friktion"):
        rig.simulate({"friktion": 1.0}, "pulse", 0)


@pytest.mark.parametrize("effect", EVERY)
def test_every_effect_shows(effect: str, nominal: dict[str, np.ndarray]) -> None:
    made = rig.simulate(EVERY[effect], "sweep", seed=1, duration=6.0)
    change = [np.sqrt(np.mean((made[s] - nominal[s]) ** 2)) / f for s, f in zip(rig.SIGNALS, rig.FLOOR, strict=True)]
    assert np.isfinite(change).all()
    assert max(change) > 0.5


def test_scale_factors_act_on_constants(nominal: dict[str, np.ndarray]) -> None:
    scaled = rig.simulate({"ei_x": 1.2, "ksg_x": 0.9}, "sweep", seed=1, duration=6.0)
    spelt = rig.simulate({"ei": 1.2 * 7.911, "ksg": 0.9 * 2.27}, "sweep", seed=1, duration=6.0)
    assert all(np.array_equal(scaled[name], spelt[name]) for name in scaled)
    assert not np.array_equal(scaled["strain_mid"], nominal["strain_mid"])


def test_step_is_small_enough() -> None:
    coarse, fine = (rig.simulate({}, push(3.0, 0.5, 1.5), 0, step=step) for step in (1e-5, 2.5e-6))
    for signal, floor in zip(rig.SIGNALS, rig.FLOOR, strict=True):
        assert np.abs(coarse["true_" + signal] - fine["true_" + signal]).max() < floor


def test_case_is_written_in_the_practice_format(tmp_path: Path) -> None:
    main([str(tmp_path), "--seed", "5", "--set", "backlash=0.06", "bs_x=1.1"])
    lines = (tmp_path / "square.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0] == "time [s],current [A],arm_angle [rad],motor_speed [rad/s],strain_mid [V],strain_base [V]"
    assert [len(cell.split(".")[1]) for cell in lines[1].split(",")] == [4, 5, 4, 3, 4, 4]
    assert len(lines) == 5001
    read = rig.read_recording(tmp_path / "sweep.csv")
    made = rig.simulate({"gap": 0.06, "bs_x": 1.1}, "sweep", 5)
    for name in ("time", "current", *rig.SIGNALS):
        np.testing.assert_allclose(read[name], made[name], atol=6e-6)


def test_rig_shares_no_code_with_the_package() -> None:
    for file in (HERE / "rig").glob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            assert not any(name.startswith("flexarm") for name in names), file


def errors(folder: Path, run: str, settings: dict[str, float]) -> np.ndarray:
    """Residual over noise, (5000, 4)."""
    return rig.replay(settings, rig.read_recording(folder / f"{run}.csv"))


@pytest.mark.parametrize("run", ["pulse", "square", "sweep"])
def test_practice_run_is_replayed_to_its_noise(measurements: Path, run: str) -> None:
    e = errors(measurements / "practice" / "p01", run, {})
    assert np.sqrt(np.mean(e**2, axis=0)).max() < 1.04


@pytest.mark.slow
@pytest.mark.parametrize("case", ["p02", "p03", "p05", "p06", "p07", "p08", "p09", "p10"])
def test_hidden_settings_are_replayed_to_the_noise(measurements: Path, case: str) -> None:
    hidden = json.loads((measurements / "practice" / "truth.json").read_text())[case]["settings"]
    for run in ("pulse", "square", "sweep"):
        e = errors(measurements / "practice" / case, run, hidden)
        assert np.sqrt(np.mean(e**2, axis=0)).max() < 1.05


@pytest.mark.slow
@pytest.mark.parametrize("run", ["pulse", "square", "sweep"])
def test_backlash_is_replayed_until_chaos(measurements: Path, run: str) -> None:
    """Impacts in the gap double the smallest difference: after some five seconds a free run has no prediction."""
    e = errors(measurements / "practice" / "p04", run, {"gap": 0.06})[:1000]
    assert np.sqrt(np.mean(e**2, axis=0)).max() < 1.1


@pytest.mark.slow
def test_command_line_makes_a_case(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "tests.rig.make_case", str(tmp_path), "--seed", "2", "--set", "stribeck=0.1"]
    done = subprocess.run(command, cwd=HERE.parent, capture_output=True, text=True, check=True)
    assert json.loads(done.stdout)["settings"] == {"stribeck": 0.1}
    assert len(list(tmp_path.glob("*.csv"))) == 3


@pytest.mark.slow
def test_ten_seconds_end_soon() -> None:
    with ends(15.0):
        rig.simulate({"drag": 0.2, "gap": 0.02}, "square", 0)
