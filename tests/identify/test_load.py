"""A payload that a recording states is carried by the arm that is held against it, and by no other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import rig

from flexarm_env import Arm, InputError, Recording, compare, diagnose, fit, simulate
from flexarm_env.identify.explain.comparison import Comparison

PAYLOAD = 0.3


def measured(payload: float, seed: int, duration: float = 3.0) -> Recording:
    """A recording of the independent rig, which says what it carried."""
    made = rig.simulate({"payload": payload}, "square", seed, duration=duration)
    signals = {name: made[name] for name in rig.SIGNALS}
    conditions = {"payload": payload} if payload else {}
    return Recording.from_arrays(f"with {payload:g} kg", made["time"], "current", made["current"], signals, None, conditions)


@pytest.fixture(scope="module")
def arm() -> Arm:
    return Arm.load("thesis-fem")


@pytest.fixture(scope="module")
def pair() -> list[Recording]:
    return [measured(0.0, seed=1), measured(PAYLOAD, seed=2)]


def error_of(result: Comparison, name: str) -> float:
    return next(r.error for r in result.rows if (r.recording, r.signal, r.part) == (name, "all", "all"))


def curves(result: Comparison) -> bytes:
    return b"".join(values.tobytes() for r in result.replays for kind in (r.free, r.windows) for values in kind.values())


def test_each_recording_is_replayed_with_its_own_payload(arm, pair):
    found = compare(arm, pair)
    assert [error_of(found, r.name) < 1.15 for r in pair] == [True, True]
    unsaid = compare(arm, [replace(r, conditions={}) for r in pair])
    assert error_of(unsaid, pair[0].name) == error_of(found, pair[0].name)
    assert error_of(unsaid, pair[1].name) > 3.0


def test_it_is_said(arm, pair):
    notes = [note for note in compare(arm, pair).notes if "payload" in note]
    assert len(notes) == 1
    assert pair[1].name in notes[0]
    assert "0.3 kg" in notes[0]


def test_it_equals_the_effect_and_adds_to_it(arm, pair):
    told = pair[1]
    silent = replace(told, conditions={})
    expected = curves(compare(arm.with_effect("payload", mass=PAYLOAD), [silent]))
    assert curves(compare(arm, [told])) == expected
    half = replace(told, conditions={"payload": 0.5 * PAYLOAD})
    assert curves(compare(arm.with_effect("payload", mass=0.5 * PAYLOAD), [half])) == expected


def test_a_stated_nothing_is_nothing(arm, pair):
    none = replace(pair[0], conditions={"payload": 0.0})
    assert curves(compare(arm, [none])) == curves(compare(arm, [pair[0]]))


@pytest.mark.parametrize("torque_noise", [0.0, pytest.param(0.02, marks=pytest.mark.slow)])
def test_a_fit_to_both_explains_both(arm, pair, torque_noise):
    start = arm.with_values({"drive.torque_noise": torque_noise})
    found = fit(start, pair)
    assert found.error["refitted"] < 1.15
    assert "payload" not in found.arm.effects
    mass = next(e for e in found.estimates if e.path == "beam.mass_per_length")
    assert mass.low < arm.value("beam.mass_per_length") < mass.high
    unsaid = fit(start, [replace(r, conditions={}) for r in pair])
    assert unsaid.error["refitted"] > 1.3 * found.error["refitted"]


@pytest.mark.slow
def test_nothing_is_missing_once_it_is_said(arm, pair):
    assert diagnose(arm, pair, jobs=1).verdict == "nothing_missing"


def test_an_arm_without_a_beam_cannot_carry_it():
    rigid = Arm.load("cu-rigid")
    time = np.arange(100) * 0.01
    signals = {"arm_angle": np.sin(time)}
    told = Recording.from_arrays("run", time, "voltage", np.cos(time), signals, None, {"payload": PAYLOAD})
    for work in (compare, fit, simulate):
        with pytest.raises(InputError, match=r"run states a payload of 0.3 kg, but arm .* has no tip to carry it"):
            work(rigid, told if work is simulate else [told])


def test_commands_are_played_with_the_payload_and_the_result_says_so(arm, pair, tmp_path):
    played = simulate(arm, pair[1], noise=False)
    loaded = simulate(arm.with_effect("payload", mass=PAYLOAD), replace(pair[1], conditions={}), noise=False)
    assert all((played.signals[s] == loaded.signals[s]).all() for s in arm.signals)
    played.write(tmp_path / "played.csv")
    assert Recording.read(tmp_path / "played.csv").conditions == {"payload": PAYLOAD}
    assert loaded.conditions == {}
