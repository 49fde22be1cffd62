"""The evidence on one recording: its signals beside the model's free run, and beside each other."""

from __future__ import annotations

from dataclasses import dataclass

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.agreement import Agreement
from flexarm_env.identify.inspect.free_run import FreeRun, Replayer, Table, replayer
from flexarm_env.identify.inspect.series import HUB
from flexarm_env.identify.replay.reading_noise import NoiseBySignal
from flexarm_env.identify.settings import MotionFaults, Settings
from flexarm_env.recordings.recording import Recording


@dataclass(frozen=True)
class Evidence:
    """The evidence on one recording.

    Attributes:
        arm: the model.
        recording: of the machine.
        replayer: gives free runs under other commands.
        run: the free run.
        at_once: agreement of each signal with its model.
        late: the same at the lag at which it is best.
        hub: agreement of the arm's angle with the motor's speed, which needs no model; None without both.
    """

    arm: Arm
    recording: Recording
    replayer: Replayer
    run: FreeRun
    at_once: Table
    late: Table
    hub: Agreement | None

    @property
    def numbers(self) -> MotionFaults:
        """Numbers of the method."""
        return self.run.numbers

    @property
    def signals(self) -> tuple[str, ...]:
        """Names of the signals."""
        return self.run.signals

    def agrees(self, signal: str) -> bool:
        """Whether a signal agrees with the model."""
        found = self.late[signal]
        in_time = abs(found.lag) < self.numbers.least_lag
        return in_time and found.is_within(self.numbers.near) and found.share > self.numbers.alike

    @property
    def model_holds(self) -> bool:
        """Whether the model moves as the machine does: a signal of the hub agrees, or any where none is of the hub."""
        of_hub = [signal for signal in self.signals if "beam" not in self.arm.sensor(signal).needs]
        return any(self.agrees(signal) for signal in of_hub or self.signals)

    @property
    def gear_ratio(self) -> float:
        """Turns of the motor for one of the hub."""
        return self.arm.constants["drive"]["gear_ratio"]

    @property
    def hub_in_step(self) -> bool:
        """Whether angle and speed are readings of one motion."""
        return self.hub is not None and self.hub.share > self.numbers.in_step

    def is_like_model_later(self, signal: str) -> bool:
        """Whether a signal runs with the model at a lag, and much more so than without."""
        late = self.late[signal]
        return late.gain > 0.0 and late.explains_more_than(self.at_once[signal], self.numbers)

    def others(self, signal: str) -> list[Agreement]:
        """List the agreements of all signals but one, without a lag."""
        return [found for other, found in self.at_once.items() if other != signal]


def gather(arm: Arm, recording: Recording, settings: Settings, noises: NoiseBySignal | None = None) -> Evidence:
    """Gather the evidence on a recording.

    Args:
        arm: the model.
        recording: of the machine.
        settings: numbers of the method.
        noises: of the arm's sensors, where they were settled before.

    Raises:
        InputError: for a recording that does not fit the arm.
    """
    prepared = replayer(arm, recording, settings, noises)
    run = prepared.free_run()
    both = set(HUB) <= set(run.signals)
    hub = run.hub(arm.constants["drive"]["gear_ratio"]) if both else None
    return Evidence(arm, recording, prepared, run, run.at_once(), run.late(), hub)
