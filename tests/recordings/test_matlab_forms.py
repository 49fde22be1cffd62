"""MATLAB files as QUARC, Simulink and people write them."""

from __future__ import annotations

import io
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from recording_files import refusal, save

from flexarm_env.errors import InputError
from flexarm_env.recordings.formats.matlab_file import variables
from flexarm_env.recordings.formats.matlab_paths import describe_all, find_numbers
from flexarm_env.recordings.recording import Recording

TIME, VOLTS, ANGLE = np.arange(6) / 500, np.array([0.0, 1, 2, 3, 2, 1]), np.array([0.0, 0, 1, 3, 4, 4])
NAMES = {"time": "s", "voltage": "V", "arm_angle": "rad"}


def entries(*places: Any) -> dict[str, dict[str, Any]]:
    """Map time, voltage and angle to places: texts are variables."""
    places = tuple({"variable": place} if isinstance(place, str) else place for place in places)
    return {name: {"unit": unit, **place} for (name, unit), place in zip(NAMES.items(), places, strict=True)}


def written(compressed: bool = False, version: str = "5", **contents: Any) -> bytes:
    file = io.BytesIO()
    scipy.io.savemat(file, contents, do_compression=compressed, format=version)
    return file.getvalue()


def structs(**fields: list[Any]) -> np.ndarray:
    """Make a 1 × n struct array."""
    made = np.empty((1, len(next(iter(fields.values())))), dtype=[(name, object) for name in fields])
    for name, values in fields.items():
        for place, value in enumerate(values):
            made[0, place][name] = value
    return made


def cells(*values: Any) -> np.ndarray:
    made = np.empty((1, len(values)), dtype=object)
    for place, value in enumerate(values):
        made[0, place] = value
    return made


ROWS = np.array([TIME, VOLTS, ANGLE])
SCOPE = {
    "time": TIME[:, None],
    "signals": structs(values=[VOLTS[:, None], ANGLE[:, None], ROWS.T], label=["u", "q", "all"], dimensions=[1, 1, 3]),
    "blockName": "rig/Scope",
}
FORMS: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "rows": (
        {"ans": ROWS},
        entries({"variable": "ans", "row": 0}, {"variable": "ans", "row": 1}, {"variable": "ans", "row": 2}),
    ),
    "rows as MATLAB writes them": ({"ans": ROWS}, entries("ans(1,:)", "ans(2,:)", "ans( 3, : )")),
    "columns": ({"data": ROWS.T}, entries(*({"variable": "data", "index": place} for place in range(3)))),
    "columns as MATLAB writes them": ({"data": ROWS.T}, entries("data(:,1)", "data(:,2)", "data(:,3)")),
    "all of a matrix, and of a row": (
        {"t": TIME.reshape(2, 3, order="F"), "u": VOLTS.reshape(3, 2, order="F"), "q": ANGLE},
        entries("t(:)", "u(:)", "q(:)"),
    ),
    "one element of a matrix": (
        {"T": np.array([[1.0, 0.5], [0.002, 3.0]]), "u": VOLTS, "q": ANGLE},
        entries("T(2)", "u", "q"),
    ),
    "one element by row and column": (
        {"T": np.array([[1.0, 0.002], [0.5, 3.0]]), "u": VOLTS, "q": ANGLE},
        entries("T(1,2)", "u", "q"),
    ),
    "struct": ({"data": {"time": TIME, "u": VOLTS, "q": ANGLE}}, entries("data.time", "data.u", "data.q")),
    "struct in a struct": ({"a": {"b": {"t": TIME, "M": ROWS}}}, entries("a.b.t", "a.b.M(2,:)", {"variable": "a.b.M", "row": 2})),
    "structure with time": (
        {"ScopeData": SCOPE},
        entries("ScopeData.time", "ScopeData.signals(1).values", "ScopeData.signals(2).values"),
    ),
    "structure with time, several in one": (
        {"ScopeData": SCOPE},
        entries("ScopeData.time", "ScopeData.signals(3).values(:,2)", {"variable": "ScopeData.signals(1,3).values", "index": 2}),
    ),
    "cells": (
        {"Time_id": cells(TIME, TIME), "Y_id": cells(0.0, np.array([ANGLE, VOLTS]))},
        entries("Time_id{1}", "Y_id{2}(2,:)", {"variable": "Y_id{1,2}", "row": 0}),
    ),
    "three dimensions": ({"t": TIME, "u": VOLTS.reshape(1, 1, -1), "q": ANGLE}, entries("t", "u", "q")),
    "a sample time": ({"Ts": 0.002, "u": VOLTS, "q": ANGLE}, entries("Ts", "u", "q")),
    "a sample time in ms": ({"Ts": 2, "u": VOLTS, "q": ANGLE}, entries({"variable": "Ts", "unit": "ms"}, "u", "q")),
    "a sample time and a longer condition": (
        {"Ts": 0.002, "u": VOLTS, "q": ANGLE, "k": np.full(50, 7.0)},
        entries("Ts", "u", "q") | {"conditions": {"kp": {"variable": "k", "unit": "1"}}},
    ),
    "a rate": ({"fs": 500, "u": VOLTS, "q": ANGLE}, entries({"variable": "fs", "unit": "Hz"}, "u", "q")),
    "a rate in kHz": ({"fs": 0.5, "u": VOLTS, "q": ANGLE}, entries({"variable": "fs", "unit": "kHz"}, "u", "q")),
    "a rate in the map": ({"u": VOLTS, "q": ANGLE}, entries("t", "u", "q") | {"time": {"rate": 500}}),
    "a rate with a unit": ({"u": VOLTS, "q": ANGLE}, entries("t", "u", "q") | {"time": {"rate": "0.5 kHz"}}),
}


@pytest.mark.parametrize("compressed", [False, True])
@pytest.mark.parametrize("form", FORMS)
def test_forms_are_read(tmp_path: Path, form: str, compressed: bool) -> None:
    contents, table = FORMS[form]
    recording = Recording.read(save(tmp_path, written(compressed, **contents), "run.mat"), table)
    assert np.allclose(recording.time, TIME, rtol=0, atol=1e-15)
    assert np.array_equal(recording.command, VOLTS)
    assert np.array_equal(recording.signals["arm_angle"], ANGLE)


HELD = {"data": SCOPE, "Ts": 0.002, "Y": cells(ROWS), "ans": ROWS, "note": "rig 7", "z": 1j * VOLTS}


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("data.signals(1,4).values", ["1×3", "without an element 1,4"]),
        ("data.signals(2,1).values", ["without an element 2,1"]),
        ("data.signals(1,1,1).values", ["no path of a variable"]),
        ("ans(19)", ["no row 19", "1 to 18"]),
        ("ans(0,:)", ["no row 0", "1 to 3"]),
        ("ans(:,7)", ["no column 7", "1 to 6"]),
        ("ans{1}", ["3×6 numbers", "does not fit"]),
        ("data.tim", ["no field 'tim'", "struct with time 6×1, signals struct 1×3, blockName text 1×9"]),
        ("data", ["struct with time 6×1", "not a vector", "data.time"]),
        ("data.signals", ["struct 1×3", "data.signals(1).values"]),
        ("data.signals.values", ["struct 1×3", "data.signals(1).values for the first"]),
        ("data.signals(4).values", ["1×3", "without an element 4", "counts from 1"]),
        ("data.signals(0).values", ["without an element 0"]),
        ("data.signals(:).values", ["take one element"]),
        ("data.signals{1}", ["does not fit"]),
        ("Y", ["cell 1×1", "Y{1}"]),
        ("Y.time", ["cell 1×1", "no fields"]),
        ("Y(1)", ["does not fit", "Y{1}"]),
        ("Y{9}", ["without an element 9"]),
        ("ans", ["3×6, not a vector", "row = 0 to 2", "index = 0 to 5"]),
        ("ans(4,:)", ["no row 4", "1 to 3"]),
        ("ans(:,99999999999999999999)", ["no column"]),
        ("ans.x", ["3×6 numbers"]),
        ("note", ["text 1×5, not a vector"]),
        ("z", ["complex numbers 1×6, not a vector"]),
        ("dat.time", ["no variable 'dat'; did you mean 'data'?", "has: data (struct with time 6×1", "Ts (1×1)"]),
        ("ans(", ["no path of a variable"]),
        ("", ["columns count from 0"]),
    ],
)
def test_what_a_path_meets_is_described(tmp_path: Path, path: str, words: list[str]) -> None:
    content = save(tmp_path, written(**HELD), "run.mat")
    with pytest.raises(InputError) as caught:
        Recording.read(content, entries("data.time", "ans(2,:)", path))
    message = str(caught.value)
    assert len(message.splitlines()) == 1
    for word in words:
        assert word in message


def test_a_row_or_column_beyond_the_matrix(tmp_path: Path) -> None:
    path = save(tmp_path, written(ans=ROWS), "run.mat")
    for key, number in (("row", 3), ("index", 6)):
        message = refusal(path, columns=entries("ans(1,:)", "ans(2,:)", {"variable": "ans", key: number}))
        assert f"{key} {number}, but 'ans' is 3×6; count from 0" in message


def element(kind: int, data: bytes) -> bytes:
    return struct.pack("<II", kind, len(data)) + data + bytes(-len(data) % 8)


def opaque(name: bytes, kind: bytes) -> bytes:
    """A MATLAB object as MATLAB 7 writes it: flags, name, type system, class, and a reference to what the file's end holds."""
    reference = element(
        14, element(6, struct.pack("<II", 13, 0)) + element(5, struct.pack("<ii", 2, 1)) + element(1, b"") + element(6, bytes(8))
    )
    return element(
        14, element(6, struct.pack("<II", 17, 0)) + element(1, name) + element(1, b"MCOS") + element(1, kind) + reference
    )


@pytest.mark.parametrize("kind", [b"table", b"timetable", b"string", b"idpoly", b"timeseries"])
def test_objects_beside_sound_vectors(tmp_path: Path, kind: bytes) -> None:
    sound = written(t=TIME, u=VOLTS, q=ANGLE)
    rest = element(
        14, element(6, struct.pack("<II", 9, 0)) + element(5, struct.pack("<ii", 1, 4)) + element(1, b"") + element(2, b"abcd")
    )
    path = save(tmp_path, sound[:128] + opaque(b"T", kind) + sound[128:] + rest, "run.mat")
    assert np.array_equal(Recording.read(path, entries("t", "u", "q")).signals["arm_angle"], ANGLE)
    message = refusal(path, columns=entries("t", "u", "T"))
    assert f"'T' is object ({kind.decode()}), not a vector" in message
    assert "save its vectors" in message
    assert f"T (object ({kind.decode()}))" in refusal(path, columns=entries("t", "u", "angle"))


def test_messages_stay_short(tmp_path: Path) -> None:
    name = "v" * 200_000
    content = written(t=TIME, u=VOLTS, q=ANGLE)
    long = element(
        14,
        element(6, struct.pack("<II", 6, 0))
        + element(5, struct.pack("<ii", 1, 1))
        + element(1, name.encode())
        + element(9, bytes(8)),
    )
    for contents in (content + long * 3, content + long + written(**{f"n{k}": 1.0 for k in range(500)})[128:]):
        path = save(tmp_path, contents, "run.mat")
        for place in ("angle", "v" * 1000, name, f"t.{name}", f"t{'(1)' * 100_000}", f"q({'9' * 100_000},1)"):
            assert len(refusal(path, columns=entries("t", "u", place))) < 1000
    many = written(s={f"f{k:02}": 1.0 for k in range(60)}, t=TIME, u=VOLTS)
    assert "54 more" in refusal(save(tmp_path, many, "run.mat"), columns=entries("t", "u", "s"))


def test_a_struct_that_holds_a_function_and_text_is_read(tmp_path: Path) -> None:
    content = bytearray(written(d={"time": TIME, "label": "abc", "u": VOLTS, "q": ANGLE}))
    place = content.index(struct.pack("<II", 4, 0))  # the flags of the text: make a function of it
    content[place] = 16
    path = save(tmp_path, bytes(content), "run.mat")
    assert np.array_equal(Recording.read(path, entries("d.time", "d.u", "d.q")).command, VOLTS)
    assert "is function" in refusal(path, columns=entries("d.time", "d.u", "d.label"))


def test_true_and_false_are_those_of_a_condition(tmp_path: Path) -> None:
    path = save(tmp_path, written(t=TIME, u=VOLTS, on=np.ones(len(TIME), bool), s={"on": np.ones(len(TIME), bool)}), "run.mat")
    for place in ("on", "on(:)", "s.on"):
        message = refusal(path, columns=entries("t", "u", place))
        assert message.startswith("column 'arm_angle': ")
        assert "is true and false, no numbers; name another" in message
    table = entries("t", "u", "t") | {"arm_angle": {"variable": "t(:)", "unit": "rad"}}
    assert Recording.read(path, table | {"conditions": {"on": {"variable": "on", "unit": "1"}}}).conditions == {"on": 1.0}


def test_a_bomb_is_refused(tmp_path: Path) -> None:
    path = save(tmp_path, written(True, t=TIME, u=VOLTS, zeros=np.zeros(40_000_000)), "run.mat")
    assert path.stat().st_size < 10_000_000
    assert "256 MB once unpacked" in refusal(path, columns=entries("t", "u", "zeros"))


leaves = st.one_of(
    arrays(
        st.sampled_from([np.float64, np.float32, np.int8, np.uint16, np.int32, np.uint64, np.bool_]),
        array_shapes(max_dims=3, max_side=4),
    ),
    st.text("abcxyz", max_size=5),
)
fields = st.sampled_from(["time", "values", "u", "q"])
contents = st.recursive(
    leaves,
    lambda inner: (
        st.dictionaries(fields, inner, min_size=1, max_size=3)
        | st.lists(inner, min_size=1, max_size=3).map(lambda found: cells(*found))
    ),
    max_leaves=6,
)


def paths(value: Any, path: str) -> dict[str, np.ndarray]:
    """List the paths of all numbers in what `loadmat` reads."""
    if value.dtype.names:
        return {key: one for name in value.dtype.names for key, one in paths(value[name][0, 0], f"{path}.{name}").items()}
    if value.dtype == object:
        return {
            key: one for place in range(value.size) for key, one in paths(value.flat[place], f"{path}{{{place + 1}}}").items()
        }
    return {path: value} if value.dtype.kind in "fiub" else {}


@settings(max_examples=60, deadline=None)
@given(st.dictionaries(st.sampled_from(["a", "b", "data"]), contents, min_size=1), st.booleans())
def test_numbers_are_those_that_scipy_reads(drawn: dict[str, Any], compressed: bool) -> None:
    content = written(compressed, **drawn)
    read = scipy.io.loadmat(io.BytesIO(content))
    found = variables(content)
    assert set(found) == set(drawn)
    assert len(describe_all(found)) < 2000
    for name in drawn:
        for path, value in paths(read[name], name).items():
            assert np.array_equal(find_numbers(found, path), value.astype(np.float64), equal_nan=True)


@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data(), compressed=st.booleans(), version=st.sampled_from(["4", "5"]))
def test_damaged_files_are_read_or_refused(tmp_path: Path, data: st.DataObject, compressed: bool, version: str) -> None:
    held = {"ans": ROWS} if version == "4" else {"data": {**SCOPE, "all": ROWS}, "Y": cells(ROWS), "ans": ROWS}
    content = bytearray(written(compressed and version == "5", version, **held))
    for _ in range(data.draw(st.integers(1, 4))):
        place = data.draw(st.integers(0, len(content) - 1))
        content[place : place + data.draw(st.integers(0, 8))] = data.draw(st.binary(max_size=8))
    path = save(tmp_path, bytes(content), "run.mat")
    for place in ("ans(3,:)", "data.signals(2).values", "Y{1}(3,:)"):
        message = ""
        try:
            assert np.all(np.diff(Recording.read(path, entries("ans(1,:)", "ans(2,:)", place)).time) > 0)
        except InputError as error:
            message = str(error)
        assert len(message) < 1000
        assert not message or message.isprintable()


def test_a_file_of_a_big_endian_machine() -> None:
    def swapped(kind: int, data: bytes) -> bytes:
        return struct.pack(">II", kind, len(data)) + data + bytes(-len(data) % 8)

    parts = [(6, struct.pack(">II", 6, 0)), (5, struct.pack(">ii", 1, 6)), (1, b"t"), (9, TIME.astype(">f8").tobytes())]
    content = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x01\x00MI" + swapped(14, b"".join(swapped(*part) for part in parts))
    assert np.array_equal(find_numbers(variables(content), "t"), TIME[None, :])
    assert np.array_equal(scipy.io.loadmat(io.BytesIO(content))["t"], TIME[None, :])
