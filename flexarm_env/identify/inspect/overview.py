"""Overview of recordings before any fit: extent, signals, faults, and what they can show of an arm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.estimate_excitation import excitation_of
from flexarm_env.identify.inspect.excitation import Excitation
from flexarm_env.identify.inspect.inspection import Inspection, inspect_recordings
from flexarm_env.identify.inspect.restart import restart
from flexarm_env.identify.inspect.signal_facts import SignalFacts
from flexarm_env.identify.progress import Progress, ProgressCallback
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.preflight import preflight
from flexarm_env.identify.settings import SETTINGS, Settings
from flexarm_env.parameters import INPUTS, reading_noise
from flexarm_env.recordings.clock import RestartError
from flexarm_env.recordings.recording import Recording

NO_EXCITATION = Excitation((), (), "")


@dataclass(frozen=True)
class Overview:
    """What recordings hold, and what they can show of an arm.

    Attributes:
        arm: as given.
        recordings: of the machine.
        inspection: facts on their signals, and the faults found.
        excitation: limits before any fit.
        notes: a line each on noise, sampling and conditions.
        insufficient: whether they are too poor for a diagnosis.
    """

    arm: Arm
    recordings: tuple[Recording, ...]
    inspection: Inspection
    excitation: Excitation
    notes: tuple[str, ...] = ()
    insufficient: bool = False

    @property
    def is_sound(self) -> bool:
        """Whether the recordings can be diagnosed: without a fault, and sufficient."""
        return not (self.inspection.faults or self.insufficient)

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data, SI units beside the values."""
        return {
            "extents": {one.name: _extent(one) for one in self.recordings},
            "signals": [self._signal(facts) for facts in self.inspection.signals],
            "notes": list(self.notes),
            "insufficient": self.insufficient,
            "faults": [fault.as_json() for fault in self.inspection.faults],
            "excitation": self.excitation.as_json(),
        }

    def _signal(self, facts: SignalFacts) -> dict[str, Any]:
        samples = next(len(one) for one in self.recordings if one.name == facts.recording)
        return {
            "recording": facts.recording,
            "signal": facts.signal,
            "unit": facts.unit,
            "low": facts.low,
            "high": facts.high,
            "resolution": facts.step,
            "noise": facts.noise,
            "stated_noise": stated_noise(self.arm, facts.signal),
            "measured": facts.samples / samples,
        }


def overview(
    arm: Arm,
    recordings: Sequence[Recording],
    progress: ProgressCallback | None = None,
    settings: Settings = SETTINGS,
    inspection: Inspection | None = None,
) -> Overview:
    """Inspect recordings, and estimate what they can show of an arm.

    Args:
        arm: as given.
        recordings: of the machine.
        progress: called with the share done and a text.
        settings: numbers of the method.
        inspection: of these recordings, if they were inspected before.

    Raises:
        InputError: for recordings that do not fit the arm.
    """
    signals, limits = Progress.to(progress).split(1, 19)
    signals.at(0.0, "signals")
    inspection = inspect_recordings(arm, recordings, settings) if inspection is None else inspection
    reduced, dataset = prepare(arm, recordings, settings, noises=inspection.noises)
    checked = preflight(dataset)
    # Sizes are measured by the motion: without any they would be of the noise.
    excitation = NO_EXCITATION if checked.too_still else excitation_of(reduced, dataset, limits)
    return Overview(arm, tuple(recordings), inspection, excitation, checked.notes, checked.too_poor)


def overview_of_restart(arm: Arm, error: RestartError) -> Overview:
    """Build the overview of a file whose clock starts again: its fault alone, since it cannot be read as one recording."""
    return Overview(arm, (), Inspection((restart(error),), (), (), 0.0), NO_EXCITATION)


def stated_noise(arm: Arm, signal: str) -> float | None:
    """Look up the noise of a signal's readings that an arm file states, in the signal's unit; None where it states none."""
    stated = signal in arm.sensors and signal not in arm.auto_noise
    noise = reading_noise(arm.sensors[signal]) if stated else 0.0
    return noise if noise > 0.0 else None


def _extent(recording: Recording) -> dict[str, Any]:
    """Give the extent of a recording; times in s, the rate in Hz."""
    return {
        "samples": len(recording),
        "duration": {"value": recording.duration, "unit": "s"},
        "rate": {"value": 1.0 / recording.sample_time, "unit": "Hz"},
        "input": {
            "kind": recording.input_kind,
            "low": float(recording.command.min()),
            "high": float(recording.command.max()),
            "unit": INPUTS[recording.input_kind],
        },
        "gaps": [{"time": float(recording.time[i]), "length": length, "unit": "s"} for i, length in recording.gaps],
        "conditions": recording.conditions,
    }
