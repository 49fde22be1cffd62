"""Numbers at the ends of the range of floats, in files and maps: one line each, and no warning, which is an error in tests."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
from recording_files import refusal, save

MAP: dict[str, Any] = {
    "time": {"column": "t", "unit": "s"},
    "current": {"column": "i", "unit": "A"},
    "arm_angle": {"column": "phi", "unit": "rad"},
}
ROWS = "t,i,phi,k\n0,1,0.5,{}\n0.1,2,0.6,{}\n0.2,3,0.7,3\n"


def changed(name: str, **entry: Any) -> dict[str, Any]:
    return MAP | {name: MAP[name] | entry}


@pytest.mark.parametrize(
    ("table", "words"),
    [
        (changed("arm_angle", shift=1e308), "column 'arm_angle': shift is 1e+308 s, but the recording lasts 0.2 s; correct it"),
        (changed("time", shift=-1e308), "column 'arm_angle': shift is -1e+308 s, but the recording lasts 0.2 s"),
        (changed("arm_angle", shift="0.3 s"), "column 'arm_angle': shift is 0.3 s, but the recording lasts 0.2 s"),
        (MAP | {"time": {"rate": 1e-308}}, "column 'time': is inf"),
    ],
)
def test_a_map_of_such_numbers_is_refused(tmp_path: Path, table: dict[str, Any], words: str) -> None:
    assert words in refusal(save(tmp_path, ROWS.format(3, 3)), columns=table)


@pytest.mark.parametrize("wrap", [6.28, 1e308])
def test_wrapped_readings_of_such_numbers_are_named(tmp_path: Path, wrap: float) -> None:
    rows = ROWS.format(3, 3).replace("0.5", "1e308").replace("0.6", "-1e308")
    message = refusal(save(tmp_path, rows), columns=changed("arm_angle", wrap=wrap))
    assert message.startswith("row 2, column 'arm_angle': is 1e+308 in SI units")


@pytest.mark.parametrize("scale", [1e-310, 1e-320, 0.001])
def test_stamps_of_any_scale_are_refused(tmp_path: Path, scale: float) -> None:
    rows = "t,i,phi\n" + "".join(f"10:00:0{k}.0,1,{k}\n" for k in range(3))
    assert f"column 'time': scale is {scale!r}, but its times have a unit of their own; leave scale out" in refusal(
        save(tmp_path, rows), columns=changed("time", scale=scale)
    )


@pytest.mark.parametrize(
    ("how", "numbers", "words"),
    [
        ("mean", ("inf", "-inf"), "condition 'k': 'k' has inf; correct it"),
        ("split", ("inf", "-inf"), "condition 'k': 'k' has inf; correct it"),
        ("mean", ("1.7e308", "1.6e308"), "condition 'k' is inf; write a finite number"),
    ],
)
def test_a_condition_of_such_numbers_is_refused(tmp_path: Path, how: str, numbers: tuple[str, str], words: str) -> None:
    table = MAP | {"conditions": {"k": {"column": "k", "unit": "1", how: True}}}
    assert words in refusal(save(tmp_path, ROWS.format(*numbers)), columns=table)


@pytest.mark.parametrize(
    ("step", "entry", "words"),
    [
        (1e308, {"unit": "s"}, "column 'time': is inf"),
        (1e-320, {"unit": "Hz", "scale": 1e-9}, "'Ts' is one number, 0.0; it must be the time between samples"),
    ],
)
def test_a_sample_time_of_such_a_number_is_refused(tmp_path: Path, step: float, entry: dict[str, Any], words: str) -> None:
    scipy.io.savemat(tmp_path / "run.mat", {"Ts": step, "u": np.ones(5), "q": np.arange(5.0)})
    places = {name: {"variable": place, "unit": MAP[name]["unit"]} for name, place in (("current", "u"), ("arm_angle", "q"))}
    assert words in refusal(tmp_path / "run.mat", columns={"time": {"variable": "Ts", **entry}, **places})


@pytest.mark.parametrize(
    ("commands", "readings", "words"),
    [
        (("-9e307", "9e307"), ("0", "1"), "the time of 'current' leaps beyond any number after its sample 1; correct it"),
        (("0", "1"), ("-9e307", "9e307"), "the time of 'arm_angle' leaps beyond any number after its sample 1; correct it"),
        (("-9e307", "-8e307"), ("9e307", "9.1e307"), "the time of 'arm_angle' leaps beyond any number after its sample 1"),
    ],
)
def test_files_of_such_times_are_refused(
    tmp_path: Path, commands: tuple[str, str], readings: tuple[str, str], words: str
) -> None:
    path = save(tmp_path, "t,i\n{},1\n{},1\n".format(*commands), "m_command.csv")
    save(tmp_path, "t,phi\n{},1\n{},1\n".format(*readings), "m_encoder.csv")
    table = {
        "time": MAP["time"],
        "current": MAP["current"] | {"file": "*_command.csv"},
        "arm_angle": MAP["arm_angle"] | {"file": "*_encoder.csv"},
    }
    assert words in refusal(path, columns=table)
