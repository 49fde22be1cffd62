"""Paths of variables as MATLAB writes them, such as `data.signals(2).values` or `Y{4}(1,:)`, and what lies there."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.recordings.formats.matlab_file import Variable
from flexarm_env.recordings.messages import quoted

# Possessive, so that no path takes time that grows faster than its length.
_STEP = re.compile(r"\.([A-Za-z]\w*+)|\((\d++|:)(?>(?:,(\d++|:))?)\)|\{(\d++)(?>(?:,(\d++))?)\}")
_NAME = re.compile(r"[A-Za-z]\w*+")
_MOST_SHOWN, _MOST_FIELDS = 8, 6


def find_numbers(variables: Mapping[str, Variable], path: str, truth: bool = True) -> NDArray[np.float64]:
    """Find the numbers at a path, in their shape.

    Args:
        variables: of the file.
        path: as MATLAB writes it.
        truth: whether true and false are numbers, too.

    Raises:
        InputError: for a path that is none, that leads nowhere, or to anything but real numbers.
    """
    start, steps = _cut(path, variables)
    place, value = start, variables[start]
    numbers: NDArray[np.float64] | None = None
    for step in steps:
        text, at = step[0], place
        place += text
        if numbers is None and value.kind == "numbers":
            numbers = value.numbers()
        if numbers is not None:
            numbers = _part(numbers, step, at)
        elif text[0] == ".":
            value = _field(value, step[1], at)
        else:
            value = _element(value, step, at)
    if value.truth and not truth:
        raise InputError(f"{quoted(place)} is true and false, no numbers; name another")
    if numbers is None:
        if value.kind != "numbers":
            raise InputError(f"{quoted(place)} is {describe(value)}, not a vector of real numbers{_advice(value, place)}")
        numbers = value.numbers()
    return numbers


def describe_all(variables: Mapping[str, Variable]) -> str:
    """List what a file holds, such as "data (struct with time 500×1, signals 1×3), Ts (1×1)"."""
    shown = [f"{_short(name)} ({describe(value)})" for name, value in list(variables.items())[:_MOST_SHOWN]]
    return ", ".join([*shown, *([f"{len(variables) - _MOST_SHOWN} more"] if len(variables) > _MOST_SHOWN else [])]) or "nothing"


def describe(value: Variable) -> str:
    """Describe a variable by kind, shape and fields."""
    shape = "×".join(map(str, value.shape))
    if value.kind == "numbers":
        return shape
    if value.kind != "struct":
        return f"{value.kind} {shape}".rstrip()
    names = value.fields()
    inner = [f"{_short(name)} {_outline(value.field(0, name))}" if value.size else _short(name) for name in names[:_MOST_FIELDS]]
    more = [f"{len(names) - _MOST_FIELDS} more"] if len(names) > _MOST_FIELDS else []
    return f"struct{'' if value.size == 1 else f' {shape}'} with {', '.join([*inner, *more]) or 'no fields'}"


def _outline(value: Variable) -> str:
    shape = "×".join(map(str, value.shape))
    return shape if value.kind == "numbers" else f"{value.kind} {shape}".rstrip()


def _short(name: str) -> str:
    return quoted(name)[1:-1]


def _cut(path: str, variables: Mapping[str, Variable]) -> tuple[str, list[re.Match[str]]]:
    """Cut a path into the name of a variable and the steps from it. A name may itself hold dots, in files of other programs."""
    if path in variables:
        return path, []
    text = path.replace(" ", "")
    name = _NAME.match(text)
    steps: list[re.Match[str]] = []
    end = name.end() if name else 0
    while name and end < len(text):
        step = _STEP.match(text, end)
        if step is None:
            break
        steps.append(step)
        end = step.end()
    if name is None or end < len(text):
        raise InputError(f"{quoted(path)} is no path of a variable; write it as MATLAB does, such as data.signals(2).values")
    if name[0] not in variables:
        hint = did_you_mean(name[0], [_short(one) for one in variables]) if len(variables) <= _MOST_SHOWN else ""
        near = hint if "did you mean" in hint else ""
        raise InputError(f"no variable {quoted(name[0])}{near}; the file has: {describe_all(variables)}")
    return name[0], steps


def _field(value: Variable, name: str, place: str) -> Variable:
    if value.kind != "struct":
        raise InputError(f"{quoted(place)} is {describe(value)}, which has no fields{_advice(value, place)}")
    if name not in value.fields():
        raise InputError(f"{quoted(place)} has no field {quoted(name)}; it is a {describe(value)}")
    if value.size != 1:
        what = f"write {_short(place)}(1).{name} for the first" if value.size else "it is empty"
        raise InputError(f"{quoted(place)} is a {describe(value)}; {what}")
    return value.field(0, name)


def _element(value: Variable, step: re.Match[str], place: str) -> Variable:
    """Take one element of a struct, with (), or the content of one of a cell, with {}."""
    numbers = [step[group] for group in ((2, 3) if step[0][0] == "(" else (4, 5)) if step[group] is not None]
    if step[0][0] != {"cell": "{", "struct": "("}.get(value.kind):
        raise InputError(f"{quoted(place)} is {describe(value)}, which {_short(step[0])} does not fit{_advice(value, place)}")
    if ":" in numbers:
        raise InputError(f"{quoted(place + step[0])}: take one element, such as (1)")
    element = _position([int(number) for number in numbers], value.shape, place)
    if value.kind == "cell":
        return value.cell(element)
    names = value.fields()
    inner = value.parts[2 + element * len(names) : 2 + (element + 1) * len(names)]
    return Variable("struct", (1, 1), value.order, (*value.parts[:2], *inner))


def _position(numbers: Sequence[int], shape: Sequence[int], place: str) -> int:
    """Compute the position, from 0 along the first dimension first, of MATLAB's (i) or (i,j)."""
    sizes = [int(np.prod(shape))] if len(numbers) == 1 else list(shape)
    if len(sizes) != len(numbers) or not all(1 <= number <= size for number, size in zip(numbers, sizes, strict=True)):
        written = ",".join(map(str, numbers))
        raise InputError(f"{quoted(place)} is {'×'.join(map(str, shape))}, without an element {written}; MATLAB counts from 1")
    return numbers[0] - 1 if len(numbers) == 1 else numbers[0] - 1 + (numbers[1] - 1) * shape[0]


def _part(numbers: NDArray[np.float64], step: re.Match[str], place: str) -> NDArray[np.float64]:
    """Take a row (i,:), a column (:,j), all (:) or one element of numbers."""
    shape = "×".join(map(str, numbers.shape))
    if step[0][0] != "(" or numbers.ndim != 2:
        raise InputError(f"{quoted(place)} is {shape} numbers, which {_short(step[0])} does not fit")
    if step[3] is None:
        return numbers.reshape(-1, order="F") if step[2] == ":" else _at(numbers.reshape(-1, 1, order="F"), 0, step[2], place)
    for axis, text in enumerate((step[2], step[3])):
        if text != ":":
            numbers = _at(numbers, axis, text, place)
    return numbers


def _at(numbers: NDArray[np.float64], axis: int, text: str, place: str) -> NDArray[np.float64]:
    index, size = int(text[:9]), numbers.shape[axis]
    if not 1 <= index <= size:
        kind = ("row", "column")[axis]
        raise InputError(f"{quoted(place)} has no {kind} {index}, MATLAB counts 1 to {size}")
    return np.take(numbers, [index - 1], axis=axis)


def _advice(value: Variable, place: str) -> str:
    if value.kind == "struct" and value.size:
        name = f"{_short(place)}{'' if value.size == 1 else '(1)'}"
        return f"; name a field, such as {name}.{_short(value.fields()[0])}" if value.fields() else ""
    if value.kind == "cell" and value.size:
        return f"; name one of its cells, such as {_short(place)}{{1}}"
    if value.kind.startswith("object"):
        return "; in MATLAB save its vectors, such as t = seconds(T.Time), as variables of their own"
    return ""
