"""Columns of a file: the quantity, unit, sign and scale of each, from FlexArm's own header or a column map."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from flexarm_env import units
from flexarm_env.control.law import ControlLaw
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.parameters import INPUTS
from flexarm_env.recordings.conditions import CONDITIONS
from flexarm_env.recordings.corrections import Corrections
from flexarm_env.sensors import known_sensors

UNITS = {"time": "s", **INPUTS, **{name: sensor.unit for name, sensor in known_sensors().items()}, "reference": "rad"}
CALIBRATED = tuple(name for name in (*known_sensors(), "reference") if UNITS[name] != "V")

#: Keys of entries that no column of a file states.
MADE = ("rate", "value")

_NATIVE = re.compile(r"([^\[]*+)\[([^\]]*+)\]")


@dataclass(frozen=True)
class Source:
    """The place of one quantity in a file, and its conversion to SI: value × sign × scale, in `unit`.

    Attributes:
        place: header text, 0-based column number, path of a variable such as "data.signals(2).values", a rate [Hz], or the
            command of every row.
        unit: unit of the numbers in the file; "" for that of the file's own header.
        sign: 1 or -1.
        scale: a plain factor, or a quantity such as "1 rad/m".
        key: of the entry that names the place: "column", "index", "variable", "rate" (of time alone, evenly spaced), "value"
            (of a command alone, the same throughout), or "header" for the column of that name in FlexArm's own header.
        row: of a variable that is a matrix, from 0; None for all.
        cut: its column, from 0; None for all.
        file: name of the file that has it, in which "*" stands for the name of the run; "" for the file that is read.
        time: where that file has its time, whose parts are added; empty for the entry of the map.
        corrections: of a signal, in SI; of time the shift of all signals.
        mean: of a condition, whether it is the mean of a column whose numbers differ.
        split: of a condition, whether the run is cut in recordings of their own where its number changes.
    """

    place: str | int | float
    unit: str
    sign: int = 1
    scale: str | float = 1.0
    key: str = "index"
    row: int | None = None
    cut: int | None = None
    file: str = ""
    time: tuple[Source, ...] = ()
    corrections: Corrections = field(default_factory=Corrections)
    mean: bool = False
    split: bool = False


@dataclass(frozen=True)
class ColumnMap:
    """The layout of a file without a header of FlexArm's own.

    Attributes:
        sources: the place of each quantity, by FlexArm name.
        delimiter: one character; a blank stands for any run of blanks.
        header_prefix: the header is the last of the leading lines that start with it; "" if it has no mark.
        skip_rows: lines to drop at the top.
        decimal: "." or ",".
        conditions: the place of each condition that the file states as a column or variable: of equal numbers, of numbers whose
            mean is wanted, or of those that change in steps, at which the run is cut.
        episodes: numbers of those that are read of a file with several; all where none is named.
        frame_rate: frames per second [Hz] of which the file counts the times; 0 where it states none.
        controller: the law under which the recordings were made, if it stands beside the map.
    """

    sources: dict[str, Source] = field(default_factory=dict)
    delimiter: str = ","
    header_prefix: str = ""
    skip_rows: int = 0
    decimal: str = "."
    conditions: dict[str, Source] = field(default_factory=dict)
    episodes: tuple[int, ...] = ()
    frame_rate: float = 0.0
    controller: ControlLaw | None = None

    @property
    def refines(self) -> bool:
        """Whether it names no place of any column, and so refines FlexArm's own header of a file."""
        return all(source.key in ("header", *MADE) for source in self.sources.values())

    @property
    def joins(self) -> bool:
        """Whether it makes one recording of several files."""
        return any(source.file for source in self.sources.values())


def part_names(name: str, count: int) -> list[str]:
    """List the names of a quantity whose columns are added, such as seconds and nanoseconds of time.

    Examples:
        >>> from flexarm_env.recordings.columns import part_names, quantity_of
        >>> part_names("time", 2)
        ['time', 'time (2)']
        >>> quantity_of("time (2)")
        'time'
    """
    return [name, *(f"{name} ({number})" for number in range(2, count + 1))]


def quantity_of(name: str) -> str:
    """Find the quantity of which a column is a part, see `part_names`."""
    return name.partition(" (")[0]


def lateness_of(name: str, sources: Mapping[str, Source]) -> float:
    """Compute the time [s] by which a column is late: a signal by its own shift and that of time, others by none."""
    if name not in known_sensors():
        return 0.0
    return sources[name].corrections.shift + sources["time"].corrections.shift


def check_names(names: Sequence[str]) -> str:
    """Find the input ("current" or "voltage") of a recording that has these columns.

    Args:
        names: of the columns.

    Raises:
        InputError: if time is missing, or there is not exactly one input.
    """
    if "time" not in names:
        raise InputError("has no time column; add 'time [s]'")
    inputs = [name for name in INPUTS if name in names]
    if not inputs:
        raise InputError(
            "has neither 'current [A]' nor 'voltage [V]', 'torque [N*m]' or 'position [rad]'; add the input of the drive"
        )
    if len(inputs) > 1:
        raise InputError(f"has both {' and '.join(inputs)}; keep the one that the drive was commanded with")
    return inputs[0]


def native_sources(header: Sequence[str]) -> dict[str, Source]:
    """Read the sources from a header of FlexArm's own, such as ["time [s]", "current [mA]", …].

    Raises:
        InputError: for a column without a bracketed unit, of an unknown name, or that comes twice.
    """
    sources: dict[str, Source] = {}
    for index, cell in enumerate(header):
        match = _NATIVE.fullmatch(cell.strip())
        name = match[1].strip() if match else re.split(r"[\s(\[]", cell.strip(), maxsplit=1)[0]
        where = f"column {index + 1} of the header"
        if name not in UNITS:
            raise InputError(f"{where}: unknown column {name[:60]!r}{did_you_mean(name, UNITS)}")
        unit = match[2].strip() if match else ""
        if not unit:
            raise InputError(f"{where}: '{name}' has no unit in brackets; write '{name} [{UNITS[name]}]'")
        if name in sources:
            raise InputError(f"{where}: '{name}' comes twice; keep one of the two")
        sources[name] = Source(index, unit)
    return sources


def si_factor(name: str, source: Source, calibration: Mapping[str, float]) -> float:
    """Compute the factor from a number of the file to SI.

    Args:
        name: the FlexArm name.
        source: unit, sign and scale of the numbers.
        calibration: SI per volt, by signal; used for columns in volts that measure something else.

    Raises:
        InputError: for a unit that does not exist or does not convert, or volts without a calibration.
    """
    unit = UNITS[quantity_of(name)]
    in_volts = name in CALIBRATED and _in_volts(source)
    if in_volts and name not in calibration:
        raise InputError(
            f"column '{name}' is in {source.unit}, and no sensor gain says how many {unit} a volt is;"
            f" give '{name}' a calibration in {unit}/V, or record it in {unit}"
        )
    try:
        if in_volts:
            return source.sign * units.factor(source.unit, "V", source.scale) * calibration[name]
        return source.sign * units.factor(source.unit, unit, source.scale)
    except InputError as error:
        raise InputError(f"column '{name}': {error}") from None


def base_value(number: float, source: Source) -> units.BaseValue:
    """Convert a number of the file to SI base units."""
    scale, scale_unit = (float(source.scale), "") if isinstance(source.scale, int | float) else units.split(source.scale)
    unit = "" if source.unit == "1" else source.unit
    return units.in_base(source.sign * scale * number, scale_unit, unit)


def condition_value(name: str, number: float, source: Source) -> units.BaseValue:
    """Convert a number of a condition to SI: a payload to kg, a start to s, others to base units.

    Raises:
        InputError: for a unit of another quantity.
    """
    if name not in CONDITIONS:
        return base_value(number, source)
    target = CONDITIONS[name]
    if source.unit == "1":
        per_number = units.quantity(source.scale, target)
    else:
        per_number = units.factor(source.unit, target, source.scale)
    return units.BaseValue(source.sign * per_number * number, target)


def may_be_absent(name: str) -> bool:
    """Whether a column may have empty rows: a signal is not measured there, and a command goes on."""
    return name in known_sensors() or name in INPUTS


def _in_volts(source: Source) -> bool:
    """Whether the numbers are volts that no scale turns into another quantity."""
    if source.unit in UNITS.values() or isinstance(source.scale, str):
        return source.unit == "V" and not isinstance(source.scale, str)
    try:
        return units.converts(source.unit, "V")
    except InputError:
        return False


def check_calibration(calibration: Mapping[str, float]) -> None:
    """Check gains per volt.

    Raises:
        InputError: for a signal that never comes in volts, and for a gain that is zero or not finite.
    """
    for name, gain in calibration.items():
        if name not in CALIBRATED:
            raise InputError(f"calibration: unknown signal {name!r}{did_you_mean(str(name), CALIBRATED)}")
        if not units.is_finite(gain) or gain == 0:
            raise InputError(f"calibration: '{name}' is {gain!r}; give its {UNITS[name]} per volt")
