"""A clock that starts again: two runs in one file are refused with the row, and named as a fault."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

from flexarm_env import InputError, Recording
from flexarm_env.identify.inspect.restart import restart
from flexarm_env.recordings.clock import RestartError

SPOILS = ("sort", "remove", "delete", "fill")


def text(times) -> str:
    rows = [f"{t!r},0,{i}" for i, t in enumerate(np.asarray(times).tolist())]
    return "\n".join(["time [s],current [A],arm_angle [rad]", *rows, ""])


def refused(tmp_path, times) -> InputError:
    (tmp_path / "run.csv").write_text(text(times))
    with pytest.raises(InputError) as error:
        Recording.read(tmp_path / "run.csv")
    assert not any(word in str(error.value) for word in SPOILS)
    return error.value


def test_two_runs_that_both_start_at_zero(tmp_path):
    run = np.arange(50) / 10
    error = refused(tmp_path, np.r_[run, run])
    assert isinstance(error, RestartError)
    assert (error.sample, error.before, error.after, error.counter) == (50, 4.9, 0.0, 0.0)
    assert str(error).startswith(f"{tmp_path / 'run.csv'}: row 52,")
    assert "holds two runs" in str(error)
    assert "cut it there" in str(error)
    fault = restart(error)
    assert (fault.recording, fault.kind, fault.signal, fault.value, fault.rows) == ("run", "restart", "time", 4.9, (50,))
    assert fault.source == str(tmp_path / "run.csv")


@pytest.mark.parametrize(("modulus", "step"), [(65.536, 0.5), (2.0**32 * 1e-6, 10.0)])
def test_a_counter_that_overflows_is_named_with_its_modulus(tmp_path, modulus, step):
    error = refused(tmp_path, np.round(np.mod(modulus - 20 * step + step * np.arange(60), modulus), 6))
    assert isinstance(error, RestartError)
    assert error.counter == pytest.approx(modulus)
    assert f"overflows at {modulus:.9g} s" in str(error)


@pytest.mark.parametrize(("time", "verb"), [(1.0, "repeats"), (0.93, "goes back")])
def test_one_stamp_that_does_not_rise_is_no_second_run(tmp_path, time, verb):
    times = np.arange(50) / 10
    times[11] = time
    error = refused(tmp_path, times)
    assert not isinstance(error, RestartError)
    assert f"row 13, column 'time': {verb}, {time:.9g} s after 1 s" in str(error)


def test_arrays_are_refused_as_files_are():
    time = np.r_[np.arange(20), np.arange(20)] / 10
    with pytest.raises(RestartError, match=r"^both: sample 21, ") as error:
        Recording.from_arrays("both", time, "current", time, {"arm_angle": time})
    again = pickle.loads(pickle.dumps(error.value))
    assert (str(again), again.sample) == (str(error.value), 20)
