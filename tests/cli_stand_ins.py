"""What the tests of the command line share: a caller, files, and results made by hand in place of the identification."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest

from flexarm_env import cli
from flexarm_env.identify.explain.comparison import Comparison, Replay, Row
from flexarm_env.identify.results import Candidate, Diagnosis, Estimate
from flexarm_env.recordings.recording import Recording

HEADER = "time [s],current [A],arm_angle [rad]\n"

ROWS = "0,1,0\n0.1,1,0.1\n0.2,0,0.2\n"
#: Of the same rows by index, whatever the header says.
MAP = """
[columns]
time = {index = 0, unit = 's'}
current = {index = 1, unit = 'A'}
arm_angle = {index = 2, unit = 'rad'}
"""

OWN = '''
from flexarm_env.effects import Effect
from flexarm_env.effects.base import torque_size


class Mine(Effect):
    """A torque of my own."""

    name = "my_torque"
    equation = "T = a"
    parameters = {"size": torque_size("a", 0.1)}
    looks_like = "a constant error"

    @staticmethod
    def torque(size):
        return size
'''

GOOD_ARM = """
[drive]
torque_constant = 0.33
gear_ratio = 1.5
motor_inertia = 0.00193
[hub]
inertia = 0.13
[sensors.arm_angle]
noise = "0.1 deg"
[effects.coulomb]
torque = "0.2 Nm"
"""

PLOTS = importlib.util.find_spec("plotly") is not None and importlib.util.find_spec("matplotlib") is not None

needs_plots = pytest.mark.skipif(not PLOTS, reason="the extra plots is not installed")


class Call:
    """Runs a command line in this process; afterwards it knows what came out."""

    def __init__(self, capsys):
        self.capsys = capsys

    def __call__(self, *arguments) -> int:
        self.code = cli.run([str(a) for a in arguments])
        self.out, self.err = self.capsys.readouterr()
        return self.code

    def refused(self, *arguments) -> str:
        """Run what must be refused; return the one line on stderr."""
        assert self(*arguments) == 2, self.out + self.err
        assert self.out == ""
        assert self.err.startswith("flexarm: ")
        assert self.err.endswith("\n")
        assert len(self.err.splitlines()) == 1
        assert "Traceback" not in self.err
        return self.err


def estimate(path: str, value: float, half: float, unit: str, nominal: float = 0.0) -> Estimate:
    return Estimate(path, value, value - half, value + half, unit, nominal)


GAP = estimate("effects.backlash.gap", 0.0612, 0.003, "rad")

KPHI = estimate("drive.torque_constant", 0.3312, 0.0021, "Nm/A", 0.33)


def fake_compare(arm, recordings, progress=None, rate=None):
    def replay(r: Recording) -> Replay:
        model = {s: v - 0.1 * (v - v.mean()) for s, v in r.signals.items()}
        return Replay(r.name, r.time, r.signals, model, model, np.zeros(len(r), dtype=np.int64))

    nan = float("nan")
    rows = [
        Row("all", "arm_angle", "all", 1.5, 12.0, 98.7, 200),
        Row("all", "arm_angle", "stuck", nan, nan, nan, 0),
        Row("all", "arm_angle", "0-2 Hz", 1.4, nan, nan, 200),
        Row("all", "all", "all", 1.5, 12.0, nan, 200),
    ]
    noise = {signal: 0.01 for signal in recordings[0].signals}
    return Comparison(arm, rows, [replay(r) for r in recordings], noise, 1.5, 12.0, ["pulse: the motor saturates"])


def fake_diagnosis(arm, verdict="effects", effects=("backlash",), seed=0):
    ranking = [Candidate("backlash", 0.93, bool(effects), [GAP]), Candidate("stribeck", 0.04, False, [])]
    error = {"nominal": 4.1, "refitted": 3.7, "final": 1.02 if effects else 3.7, **dict.fromkeys(effects, 1.02)}
    better = arm.with_effect("backlash", gap=0.0612) if effects else arm
    return Diagnosis(
        verdict,
        list(effects),
        [["backlash", "gear_compliance"]] if effects else [],
        ranking,
        error,
        {key: 10 * value for key, value in error.items()},
        {"torque_constant": KPHI},
        better,
        arm,
        arm,
        ["A slow ramp would settle it."],
        1.23,
        seed,
        probability=[[0.83, 0.12]] if effects else [],
    )
