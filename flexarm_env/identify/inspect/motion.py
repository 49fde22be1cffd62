"""Faults of recordings that the model's motion shows: factors, signs, exchanged signals and clocks."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.clock import late_signals
from flexarm_env.identify.inspect.evidence import Evidence, gather
from flexarm_env.identify.inspect.factor import factors
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.in_common import in_common
from flexarm_env.identify.inspect.sign import signs
from flexarm_env.identify.inspect.sized import sized
from flexarm_env.identify.inspect.swap import exchanged_signals
from flexarm_env.identify.replay.reading_noise import NoiseBySignal
from flexarm_env.identify.settings import SETTINGS, Settings
from flexarm_env.recordings.recording import Recording

#: Kinds in the order in which they are looked for: each would look like a fault of the kinds after it.
MOTION_CHECKS: tuple[Callable[[Evidence], list[Fault]], ...] = (exchanged_signals, late_signals, signs, factors)


def motion_faults(
    arm: Arm, recordings: Sequence[Recording], settings: Settings = SETTINGS, noises: NoiseBySignal | None = None
) -> list[Fault]:
    """Find faults of signals and of the command that the model's motion shows, before anything is calibrated.

    One free run of the model is compared with every signal in windows of a second, each with an offset and a drift of its own:
    so wrong constants and missing effects change gains and shapes a little, and a fault much. Angle and speed are also compared
    with each other, without a model. What most recordings show, all have.

    Args:
        arm: the model.
        recordings: of the machine.
        settings: numbers of the method.
        noises: of the arm's sensors, where they were settled before.

    Returns:
        The faults of each recording, in the order of the recordings. A fault of the column map comes once for each.

    Raises:
        InputError: for recordings that do not fit the arm.

    Example:
        >>> from dataclasses import replace
        >>> from flexarm_env import Arm, simulate
        >>> arm = Arm.load("thesis")
        >>> run = simulate(arm, "square", duration=6.0, seed=1)
        >>> against = replace(run, signals={**run.signals, "strain_base": -run.signals["strain_base"]})
        >>> [fault.signal for fault in motion_faults(arm, [against])]
        ['strain_base']
    """
    with_signals = [one for one in recordings if set(one.signals) & set(arm.signals)]  # else the readings of all were at fault
    evidence = [gather(arm, recording, settings, noises) for recording in with_signals]
    found: list[list[Fault]] = [next((faults for check in MOTION_CHECKS if (faults := check(one))), []) for one in evidence]
    return sized(evidence, in_common(evidence, found))


def moves_as_model(
    arm: Arm, recordings: Sequence[Recording], settings: Settings = SETTINGS, noises: NoiseBySignal | None = None
) -> bool:
    """Whether the model moves as the machine does in every recording."""
    with_signals = [one for one in recordings if set(one.signals) & set(arm.signals)]
    return all(gather(arm, recording, settings, noises).model_holds for recording in with_signals)
