"""A drive that the pulses of one recording hold at its limit looks there like a command of another unit."""

from __future__ import annotations

from dataclasses import replace

import pytest

from flexarm_env import Arm, Recording, simulate
from flexarm_env.identify.inspect.motion import motion_faults

#: Part of the drive's range beyond which the machine's saturates.
SHARE = 0.05


def recorded(name: str, share: float) -> tuple[Arm, list[Recording]]:
    """Record a square wave and pulses of an arm with a drive of part of its range."""
    arm = Arm.load(name)
    machine = arm.with_effect("saturation", limit=share * arm.constants["drive"]["limit"])
    return arm, [simulate(machine, experiment, duration=6.0, rate=500.0, seed=1) for experiment in ("square", "pulse")]


@pytest.mark.parametrize("name", ["ur10e-joint1", "cu-rigid"])
def test_a_limit_that_one_recording_takes_for_a_factor_is_no_fault(name: str) -> None:
    arm, (square, pulse) = recorded(name, SHARE)
    assert [(fault.kind, fault.signal) for fault in motion_faults(arm, [pulse])] == [("factor", arm.input)]
    assert motion_faults(arm, [square, pulse]) == []


@pytest.mark.parametrize(("name", "unit"), [("ur10e-joint1", "mA"), ("cu-rigid", "mV")])
def test_a_command_in_another_unit_is_found_in_one_recording_of_two(name: str, unit: str) -> None:
    arm, (square, pulse) = recorded(name, 1.0)
    (fault,) = motion_faults(arm, [square, replace(pulse, command=1000.0 * pulse.command)])
    assert (fault.recording, fault.signal, fault.value) == (pulse.name, arm.input, 1000.0)
    assert f'unit = "{unit}"' in fault.line
