"""Inverse dynamics of a rigid arm: the command that its model needs for the measured motion."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, cheby1, filtfilt

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.experiments.stated import stated_by, with_stated
from flexarm_env.identify.explain.hub_torque import acts_on_hub, arguments, law_torque
from flexarm_env.machine import weight
from flexarm_env.plant.assembly import assemble
from flexarm_env.recordings.recording import Recording

Floats = NDArray[np.float64]

ORDER = 4
#: Decimation as MATLAB's: order and ripple of its filter, and the share of the new Nyquist frequency.
DECIMATING = (8, 0.05, 0.8)


@dataclass(frozen=True)
class Recipe:
    """How motion and command are filtered, always without phase.

    Attributes:
        angle: cut-off of the angle [Hz], whose slope is the speed; 0 takes the measured speed as it is.
        both: cut-off of predicted and recorded command alike [Hz]; 0 for none.
        dropped: samples at the start that do not count.
        decimation: of both commands; 1 for none.
        at_rest: speed up to which dry friction holds the arm, up to its size [rad/s].
    """

    angle: float = 0.0
    both: float = 0.0
    dropped: int = 0
    decimation: int = 1
    at_rest: float = 0.0


def predicted_and_recorded(arm: Arm, recording: Recording, recipe: Recipe) -> tuple[Floats, Floats]:
    """Compute the command (samples,) of an arm for the measured motion, beside that of the recording behind the drive.

    Effects count that act as a torque on the hub, that change or delay the command; others are left out.

    Args:
        arm: rigid, under current or torque.
        recording: with its angle, and its speed where the recipe takes that.
        recipe: filters.

    Raises:
        InputError: for an arm with a beam, or under voltage.
    """
    if arm.has("beam") or arm.input not in ("current", "torque"):
        raise InputError(f"arm '{arm.name}': inverse dynamics are those of a rigid arm that is driven by current or torque")
    arm = with_stated(arm, stated_by(arm, recording))
    rate, time, angle = 1.0 / recording.sample_time, recording.time, recording.signals["arm_angle"]
    if recipe.angle:
        angle = _low_pass(angle, recipe.angle, rate)
        speed = np.gradient(angle, time)
    else:
        speed = recording.signals["motor_speed"] / (arm.value("drive.gear_ratio") * arm.value("sensors.motor_speed.gain"))
    by_command, recorded = arm.structure().torque_by_command, _behind_drive(arm, recording)
    inertial = _inertia(arm) * np.gradient(speed, time)
    torque = inertial - _resisting(arm, inertial - by_command * recorded, angle, speed, time, recipe.at_rest)
    return _filtered(torque / by_command, recipe, rate), _filtered(recorded, recipe, rate)


def _resisting(arm: Arm, missing: Floats, angle: Floats, speed: Floats, time: Floats, at_rest: float) -> Floats:
    """Compute the torque (samples,) of all effects on the hub [Nm]; at rest dry friction gives what is missing, up to its size.

    Args:
        arm: with the effects.
        missing: (samples,) torque that the drive leaves to them [Nm].
        angle: (samples,) [rad].
        speed: (samples,) [rad/s].
        time: (samples,) [s].
        at_rest: speed up to which the hub is at rest [rad/s].
    """
    names = [name for name, _ in arm.present() if acts_on_hub(arm, name)]
    dry = [name for name in names if arm.known[name].port("friction")]
    others = law_torque(arm, [name for name in names if name not in dry], angle, speed, time) + _weight(arm, angle)
    sliding = law_torque(arm, dry, angle, speed, time)
    if not at_rest:
        return others + sliding
    most = np.abs(law_torque(arm, dry, angle, np.full_like(speed, at_rest), time))
    return others + np.where(np.abs(speed) <= at_rest, np.clip(missing - others, -most, most), sliding)


def _inertia(arm: Arm) -> float:
    """Compute all that turns with a rigid arm [kg m²]; an effect that lets a part of it give way leaves that out."""
    rigid = replace(arm, effects={})
    parts = len(assemble(rigid.structure()).names)
    for name, values in arm.effects.items():
        with_it = replace(rigid, effects={**rigid.effects, name: values})
        rigid = with_it if len(assemble(with_it.structure()).names) == parts else rigid
    return float(assemble(rigid.structure()).mass.sum())


def _weight(arm: Arm, angle: Floats) -> Floats:
    """Compute the torque (samples,) of the weight of a link, and of a payload at its tip [Nm]."""
    largest, uphill = weight(arm.constants)
    if not largest:
        return np.zeros_like(angle)
    link, structure = arm.constants["link"], arm.structure()
    hung = structure.payload * link["length"] / (link["mass"] * link["centre"])
    return largest * (1.0 + hung) * np.sin(angle - uphill)


def _behind_drive(arm: Arm, recording: Recording) -> Floats:
    """Pass the recorded command (samples,) through the drive: its delay, dead zone and limits."""
    time = recording.time
    command = np.interp(time - arm.structure().input_delay, time, recording.command)
    for name, values in arm.present():
        law = arm.known[name].port("drive")
        if law is not None:
            given, found = dict(values) | {"interval": recording.sample_time}, command.copy()
            for k, value in enumerate(command):
                motion = {"command": float(value), "previous": float(found[max(k - 1, 0)])}
                found[k] = law(*((motion | given)[key] for key in arguments(law)))
            command = found
    return command


def _low_pass(values: Floats, cut_off: float, rate: float) -> Floats:
    b, a = butter(ORDER, 2.0 * cut_off / rate)
    return np.asarray(filtfilt(b, a, values, padlen=3 * (len(a) - 1)), dtype=np.float64)


def _filtered(command: Floats, recipe: Recipe, rate: float) -> Floats:
    """Filter a command as the recipe says."""
    if recipe.both:
        command = _low_pass(command, recipe.both, rate)
    command = command[recipe.dropped :]
    if recipe.decimation == 1:
        return command
    order, ripple, share = DECIMATING
    b, a = cheby1(order, ripple, share / recipe.decimation)
    smooth = filtfilt(b, a, command, padlen=3 * (len(a) - 1))
    return np.asarray(smooth[(len(command) - 1) % recipe.decimation :: recipe.decimation], dtype=np.float64)
