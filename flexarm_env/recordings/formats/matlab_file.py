"""The variables of a MATLAB file of version 5 to 7 or 4, read one by one, so that a damaged or hostile one is only refused.

`scipy.io.loadmat` crashes the process on a damaged type code (scipy pull request 25349) and reads all of a struct, whatever
objects lie in it. Here only the variable that is asked for is read, and nothing but numbers, structs and cells.
"""

from __future__ import annotations

import math
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.recordings.table import LARGEST_FILE

# The MAT-file format, tables "MAT-file data types" and "MATLAB array types"; the gaps are reserved.
_MATRIX, _COMPRESSED = 14, 15
_NUMBER_TYPES = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
_TYPE_CODES = {*_NUMBER_TYPES, _MATRIX, _COMPRESSED, 16, 17, 18}
_CELL, _STRUCT, _OBJECT, _TEXT, _SPARSE, _FUNCTION, _OPAQUE = 1, 2, 3, 4, 5, 16, 17
_KINDS = {_CELL: "cell", _STRUCT: "struct", _OBJECT: "object", _TEXT: "text", _SPARSE: "sparse matrix", _FUNCTION: "function"}
_KINDS |= dict.fromkeys(range(6, 16), "numbers")
_COMPLEX, _LOGICAL = 0x800, 0x200
_HEADER = 128
# Version 4: a header of five integers, whose first is MOPT, with the floats' machine in its thousands.
_V4_HEADER = 20
_V4_MACHINES = {0: "<", 1: ">"}
_V4_TYPES = {0: "f8", 1: "f4", 2: "i4", 3: "i2", 4: "u2", 5: "u1"}
_LONGEST_V4_NAME = 1000


class DamagedError(ValueError):
    """Content that is no MATLAB file, or one cut off or changed."""


class VersionError(ValueError):
    """A kind of MATLAB file that is not read: its text says the kind."""


@dataclass(frozen=True)
class Variable:
    """A variable of a MATLAB file, a field of a struct, or the content of a cell.

    Attributes:
        kind: "numbers", "struct", "cell", or what is not read: "text", "complex numbers", "function", "object (timetable)".
        shape: its dimensions; () for an object.
        order: "<" or ">".
        parts: type code and content of what follows the header.
        truth: whether its numbers are true and false.
    """

    kind: str
    shape: tuple[int, ...]
    order: str
    parts: tuple[tuple[int, memoryview], ...]
    truth: bool = False

    @property
    def size(self) -> int:
        """Number of elements."""
        return math.prod(self.shape)

    def numbers(self) -> NDArray[np.float64]:
        """Read the numbers, in their shape.

        Raises:
            DamagedError: if there are not as many as the shape has.
        """
        if self.size == 0:
            return np.zeros(self.shape)
        code, data = self.parts[0] if self.parts else (0, memoryview(b""))
        if code not in _NUMBER_TYPES:
            raise DamagedError("no numbers")
        kind = np.dtype(self.order + _NUMBER_TYPES[code])
        if len(data) != self.size * kind.itemsize:
            raise DamagedError("more or fewer numbers than the shape")
        return np.frombuffer(data, kind).astype(np.float64).reshape(self.shape, order="F")

    def fields(self) -> list[str]:
        """List the names of a struct's fields."""
        (_, length), (_, text) = _first_two(self.parts)
        width = struct.unpack(self.order + "i", length[:4])[0] if len(length) >= 4 else 0
        if width <= 0 or len(text) % width:
            raise DamagedError("no names of fields")
        names = (bytes(text[start : start + width]) for start in range(0, len(text), width))
        return [name.split(b"\0")[0].decode("latin-1") for name in names]

    def field(self, element: int, name: str) -> Variable:
        """Read a field of one element of a struct, counted from 0 along its first dimension first."""
        names = self.fields()
        return self._inner(2 + element * len(names) + names.index(name))

    def cell(self, element: int) -> Variable:
        """Read the content of one element of a cell array, counted as in `field`."""
        return self._inner(element)

    def _inner(self, place: int) -> Variable:
        if place >= len(self.parts) or self.parts[place][0] != _MATRIX:
            raise DamagedError("an element is absent")
        return _variable(self.parts[place][1], self.order)[1]


def variables(content: bytes) -> dict[str, Variable]:
    """List the variables of a file by name.

    Raises:
        DamagedError: for content that is no MATLAB file, or a damaged one.
        VersionError: for a version or a machine whose numbers are not read.
    """
    mark = content[124:128]
    if mark in (b"\x00\x02IM", b"\x02\x00MI"):
        raise VersionError("a MATLAB 7.3 file")
    if 0 in content[:4]:
        return dict(_version_4(memoryview(content)))
    if mark not in (b"\x00\x01IM", b"\x01\x00MI"):
        raise DamagedError("no header")
    order = "<" if mark[2:] == b"IM" else ">"
    found = {}
    room = LARGEST_FILE
    for code, data in _elements(memoryview(content)[_HEADER:], order, padded=False):
        if code == _COMPRESSED:
            unpacked = _unpack(data, room)
            room -= len(unpacked)
            code, data = next(_elements(unpacked, order), (0, data))
        if code != _MATRIX:
            raise DamagedError("no variable")
        name, variable = _variable(data, order)
        if name:  # that without one holds what MATLAB keeps of objects
            found[name] = variable
    return found


def _unpack(data: memoryview, room: int) -> memoryview:
    """Decompress a variable that has at most so many bytes."""
    unpacker = zlib.decompressobj()
    try:
        unpacked = unpacker.decompress(data, room + 1)
    except zlib.error:
        raise DamagedError("damaged compression") from None
    if len(unpacked) > room:
        raise VersionError(f"a MATLAB file of more than {LARGEST_FILE >> 20} MB once unpacked")
    if not unpacker.eof:
        raise DamagedError("cut off")
    return memoryview(unpacked)


def _elements(data: memoryview, order: str, padded: bool = True) -> Iterator[tuple[int, memoryview]]:
    """Yield type code and content of each element: its tag has 8 bytes, or 4 if small."""
    start = 0
    while start < len(data):
        if start + 8 > len(data):
            raise DamagedError("cut off")
        code, size = struct.unpack_from(order + "II", data, start)
        first = start + 8
        start = first + size + (-size % 8 if padded else 0)
        if code >> 16:
            code, size, first, start = code & 0xFFFF, code >> 16, first - 4, first
        if code not in _TYPE_CODES or first + size > min(start, len(data)):
            raise DamagedError("not an element")
        yield code, data[first : first + size]


def _variable(data: memoryview, order: str) -> tuple[str, Variable]:
    """Read the header of a variable: its name, which is empty in structs and cells, its kind and its shape."""
    parts = list(_elements(data, order))
    if not parts:  # [] in a struct or cell
        return "", Variable("numbers", (0, 0), order, ())
    flags_part, second, *rest = (part for _, part in (*parts, (0, memoryview(b""))))
    if len(parts) < 3 or len(flags_part) != 8:
        raise DamagedError("no variable")
    flags = struct.unpack(order + "I", flags_part[:4])[0]
    if flags & 0xFF == _OPAQUE:  # such as a table: without a shape, with its class after its name
        kind = f"object ({_text(rest[1])})" if len(rest) > 1 else "object"
        return _text(second), Variable(kind, (), order, ())
    kind = _KINDS.get(flags & 0xFF, "")
    if not kind or len(second) % 4 or len(second) < 8:
        raise DamagedError("no kind or no shape")
    shape = struct.unpack(f"{order}{len(second) // 4}i", second)
    if min(shape) < 0 or (kind == "numbers" and len(parts) != (5 if flags & _COMPLEX else 4)):
        raise DamagedError("an array without its data")
    kind = "complex numbers" if kind == "numbers" and flags & _COMPLEX else kind
    variable = Variable(kind, shape, order, tuple(parts[3:]), bool(flags & _LOGICAL))
    if kind == "numbers" and math.prod(shape):
        code, data = parts[3]
        if code not in _NUMBER_TYPES or len(data) != variable.size * np.dtype(_NUMBER_TYPES[code]).itemsize:
            raise DamagedError("more or fewer numbers than the shape")
    return _text(rest[0]), variable


def _text(data: memoryview) -> str:
    return bytes(data).split(b"\0")[0].decode("latin-1")


def _first_two(parts: tuple[tuple[int, memoryview], ...]) -> tuple[tuple[int, memoryview], tuple[int, memoryview]]:
    if len(parts) < 2:
        raise DamagedError("no fields")
    return parts[0], parts[1]


def _version_4(data: memoryview) -> Iterator[tuple[str, Variable]]:
    """Yield name and variable of a file of version 4."""
    start = 0
    while start < len(data):
        if start + _V4_HEADER > len(data):
            raise DamagedError("cut off")
        order = "<" if struct.unpack_from("<i", data, start)[0] in range(5000) else ">"
        mopt, rows, columns, imaginary, length = struct.unpack_from(order + "5i", data, start)
        machine, kind, matrix = mopt // 1000, mopt // 10 % 10, mopt % 10
        if mopt // 100 % 10 or kind not in _V4_TYPES or machine not in range(5) or min(rows, columns) < 0:
            raise DamagedError("no header of version 4")
        if machine not in _V4_MACHINES:
            raise VersionError(f"a MATLAB 4 file with floats of a {'VAX' if machine < 4 else 'Cray'}")
        if not 0 < length <= _LONGEST_V4_NAME or imaginary not in (0, 1):
            raise DamagedError("no name")
        code = next(code for code, one in _NUMBER_TYPES.items() if one == _V4_TYPES[kind])
        first = start + _V4_HEADER + length
        size = rows * columns * np.dtype(_V4_TYPES[kind]).itemsize
        start = first + size * (2 if imaginary else 1)
        if start > len(data):
            raise DamagedError("cut off")
        what = {0: "complex numbers" if imaginary else "numbers", 1: "text"}.get(matrix, "sparse matrix")
        parts = ((code, data[first : first + size]),)
        yield _text(data[first - length : first]), Variable(what, (rows, columns), _V4_MACHINES[machine], parts)
