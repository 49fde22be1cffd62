"""MATLAB files of version 4, as MATLAB's own `-v4` and old tools write them."""

from __future__ import annotations

import io
import struct
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from recording_files import refusal, save

from flexarm_env.errors import InputError
from flexarm_env.recordings.formats.matlab_file import DamagedError, variables
from flexarm_env.recordings.formats.matlab_paths import describe_all, find_numbers
from flexarm_env.recordings.recording import Recording

ROWS = np.array([np.arange(6) / 500, [0.0, 1, 2, 3, 2, 1], [0.0, 0, 1, 3, 4, 4]])
UNITS = {"time": "s", "voltage": "V", "arm_angle": "rad"}
COLUMNS = {name: {"variable": "ans", "row": row, "unit": unit} for row, (name, unit) in enumerate(UNITS.items())}


def matrix_of_4() -> bytes:
    file = io.BytesIO()
    scipy.io.savemat(file, {"ans": ROWS}, format="4")
    return file.getvalue()


def test_a_matrix_of_version_4(tmp_path: Path) -> None:
    path = save(tmp_path, matrix_of_4(), "run.mat")
    assert np.array_equal(Recording.read(path, COLUMNS).signals["arm_angle"], ROWS[2])


@pytest.mark.parametrize("machine", [2, 3, 4])
def test_floats_of_other_machines_are_refused(tmp_path: Path, machine: int) -> None:
    content = matrix_of_4()
    other = struct.pack("<i", machine * 1000) + content[4:]
    assert ("VAX" if machine < 4 else "Cray") in refusal(save(tmp_path, other, "run.mat"), columns=COLUMNS)


def header_of_4(mopt: int = 0, rows: int = 1, columns: int = 1, imaginary: int = 0, name: bytes = b"u\0") -> bytes:
    return struct.pack("<5i", mopt, rows, columns, imaginary, len(name)) + name


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (header_of_4(mopt=100), "no header of version 4"),
        (header_of_4(mopt=60), "no header of version 4"),
        (struct.pack(">5i", 6000, 1, 1, 0, 2) + b"u\0", "no header of version 4"),
        (header_of_4(rows=-1), "no header of version 4"),
        (header_of_4(columns=-1), "no header of version 4"),
        (header_of_4(rows=-1, columns=-1), "no header of version 4"),
        (header_of_4(name=b""), "no name"),
        (header_of_4(name=b"u" * 1001), "no name"),
        (header_of_4(imaginary=2), "no name"),
        (header_of_4(imaginary=-1), "no name"),
        (header_of_4()[:19], "cut off"),
        (header_of_4() + bytes(7), "cut off"),
        (header_of_4(imaginary=1) + bytes(15), "cut off"),
        (header_of_4() + bytes(8) + header_of_4(), "cut off"),
    ],
)
def test_a_damaged_header_of_version_4_is_refused(content: bytes, words: str) -> None:
    with pytest.raises(DamagedError, match=words):
        variables(content)


@pytest.mark.parametrize(("kind", "code"), [(0, "f8"), (10, "f4"), (20, "i4"), (30, "i2"), (40, "u2"), (50, "u1")])
@pytest.mark.parametrize("order", ["<", ">"])
def test_numbers_of_version_4_in_each_type(kind: int, code: str, order: str) -> None:
    mopt = kind + (1000 if order == ">" else 0)
    head = struct.pack(f"{order}5i", mopt, 2, 3, 0, 1000) + b"u".ljust(1000, b"\0")
    numbers = np.arange(6).reshape(2, 3)
    content = head + numbers.astype(order + code).tobytes(order="F")
    assert np.array_equal(find_numbers(variables(content * 2), "u"), numbers)


@pytest.mark.parametrize(("matrix", "imaginary", "kind"), [(0, 1, "complex numbers"), (1, 0, "text"), (2, 0, "sparse matrix")])
def test_what_version_4_holds_beside_numbers_is_described(matrix: int, imaginary: int, kind: str) -> None:
    content = header_of_4(mopt=matrix, imaginary=imaginary) + bytes(8 * (1 + imaginary)) + header_of_4(rows=0, name=b"v\0")
    found = variables(content + header_of_4(name=b"w\0") + bytes(8))
    assert describe_all(found) == f"u ({kind} 1×1), v (0×1), w (1×1)"
    with pytest.raises(InputError, match=f"'u' is {kind} 1×1, not a vector"):
        find_numbers(found, "u")
