"""MATLAB files, and files of others as they are."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
from recording_files import CU_BOULDER, EMPS, GOOD, LOGGER, refusal, save

from flexarm_env.recordings.recording import Recording


def matlab(folder: Path, **variables: Any) -> Path:
    path = folder / "run.mat"
    good: dict[str, Any] = {
        "t": np.arange(4.0),
        "vir": np.ones((4, 1)),
        "qm": np.arange(4),
        "qg": np.zeros(4),
    }
    scipy.io.savemat(path, good | variables)
    return path


def test_reads_matlab_vectors(tmp_path: Path) -> None:
    recording = Recording.read(matlab(tmp_path), EMPS)
    assert recording.input_kind == "voltage"
    assert recording.signals["arm_angle"].tolist() == [0, 1, 2, 3]


@pytest.mark.parametrize(
    ("variable", "value", "wanted"),
    [
        ("qm", np.ones((4, 2)), "not a vector"),
        ("qm", np.ones(4) * 1j, "not a vector"),
        ("qm", "text", "not a vector"),
        ("qm", {"a": 1}, "not a vector"),
        ("qm", np.ones((0, 0)), "not a vector"),
        ("qm", np.ones(3), "differ in length"),
        (
            "vir",
            np.array([np.nan, np.nan, 2, 3]),
            "sample 1, column 'voltage': is empty, and the first command stands in",
        ),
        ("vir", np.array([0, 1, np.inf, 3]), "sample 3, column 'voltage': is inf"),
        ("qm", np.array([0, 1, np.inf, 3]), "sample 3, column 'arm_angle': is inf"),
        ("t", np.array([0, 1, 1, 3]), "sample 3, column 'time': repeats"),
    ],
)
def test_matlab_variables_are_checked(tmp_path: Path, variable: str, value: Any, wanted: str) -> None:
    assert wanted in refusal(matlab(tmp_path, **{variable: value}), columns=EMPS)


def test_matlab_files_that_do_not_fit(tmp_path: Path) -> None:
    path = matlab(tmp_path)
    table = {**EMPS, "arm_angle": {"variable": "vri", "unit": "rad"}}
    assert "did you mean 'vir'" in refusal(path, columns=table)
    assert "[columns]" in refusal(path)
    assert "use 'variable'" in refusal(path, columns=LOGGER)
    assert "use 'column'" in refusal(save(tmp_path, GOOD), columns=EMPS)


def test_matlab_7_3_and_damage(tmp_path: Path) -> None:
    head = b"MATLAB 7.3 MAT-file".ljust(124, b" ") + b"\x00\x02IM"
    assert "-v7" in refusal(save(tmp_path, head + bytes(512), "run.mat"), columns=EMPS)
    assert "-v7" in refusal(save(tmp_path, b"nothing of the kind", "run.mat"), columns=EMPS)


@pytest.mark.parametrize("compressed", [False, True])
def test_cut_off_matlab_files(tmp_path: Path, compressed: bool) -> None:
    path = matlab(tmp_path)
    variables = {name: value for name, value in scipy.io.loadmat(path).items() if name[0] != "_"}
    scipy.io.savemat(path, variables, do_compression=compressed)
    whole = path.read_bytes()
    assert len(Recording.read(path, EMPS)) == 4
    for size in range(0, len(whole), 7):
        refusal(save(tmp_path, whole[:size], "run.mat"), columns=EMPS)
        zeros = save(tmp_path, whole[:size] + bytes(len(whole) - size), "run.mat")
        if size < len(whole) - 60:  # the last vector is zeros anyway
            refusal(zeros, columns=EMPS)


def test_practice_recordings(measurements: Path) -> None:
    recordings = Recording.read_all(measurements / "practice" / "p01")
    assert [r.name for r in recordings] == ["pulse", "square", "sweep"]
    for recording in recordings:
        raw = np.loadtxt(recording.source, delimiter=",", skiprows=1)
        assert recording.input_kind == "current"
        assert not recording.gaps
        columns = [recording.time, recording.command, *recording.signals.values()]
        assert np.array_equal(np.column_stack(columns), raw)


def test_cu_boulder_recordings(measurements: Path) -> None:
    files = sorted((measurements / "cu_boulder").glob("*.txt"))
    assert len(files) == 6
    for recording in Recording.read_all(files, CU_BOULDER):
        raw = np.loadtxt(recording.source, delimiter="\t", skiprows=1)
        assert np.allclose(recording.time, (raw[:, 0] - raw[0, 0]) / 1000, rtol=0, atol=1e-12)
        assert np.array_equal(recording.signals["arm_angle"], raw[:, 1])
        assert np.array_equal(recording.signals["tip_deflection"], -raw[:, 2])
        assert recording.reference is not None
        assert np.array_equal(recording.reference, raw[:, 5])
        assert np.array_equal(recording.command, raw[:, 6])


@pytest.mark.parametrize("name", ["DATA_EMPS", "DATA_EMPS_PULSES"])
def test_emps_recordings(measurements: Path, name: str) -> None:
    recording = Recording.read(measurements / "emps" / f"{name}.mat", EMPS)
    raw = scipy.io.loadmat(recording.source)
    assert recording.duration == pytest.approx(24.84)
    assert np.array_equal(recording.command, raw["vir"].ravel())
    assert np.array_equal(recording.signals["arm_angle"], raw["qm"].ravel())
