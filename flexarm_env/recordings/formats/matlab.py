"""MATLAB files with columns of a recording, read so that a damaged one cannot crash the process."""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.recordings.columns import ColumnMap
from flexarm_env.recordings.formats.base import Format
from flexarm_env.recordings.table import LARGEST_FILE, Table

# The MAT-file format, table "MAT-file data types"; the gaps are reserved.
_MATRIX, _COMPRESSED = 14, 15
_TYPE_CODES = {1, 2, 3, 4, 5, 6, 7, 9, 12, 13, _MATRIX, _COMPRESSED, 16, 17, 18}
_MATLAB_NUMBERS = {
    "double",
    "single",
    *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)),
}


def read(content: bytes, columns: ColumnMap | None) -> Table:
    """Read the content of a .mat file (version 7 or older) by its column map.

    Args:
        content: of the file.
        columns: its column map, without which no variable is read.

    Raises:
        InputError: for version 7.3, a damaged file, or a variable that is absent or no vector of numbers.
    """
    import scipy.io

    sources = {} if columns is None else columns.sources
    wanted = [str(source.place) for source in sources.values()]
    try:
        _check_matlab(content)
        classes = {name: kind for name, _, kind in scipy.io.whosmat(io.BytesIO(content))}
        numeric = [name for name in wanted if classes.get(name) in _MATLAB_NUMBERS]
        variables: dict[str, Any] = scipy.io.loadmat(io.BytesIO(content), variable_names=numeric)
    except NotImplementedError:
        raise InputError("is a MATLAB 7.3 file, which is not read; save('FILE.mat', '-v7')") from None
    except Exception:  # a damaged file makes scipy raise nearly anything
        raise InputError("is damaged or no MATLAB file; in MATLAB: save('FILE.mat', '-v7')") from None
    values: dict[str, NDArray[np.float64]] = {}
    for name, variable in zip(sources, wanted, strict=True):
        if variable not in classes:
            raise InputError(f"column '{name}': no variable {variable!r}{did_you_mean(variable, classes)}")
        values[name] = _vector(name, variable, variables.get(variable))
    lengths = {name: len(value) for name, value in values.items() if columns is None or name not in columns.conditions}
    if len(set(lengths.values())) > 1:
        raise InputError(f"its variables differ in length ({lengths}); give vectors of one length")
    return Table(values, dict(sources))


def _check_matlab(content: bytes) -> None:
    """Raise ValueError for damage to a version 5 file that would make scipy's reader crash the process.

    scipy looks up the type code of a data element without checking it (scipy pull request 25349), and a file
    that ends in zeros, as a full disk leaves it, has codes that do not exist.
    """
    if 0 in content[:4] or content[124:128] in (b"\x00\x02IM", b"\x02\x00MI"):
        return  # version 4, or 7.3, which scipy refuses
    order = {b"\x00\x01IM": "<", b"\x01\x00MI": ">"}[content[124:128]]
    for kind, variable in _elements(content[128:], order, padded=False):
        if kind == _COMPRESSED:
            unpacker = zlib.decompressobj()
            unpacked = unpacker.decompress(variable, LARGEST_FILE)
            if not unpacker.eof:
                raise ValueError("cut off, or larger than any recording")
            kind, variable = next(_elements(unpacked, order))
        parts = list(_elements(variable, order))
        if kind != _MATRIX or len(parts) < 3 or len(parts[0][1]) != 8:
            raise ValueError("no variable")
        flags = struct.unpack(order + "I", parts[0][1][:4])[0]
        numeric = 6 <= flags & 0xFF <= 15
        if numeric and (len(parts) != (5 if flags & 0x800 else 4) or any(part[0] > 13 for part in parts)):
            raise ValueError("an array without its data")


def _elements(data: bytes, order: str, padded: bool = True) -> Iterator[tuple[int, bytes]]:
    """Yield type code and content of each element of a MATLAB 5 file: its tag has 8 bytes, or 4 if small."""
    start = 0
    while start < len(data):
        kind, size = struct.unpack_from(order + "II", data, start)
        first = start + 8
        start = first + size + (-size % 8 if padded else 0)
        if kind >> 16:
            kind, size, first, start = kind & 0xFFFF, kind >> 16, first - 4, first
        if kind not in _TYPE_CODES or first + size > len(data) or (first + size > start):
            raise ValueError("not an element")
        yield kind, data[first : first + size]


def _vector(name: str, variable: str, value: Any) -> NDArray[np.float64]:
    real = isinstance(value, np.ndarray) and value.dtype.kind in "fiu"
    if not real or not 0 < value.size == max(value.shape):
        raise InputError(f"column '{name}': variable '{variable}' is not a vector of real numbers; save it as n × 1")
    return np.array(value, dtype=np.float64).ravel()


FORMAT = Format("MATLAB file", (".mat",), ("variable",), read)
