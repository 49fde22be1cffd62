"""Recordings: the command of an arm and the readings of its sensors, in SI, read from a file and written to one."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flexarm_env.control.law import ControlLaw
from flexarm_env.display import Shown
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.files import write_whole
from flexarm_env.parameters import INPUTS
from flexarm_env.recordings.checks import as_vector, check_conditions
from flexarm_env.recordings.clock import RestartError
from flexarm_env.recordings.column_maps import load_columns
from flexarm_env.recordings.columns import ColumnMap, Source, check_calibration
from flexarm_env.recordings.copies import with_copies_noted
from flexarm_env.recordings.csv_text import csv_text
from flexarm_env.recordings.episodes import check_episodes, episodes_of
from flexarm_env.recordings.files import PathLike, read_bytes
from flexarm_env.recordings.formats.catalogue import format_of
from flexarm_env.recordings.formats.lerobot import with_info
from flexarm_env.recordings.joined import read_joined, recording_files, recording_name
from flexarm_env.recordings.messages import file_error
from flexarm_env.recordings.samples import samples_of
from flexarm_env.recordings.sidecar import conditions_beside
from flexarm_env.recordings.stretches import stretches_of
from flexarm_env.recordings.table import Table
from flexarm_env.sensors import known_sensors

Floats = NDArray[np.float64]
Columns = PathLike | Mapping[str, Any] | ColumnMap

GAP = 3.0  # a step of more than this many median steps is a gap


@dataclass(frozen=True, eq=False, repr=False)
class Recording(Shown):
    """One run of an arm, of n samples in SI. Sampling need not be even.

    Attributes:
        name: for tables and plots.
        time: (n,) [s], rising from 0.
        input_kind: "current", "voltage", "torque" or "position".
        command: (n,) [A, V, Nm or rad], the commanded input of the drive.
        signals: (n,) each, by name, in the SI unit of its sensor, such as arm_angle [rad]; none in commands that are only to be
            played. NaN where a signal was not measured: between the readings of a slower sensor, and in its gaps.
        reference: (n,) [rad], the commanded arm angle, or None.
        conditions: known conditions in SI. A replay takes up `payload` [kg], and those to which the arm gives a constant. The
            others inform a person, also `start` [s], how long the run had gone on before the first sample: times of effects
            count from that sample.
        controller: the law under which it was made, if its column map states one.
        source: the path it was read from; "" if from none.
        sha256: of that file's content; "" if from none.
        notes: one line each on how the recording was read or made, where a person might expect otherwise.
        unread: notes on conditions that its file states and that cannot be read, by name.
        gaps: for each step over three median steps, the index of the sample before it and its length [s].
    """

    name: str
    time: Floats
    input_kind: str
    command: Floats
    signals: dict[str, Floats]
    reference: Floats | None = None
    conditions: dict[str, float] = field(default_factory=dict)
    controller: ControlLaw | None = None
    source: str = ""
    sha256: str = ""
    notes: tuple[str, ...] = ()
    unread: dict[str, str] = field(default_factory=dict)
    gaps: list[tuple[int, float]] = field(init=False)

    def __post_init__(self) -> None:
        steps = np.diff(self.time)
        long = np.flatnonzero(steps > GAP * np.median(steps))
        object.__setattr__(self, "gaps", [(int(i), float(steps[i])) for i in long])

    def __len__(self) -> int:
        return len(self.time)

    def __repr__(self) -> str:
        gaps = f", {len(self.gaps)} gaps" if self.gaps else ""
        extent = f"{len(self)} samples, {self.duration:.4g} s at {1 / self.sample_time:.4g} Hz{gaps}"
        signals = [f"{name}{_share_measured(values)}" for name, values in self.signals.items()]
        return f"Recording({self.name!r}: {extent}, {self.input_kind} -> {', '.join(signals)})"

    @property
    def sample_time(self) -> float:
        """The median step [s]."""
        return float(np.median(np.diff(self.time)))

    @property
    def duration(self) -> float:
        """Time of the last sample [s]."""
        return float(self.time[-1])

    @classmethod
    def from_arrays(
        cls,
        name: str,
        time: ArrayLike,
        input_kind: str,
        command: ArrayLike,
        signals: Mapping[str, ArrayLike],
        reference: ArrayLike | None = None,
        conditions: Mapping[str, float] | None = None,
        require_signal: bool = True,
    ) -> Recording:
        """Make a recording of copies of (n,) arrays in SI, checked as a file is.

        Args:
            name: for tables and plots.
            time: (n,) [s], rising; it is shifted to start at 0.
            input_kind: "current", "voltage", "torque" or "position".
            command: (n,) [A, V, Nm or rad].
            signals: (n,) each, by name, in SI; NaN where one was not measured.
            reference: (n,) [rad].
            conditions: known conditions in SI.
            require_signal: whether there must be a signal; False takes commands alone, to be played.

        Raises:
            InputError: for an unknown name, lengths that differ, fewer than two samples, numbers that are not
                finite (but NaN in a signal), a signal without a reading, or time that does not rise.

        Examples:
            >>> import numpy as np
            >>> from flexarm_env import Recording
            >>> time = np.arange(0.0, 1.0, 0.01)
            >>> run = Recording.from_arrays("run", time, "current", np.sin(time), {"arm_angle": 1.0 - np.cos(time)})
            >>> run
            Recording('run': 100 samples, 0.99 s at 100 Hz, current -> arm_angle)
        """
        if not isinstance(input_kind, str) or input_kind not in INPUTS:
            raise InputError(f"{name}: unknown input {input_kind!r}{did_you_mean(str(input_kind), INPUTS)}")
        for what, table in (("signals", signals), ("conditions", conditions or {})):
            if not hasattr(table, "keys"):
                raise InputError(f"{name}: {what} = {table!r}; give a dict, with the name of each")
        for signal in signals:
            if signal not in known_sensors():
                raise InputError(f"{name}: unknown signal {signal!r}{did_you_mean(str(signal), known_sensors())}")
        columns = {"time": time, input_kind: command, **signals}
        if reference is not None:
            columns["reference"] = reference
        try:
            arrays = {column: as_vector(column, values) for column, values in columns.items()}
            recording = _recording(name, arrays, dict(conditions or {}))
            _check_signal(recording, require_signal)
        except RestartError as error:
            raise error.of(name) from None
        except InputError as error:
            raise InputError(f"{name}: {error}") from None
        return recording

    @classmethod
    def read(
        cls,
        path: PathLike,
        columns: Columns | None = None,
        calibration: Mapping[str, float] | None = None,
        require_signal: bool = True,
    ) -> Recording:
        r"""Read a recording from a CSV file, or by a column map from any file of another logger.

        Args:
            path: the file. Its time is shifted to start at 0.
            columns: for a foreign file, its `[columns]` table: a TOML file that has one, or a dict.
            calibration: SI per volt for signals that the file has in volts, such as {"arm_angle": 2.0}.
            require_signal: whether the file must hold a signal; False takes commands alone, to be played.

        Raises:
            InputError: for anything that is not such a file: one line with file, row and column.

        Examples:
            >>> from pathlib import Path
            >>> from flexarm_env import Recording
            >>> _ = Path("plain.csv").write_text("time [ms],current [mA],arm_angle [deg]\n0,0,0\n10,500,0\n20,500,9\n")
            >>> run = Recording.read("plain.csv")
            >>> run.time.tolist(), run.command.tolist()
            ([0.0, 0.01, 0.02], [0.0, 0.5, 0.5])

            A file of a logger, by its columns:

            >>> _ = Path("logger.txt").write_text("t;I;encoder\n0;0;0\n10;500;0\n20;500;-9\n")
            >>> columns = {
            ...     "delimiter": ";",
            ...     "time": {"column": "t", "unit": "ms"},
            ...     "current": {"column": "I", "unit": "mA"},
            ...     "arm_angle": {"column": "encoder", "unit": "deg", "sign": -1},
            ... }
            >>> other = Recording.read("logger.txt", columns)
            >>> bool((other.signals["arm_angle"] == run.signals["arm_angle"]).all())
            True
        """
        found = cls.read_each(path, columns, calibration, require_signal)
        if len(found) == 1:
            return found[0]
        layout = None if columns is None else load_columns(columns)
        check_episodes(len(found), layout, f"{path}: ")
        if layout is not None and any(source.split for source in layout.conditions.values()):
            raise file_error(Path(path), f"is split in {len(found)} recordings by its conditions; read all by read_all")
        episodes = f"{len(found)} episodes, which are as many recordings"
        raise file_error(Path(path), f"has {episodes}; name one by episode_index in [columns], or read all by read_all")

    @classmethod
    def read_each(
        cls,
        path: PathLike,
        columns: Columns | None = None,
        calibration: Mapping[str, float] | None = None,
        require_signal: bool = True,
    ) -> list[Recording]:
        """Read the recordings in a file: one, or each episode that the map names, or each part of a run that it splits.

        Arguments are those of `read`.

        Raises:
            InputError: as `read`.
        """
        layout = None if columns is None else load_columns(columns)
        gains = dict(calibration or {})
        check_calibration(gains)
        path = Path(path)
        try:
            if layout is not None and layout.joins:
                table, checksum = read_joined(path, layout, gains)
                name = recording_name(path, layout)
                recordings = [_with_notes(_recording(name, table.values, table.conditions, (), table.sources), table)]
            else:
                content = read_bytes(path)
                layout = None if layout is None else with_info(path, layout)
                tables = episodes_of(format_of(path).table(content, layout), path.stem, layout)
                checksum = hashlib.sha256(content).hexdigest()
                recordings = [one for name, table in tables.items() for one in _stretches(name, table, gains)]
            for recording in recordings:
                _check_signal(recording, require_signal, " to its header" if layout is None else " to [columns]")
        except InputError as error:
            raise file_error(path, error) from None
        controller = None if layout is None else layout.controller
        recordings = [_with_sidecars(one, path, layout) for one in recordings]
        return [replace(one, controller=controller, source=str(path), sha256=checksum) for one in recordings]

    @classmethod
    def read_all(
        cls,
        paths: PathLike | Iterable[PathLike],
        columns: Columns | None = None,
        calibration: Mapping[str, float] | None = None,
        require_signal: bool = True,
    ) -> list[Recording]:
        """Read the recordings in files and folders; a folder stands for those in it, sorted by name, or for its LeRobot data set.

        A copy of another has a note. Where names would come twice, they have the folder's name before them. Arguments as `read`.

        Raises:
            InputError: as `read`; for a folder without recordings; for a file named twice.

        Examples:
            >>> from pathlib import Path
            >>> from flexarm_env import Arm, Recording, simulate
            >>> Path("runs").mkdir()
            >>> for name in ("pulse", "square"):
            ...     simulate(Arm.load("thesis"), name, duration=1.0, rate=100.0).write(f"runs/{name}.csv")
            >>> [run.name for run in Recording.read_all("runs")]
            ['pulse', 'square']
        """
        layout = None if columns is None else load_columns(columns)
        named = [paths] if isinstance(paths, (str, os.PathLike)) else list(paths)
        if "" in named:
            raise InputError("a path is empty, which would be this folder; name a file, or '.'")
        files = recording_files(named, layout)
        recordings = [one for file in files for one in cls.read_each(file, layout, calibration, require_signal)]
        check_episodes(len(recordings), layout)
        return with_copies_noted(with_distinct_names(recordings))

    def write(self, path: PathLike) -> None:
        """Write a CSV file that `read` gives back bit for bit; the file is whole or not there.

        Raises:
            InputError: if the file cannot be written.

        Examples:
            >>> from pathlib import Path
            >>> from flexarm_env import Recording
            >>> signals = {"arm_angle": [0, 0.1]}
            >>> run = Recording.from_arrays("run", [0, 0.5], "voltage", [0, 1], signals, conditions={"payload": 0.3})
            >>> run.write("run.csv")
            >>> print(Path("run.csv").read_text())
            # payload = 0.3 kg
            time [s],voltage [V],arm_angle [rad]
            0.0,0.0,0.0
            0.5,1.0,0.1
            <BLANKLINE>
        """
        columns = {"time": self.time, self.input_kind: self.command}
        columns |= {name: self.signals[name] for name in known_sensors() if name in self.signals}
        if self.reference is not None:
            columns["reference"] = self.reference
        write_whole(Path(path), csv_text(columns, self.conditions))

    def part(self, start: float = 0.0, stop: float | None = None) -> Recording:
        """Cut out the samples with start <= time < stop [s]; without `stop`, up to the end.

        Its time starts at 0 again, and `conditions["start"]` says how long the run had gone on before. A signal without a
        reading there is left out.

        Raises:
            InputError: if fewer than two samples lie there, or no reading.

        Examples:
            >>> from flexarm_env import Recording
            >>> run = Recording.from_arrays("run", [0, 1, 2, 3], "voltage", [0, 1, 1, 0], {"arm_angle": [0, 0, 1, 2]})
            >>> part = run.part(1.0, 3.0)
            >>> part.time.tolist(), part.command.tolist(), part.conditions
            ([0.0, 1.0], [1.0, 1.0], {'start': 1.0})
        """
        # A boundary such as 0.3 must find the sample at 0.30000000000000004.
        slack = 1e-6 * self.sample_time
        first = int(np.searchsorted(self.time, start - slack))
        last = len(self) if stop is None else int(np.searchsorted(self.time, stop - slack))
        if last - first < 2:
            raise InputError(f"{self.name}: fewer than two samples from {start} to {stop} s; it lasts {self.duration:g} s")
        cut = slice(first, last)
        before = self.conditions.get("start", 0.0) + float(self.time[first])
        signals = {name: values[cut].copy() for name, values in self.signals.items() if not np.isnan(values[cut]).all()}
        if self.signals and not signals:
            raise InputError(f"{self.name}: nothing was measured from {start} to {stop} s; take another part")
        return replace(
            self,
            time=self.time[cut] - self.time[first],
            command=self.command[cut].copy(),
            signals=signals,
            reference=None if self.reference is None else self.reference[cut].copy(),
            conditions=self.conditions | ({"start": before} if before else {}),
        )


def _recording(
    name: str,
    arrays: dict[str, Floats],
    conditions: dict[str, float],
    lines: Sequence[int] = (),
    sources: Mapping[str, Source] | None = None,
) -> Recording:
    """Make a recording of (n,) arrays in SI, by column name, checked and corrected.

    Args:
        name: for tables and plots.
        arrays: by column name.
        conditions: in SI.
        lines: the line of each sample in its file, for messages; empty where there is none.
        sources: the columns in a file, with their corrections; None for arrays from elsewhere.
    """
    samples = samples_of(arrays, lines, sources)
    check_conditions(conditions)
    return Recording(
        name=name,
        time=samples.columns["time"],
        input_kind=samples.input_kind,
        command=samples.columns[samples.input_kind],
        signals={signal: samples.columns[signal] for signal in known_sensors() if signal in samples.columns},
        reference=samples.columns.get("reference"),
        conditions=conditions,
        notes=samples.notes,
    )


def _stretches(name: str, table: Table, gains: Mapping[str, float]) -> list[Recording]:
    """Make the recordings of a table: one, or one of each stretch between changes of its conditions."""
    whole = _recording(name, table.in_si(gains), table.conditions, table.lines, table.sources)
    return stretches_of(_with_notes(whole, table), table.changing)


def _with_notes(recording: Recording, table: Table) -> Recording:
    """Add the notes on the reading of a table."""
    return replace(recording, notes=(*table.notes, *recording.notes), unread=table.unread)


def _with_sidecars(recording: Recording, path: Path, columns: ColumnMap | None) -> Recording:
    """Add the conditions in the files beside a recording."""
    stated, notes = conditions_beside(path, columns, recording.conditions)
    return replace(recording, conditions=recording.conditions | stated, notes=(*recording.notes, *notes))


def _share_measured(values: Floats) -> str:
    """Format the share of rows in which a signal was measured; "" for all of them."""
    share = 1.0 - float(np.isnan(values).mean())
    return f" ({100.0 * share:.3g} % measured)" if share < 1.0 else ""


def _check_signal(recording: Recording, required: bool, place: str = "") -> None:
    """Refuse a recording without a signal where one is required, which must be added at a place."""
    if required and not recording.signals:
        raise InputError(f"has no measured signal; add at least one of {', '.join(known_sensors())}{place}")


def with_distinct_names(recordings: Sequence[Recording]) -> list[Recording]:
    """Rename recordings so that they differ: by their folder, else by their path, else by path and name."""
    sources = [Path(recording.source) for recording in recordings]
    for names in (
        [recording.name for recording in recordings],
        [f"{source.parent.name}/{recording.name}" for source, recording in zip(sources, recordings, strict=True)],
        [str(source) for source in sources],
        [f"{source}: {recording.name}" for source, recording in zip(sources, recordings, strict=True)],
    ):
        if len(set(names)) == len(names):
            break
    return [replace(recording, name=name) for recording, name in zip(recordings, names, strict=True)]
