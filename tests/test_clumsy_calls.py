"""Arguments of the Python API that are wrong in ways that happen: one line, and not an error from deep inside."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest

import flexarm_env
from flexarm_env import Arm, InputError, Recording, simulate


@pytest.fixture(scope="module")
def arm() -> Arm:
    return Arm.load("cu-rigid")


@pytest.fixture(scope="module")
def run(arm: Arm) -> Recording:
    return simulate(arm, "pulse", duration=2.0, rate=200.0)


WITH_RECORDINGS: dict[str, Callable[..., object]] = {
    "compare": flexarm_env.compare,
    "fit": flexarm_env.fit,
    "add": lambda arm, recordings: flexarm_env.add("coulomb", arm, recordings),
    "diagnose": flexarm_env.diagnose,
    "inspect_recordings": flexarm_env.inspect_recordings,
}


@pytest.mark.parametrize("function", WITH_RECORDINGS)
def test_what_is_no_list_of_recordings_is_refused(function, arm, run):
    work = WITH_RECORDINGS[function]
    for given, kind in ((run, "Recording"), ("runs/pulse.csv", "str"), ([run, "b.csv"], "str"), (None, "NoneType")):
        with pytest.raises(InputError, match=f"recordings: {kind} where a list of Recording belongs") as error:
            work(arm, given)
        assert "\n" not in str(error.value)


@pytest.mark.parametrize("function", sorted(set(WITH_RECORDINGS) - {"add"}))
def test_the_name_of_an_arm_is_no_arm(function, run):
    with pytest.raises(InputError, match="the arm is 'thesis', of type str; give an Arm"):
        WITH_RECORDINGS[function]("thesis", [run])


def test_an_effect_takes_numbers_and_texts_with_a_unit():
    arm = Arm.load("thesis")
    for gap in (0.06, np.float32(0.0625), np.array(0.06), "60 mrad", "0.06"):
        found = arm.with_effect("backlash", gap=gap).effects["backlash"]["gap"]
        assert found == pytest.approx(0.06, abs=0.003)
        assert type(found) is float


@pytest.mark.parametrize("gap", [None, [0.06], True, 1j, "wide", "60 V", float("nan"), -1, 10**400, object()])
def test_an_effect_of_no_size_is_refused(gap):
    arm = Arm.load("thesis")
    with pytest.raises(InputError, match=r"effects\.backlash\.gap") as error:
        arm.with_effect("backlash", gap=gap)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    "path", ["hub.inertai", "hub", "", "hub.inertia.x", "effects.coulomb.torque", "effects", "sensors.tip.gain"]
)
def test_a_path_of_no_value_is_not_passed_over(arm, path):
    with pytest.raises(InputError, match=re.escape(f"arm '{arm.name}' has no value '{path}'")):
        arm.with_values({path: 1.0})
    with pytest.raises(InputError, match=re.escape(f"arm '{arm.name}' has no value '{path}'")):
        arm.value(path)


@pytest.mark.parametrize("jobs", [0, -1, 1.5, "2", None, True])
def test_a_number_of_processes_that_is_none_is_refused(arm, run, jobs):
    with pytest.raises(InputError, match="give a whole number from 1 up"):
        flexarm_env.diagnose(arm, [run], jobs=jobs)


@pytest.mark.parametrize("seed", [-1, 1.5, "1", None])
def test_a_seed_that_is_none_is_refused(arm, seed):
    with pytest.raises(InputError, match="give a whole number from 0 up"):
        simulate(arm, "pulse", duration=1.0, seed=seed)


def test_an_empty_path_is_not_this_folder(tmp_path, monkeypatch, run):
    monkeypatch.chdir(tmp_path)
    run.write("pulse.csv")
    for paths in ("", [""], ["pulse.csv", ""]):
        with pytest.raises(InputError, match="a path is empty"):
            Recording.read_all(paths)
