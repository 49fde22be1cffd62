"""Small sound files of every kind that a person may be sent, from which damaged ones are made."""

from __future__ import annotations

import importlib.util
import io
import json
import struct
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from scipy.io import savemat

from flexarm_env.arm_file import shipped_arms

#: Kinds of files: recordings, arms, maps of columns, trained policies.
KINDS = ("recording", "arm", "columns", "policy")
POLICIES = Path(__file__).resolve().parents[2] / "results" / "policies" / "weights"
ROWS = 12

OWN = "# payload = 0.3 kg\n# trial: 2\ntime [s],current [A],arm_angle [rad],reference [deg]\n"
LOGGER = {
    "delimiter": ";",
    "decimal": ",",
    "time": {"column": "t", "unit": "ms"},
    "current": {"column": "i", "unit": "mA"},
    "arm_angle": {"column": "phi", "unit": "deg", "sign": -1},
}
BLANKS = {
    "delimiter": " ",
    "time": {"index": 0, "unit": "s"},
    "current": {"index": 1, "unit": "A"},
    "arm_angle": {"index": 2, "unit": "rad", "wrap": "2 rad"},
}
VARIABLES = {
    "time": {"variable": "data.t", "unit": "s"},
    "current": {"variable": "m", "index": 0, "unit": "A"},
    "arm_angle": {"variable": "c{1}", "unit": "deg"},
}
LABVIEW = {
    "time": {"column": "X_Value", "unit": "s"},
    "current": {"column": "Motor", "unit": "A"},
    "arm_angle": {"column": "Encoder", "unit": "rad"},
}
LABVIEW_HEAD = (
    "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nDecimal_Separator\t.\nMulti_Headings\tYes\nX_Columns\tOne\n"
    "***End_of_Header***\t\n\t\nChannels\t2\t\t\nSamples\t12\t12\t\nX0\t0\t0\t\nDelta_X\t0.1\t0.1\t\n"
    "***End_of_Header***\t\t\t\nX_Value\tMotor\tEncoder\tComment\n"
)
MESSAGES = {
    "time": {"variable": "log_time", "unit": "s"},
    "current": {"variable": "/state.motor.i", "unit": "A"},
    "arm_angle": {"variable": "/state.phi[0]", "unit": "rad"},
}
PARQUET = {
    "time": {"column": "t", "unit": "s"},
    "current": {"column": "i", "unit": "A"},
    "arm_angle": {"column": "state[1]", "unit": "rad"},
}


@dataclass(frozen=True)
class Sound:
    """A file that is read.

    Attributes:
        kind: one of KINDS.
        suffix: of its name.
        content: of the file.
        columns: for a recording, the map by which it is read; None for FlexArm's own header.
    """

    kind: str
    suffix: str
    content: bytes
    columns: dict[str, Any] | None = None


@cache
def corpus() -> dict[str, tuple[Sound, ...]]:
    """Collect the sound files by kind; those of a format whose library is not installed are left out."""
    policies = [] if importlib.util.find_spec("safetensors") is None else sorted(POLICIES.glob("*.safetensors"))[::12]
    maps = (LOGGER, BLANKS, VARIABLES, LABVIEW)
    return {
        "recording": (*_texts(), *_matlab(), *_logs()),
        "arm": tuple(Sound("arm", ".toml", path.read_bytes()) for path in shipped_arms().values()),
        "columns": tuple(Sound("columns", ".toml", _toml(table).encode()) for table in maps),
        "policy": tuple(Sound("policy", ".safetensors", path.read_bytes()) for path in policies),
    }


def _rows(delimiter: str, decimal: str = ".", columns: int = 3) -> str:
    numbers = [(0.1 * k, k % 5 - 2.0, 0.01 * k * k, 3.0 * k) for k in range(ROWS)]
    return "".join(delimiter.join(f"{x:.4g}" for x in row[:columns]).replace(".", decimal) + "\n" for row in numbers)


def _texts() -> Iterator[Sound]:
    own = OWN + _rows(",", columns=4)
    yield Sound("recording", ".csv", own.encode())
    yield Sound("recording", ".csv", own.replace("\n", "\r\n").encode("utf-8-sig"))
    yield Sound("recording", ".csv", ("sep=;\nt;i;phi\n" + _rows(";", ",")).encode(), LOGGER)
    yield Sound("recording", ".txt", _rows(" ").encode(), BLANKS)
    yield Sound("recording", ".lvm", (LABVIEW_HEAD + _rows("\t")).encode(), LABVIEW)


def _matlab() -> Iterator[Sound]:
    time, current, angle = np.array([[float(x) for x in row.split(",")] for row in _rows(",").splitlines()]).T
    inner = {"data": {"t": time, "note": "x"}, "m": current[:, None], "c": np.array([angle, "x"], dtype=object)}
    for compressed in (False, True):
        file = io.BytesIO()
        savemat(file, inner, do_compression=compressed)
        yield Sound("recording", ".mat", file.getvalue(), VARIABLES)
    version_4 = io.BytesIO()
    savemat(version_4, {"t": time, "i": current, "phi": angle}, format="4")
    plain = {"time": ("t", "s"), "current": ("i", "A"), "arm_angle": ("phi", "rad")}
    yield Sound("recording", ".mat", version_4.getvalue(), {k: {"variable": v, "unit": u} for k, (v, u) in plain.items()})


def _logs() -> Iterator[Sound]:
    """Yield files of the extra `logs`, as far as its libraries are installed."""
    if importlib.util.find_spec("pyarrow") is not None:
        import pyarrow
        from pyarrow import parquet

        table = {"t": 0.1 * np.arange(ROWS), "i": 1.0 * np.arange(ROWS), "state": [[0.0, 0.1 * k] for k in range(ROWS)]}
        with tempfile.TemporaryDirectory() as folder:
            parquet.write_table(pyarrow.table(table), f"{folder}/x.parquet")
            yield Sound("recording", ".parquet", Path(folder, "x.parquet").read_bytes(), PARQUET)
    if importlib.util.find_spec("mcap") is not None:
        from mcap.writer import Writer

        file = io.BytesIO()
        writer = Writer(file)
        writer.start()
        channel = writer.register_channel("/state", "json", writer.register_schema("State", "jsonschema", b"{}"))
        for k in range(ROWS):
            data = json.dumps({"motor": {"i": k}, "phi": [0.5 * k]}).encode()
            writer.add_message(channel, log_time=10**9 + k * 10**8, data=data, publish_time=0)
        writer.finish()
        yield Sound("recording", ".mcap", file.getvalue(), MESSAGES)


def _toml(table: dict[str, Any]) -> str:
    entries = [
        f"{key} = {{ {', '.join(f'{name} = {json.dumps(part)}' for name, part in value.items())} }}"
        if isinstance(value, dict)
        else f"{key} = {json.dumps(value)}"
        for key, value in table.items()
    ]
    return "[columns]\n" + "\n".join(entries) + "\n"


#: 32-bit numbers at which sizes and codes of binary formats turn over.
TURNS = tuple(struct.pack("<I", number) for number in (0, 1, 2**31 - 1, 2**31, 2**32 - 1, 14, 2**16, 10**9))
