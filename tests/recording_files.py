"""What the tests of recordings share: files, column maps, and how a refusal looks."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from flexarm_env.errors import InputError
from flexarm_env.recordings.recording import Recording

HEADER = "time [s],current [A],arm_angle [rad]"

GOOD = f"{HEADER}\n0,1,0.5\n0.1,2,0.6\n0.2,3,0.7\n"

CU_BOULDER = {
    "delimiter": "\t",
    "header_prefix": "%",
    "time": {"column": "Time (ms)", "unit": "ms"},
    "voltage": {"column": "Output Voltage (V)", "unit": "V"},
    "arm_angle": {"column": "Hubangle(Theta in rad)", "unit": "rad"},
    "tip_deflection": {"index": 2, "unit": "m", "sign": -1},
    "reference": {"column": "Position Reference (rad)", "unit": "rad"},
}

EMPS = {
    "time": {"variable": "t", "unit": "s"},
    "voltage": {"variable": "vir", "unit": "V"},
    "arm_angle": {"variable": "qm", "unit": "m", "scale": "1 rad/m"},
    "reference": {"variable": "qg", "unit": "m", "scale": "1 rad/m"},
}

LOGGER = {
    "delimiter": ";",
    "decimal": ",",
    "time": {"column": "t", "unit": "ms"},
    "current": {"column": "i", "unit": "mA"},
    "arm_angle": {"column": "phi", "unit": "deg", "sign": -1},
}


def save(folder: Path, content: str | bytes, name: str = "run.csv") -> Path:
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def refusal(path: Path, **options: Any) -> str:
    """Return the one line that reading a bad file gives, without the path that it must begin with."""
    with pytest.raises(InputError) as caught:
        Recording.read(path, **options)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert len(message.splitlines()) == 1
    return message.removeprefix(f"{path}: ")


def same(a: Recording, b: Recording) -> bool:
    names = ["time", "command", *a.signals, *(["reference"] if a.reference is not None else [])]

    def bits(recording: Recording, name: str) -> bytes:
        values = getattr(recording, name, None)
        return (recording.signals[name] if values is None else values).tobytes()

    return (
        a.input_kind == b.input_kind
        and list(a.signals) == list(b.signals)
        and (a.reference is None) == (b.reference is None)
        and a.conditions == b.conditions
        and all(bits(a, name) == bits(b, name) for name in names)
    )


def example(n: int = 5, **changes: Any) -> Recording:
    fields: dict[str, Any] = {
        "name": "example",
        "time": 0.1 * np.arange(n),
        "input_kind": "current",
        "command": np.arange(n),
        "signals": {"arm_angle": np.linspace(0, 1, n)},
    }
    return Recording.from_arrays(**(fields | changes))
