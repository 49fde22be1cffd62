"""A caller of the command line, recordings, and quick stand-ins for the identification."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest
from cli_stand_ins import GAP, KPHI, Call, fake_compare, fake_diagnosis

import flexarm_env
from flexarm_env.arm import Arm
from flexarm_env.experiments.simulate import simulate
from flexarm_env.identify.inspect.inspection import Inspection
from flexarm_env.identify.results import Addition, Fit


@pytest.fixture
def flexarm(capsys) -> Call:
    return Call(capsys)


@pytest.fixture(scope="module")
def arm() -> Arm:
    return Arm.load("thesis")


@pytest.fixture(scope="module")
def runs(arm, tmp_path_factory) -> Path:
    """A folder with two short recordings."""
    folder = tmp_path_factory.mktemp("runs")
    for name in ("pulse", "square"):
        simulate(arm, name, duration=1.0, rate=200.0).write(folder / f"{name}.csv")
    return folder


@pytest.fixture
def identify(monkeypatch) -> SimpleNamespace:
    """Quick stand-ins for the identification, which record what they were called with."""
    calls = SimpleNamespace(log=[], verdict="effects", effects=("backlash",), final=1.02, inspects=False)

    inspected = flexarm_env.inspect_recordings

    def compare(arm, recordings, progress=None, rate=None):
        calls.log.append(("compare", arm, recordings))
        return fake_compare(arm, recordings)

    def diagnose(arm, recordings, progress=None, seed=0, jobs=2, rate=None, time_limit=None):
        calls.log.append(("diagnose", arm, recordings, seed, jobs))
        return fake_diagnosis(arm, calls.verdict, calls.effects, seed)

    def add(effect, arm, recordings, progress=None, seed=0, rate=None):
        calls.log.append(("add", effect, arm, recordings, seed))
        error = {"nominal": 4.1, "refitted": 3.7, "final": calls.final}
        return Addition(arm.with_effect(effect), effect, [GAP, KPHI], error, error, 1.0)

    def fit(arm, recordings, progress=None, seed=0, rate=None):
        calls.log.append(("fit", arm, recordings, seed))
        error = {"nominal": 4.1, "refitted": 3.7}
        return Fit(arm.with_values({"drive.torque_constant": 0.3312}), [KPHI], error, error, 1.0)

    def inspect_recordings(arm, recordings):
        return inspected(arm, recordings) if calls.inspects else Inspection((), (), tuple(recordings), 0.0)

    for function in (compare, diagnose, add, fit, inspect_recordings):
        monkeypatch.setitem(vars(flexarm_env), function.__name__, function)
    return calls
