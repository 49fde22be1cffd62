"""The numbers of the method: each is explained, a change of one shows in its digest, and a diagnosis goes by them."""

from __future__ import annotations

import pickle
from dataclasses import replace

import pytest

from flexarm_env import Arm, Recording, add, diagnose, fit, simulate
from flexarm_env.identify.settings import SETTINGS, Number, Settings

NONE_NAMED = replace(SETTINGS, selecting=replace(SETTINGS.selecting, most_effects=0))


def name_of(number: Number) -> str:
    return f"{number.stage}.{number.name}"


@pytest.fixture(scope="module")
def arm() -> Arm:
    return Arm.load("cu-rigid")


@pytest.fixture(scope="module")
def recordings(arm) -> list[Recording]:
    """A run of two seconds of the arm with Coulomb friction."""
    return [simulate(arm.with_effect("coulomb", torque=0.05), "pulse", duration=2.0, rate=100.0, seed=1)]


def test_every_number_is_explained():
    for number in SETTINGS.numbers():
        assert len(number.meaning) > 1, name_of(number)
        assert number.meaning.endswith("."), name_of(number)
        assert number.found.strip(), name_of(number)


def test_names_are_unique_in_their_stage():
    names = [name_of(number) for number in SETTINGS.numbers()]
    assert len(set(names)) == len(names)
    assert names == [f"{stage}.{name}" for stage, values in SETTINGS.as_json().items() for name in values]


def test_a_changed_number_shows_in_json_and_digest():
    assert Settings().digest() == SETTINGS.digest()
    for number in SETTINGS.numbers():
        stage = getattr(SETTINGS, number.stage)
        value = (*number.value, 1.0) if isinstance(number.value, tuple) else number.value + 1
        changed = replace(SETTINGS, **{number.stage: replace(stage, **{number.name: value})})
        assert changed.as_json()[number.stage][number.name] == value, name_of(number)
        assert changed.digest() != SETTINGS.digest(), name_of(number)


def test_settings_pickle():
    assert pickle.loads(pickle.dumps(NONE_NAMED)) == NONE_NAMED


def test_a_diagnosis_goes_by_its_settings(arm, recordings, tmp_path):
    found = diagnose(arm, recordings, jobs=1)
    assert found.effects == ["coulomb"]
    assert diagnose(arm, recordings, jobs=1, settings=NONE_NAMED).effects == []
    shorter = replace(SETTINGS, preparation=replace(SETTINGS.preparation, held_out_share=0.2))
    other = diagnose(arm, recordings, jobs=1, settings=shorter)
    assert other.error["nominal"] != found.error["nominal"]
    assert other.settings == shorter
    other.arm.save(tmp_path / "arm.toml")
    assert Arm.load(tmp_path / "arm.toml").origin["settings"] == shorter.digest()


def test_a_fit_and_an_added_effect_carry_their_settings(arm, recordings):
    for found in (fit(arm, recordings, settings=NONE_NAMED), add("coulomb", arm, recordings, settings=NONE_NAMED)):
        assert found.settings == NONE_NAMED
        assert found.arm.origin["settings"] == NONE_NAMED.digest()
