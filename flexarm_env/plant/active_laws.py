"""The laws of effects that act on an arm, and their lists in the plant's flat arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from flexarm_env.plant import layout as at

#: Place in n of each port's list of laws.
LAW_LISTS = {
    "friction": at.FRICTION_LAWS,
    "factor": at.FACTOR_LAWS,
    "presliding": at.PRESLIDING_LAWS,
    "torque": at.TORQUE_LAWS,
    "weight": at.WEIGHT_LAWS,
    "drag": at.DRAG_LAWS,
    "drive": at.DRIVE_LAWS,
    "ramp": at.RAMP_LAWS,
    "spring": at.SPRING_LAWS,
    "sensor": at.SENSOR_LAWS,
}


#: Ports whose laws change while a body turns one way.
VARYING_PORTS = frozenset({"factor", "presliding", "torque", "weight", "drag", "spring"})


@dataclass(frozen=True)
class ActiveLaw:
    """One active law: its place in the catalogue's list of laws, its parameters in the law's order.

    `varies` is true if it changes while a body turns one way, so that the force must be fitted over each step. `motor_share` is
    the part of it that acts on the motor if motor and hub are two bodies, `reads` the signals that it changes. `dry` is false of
    a lubricant's friction.
    """

    kind: int
    port: str
    parameters: tuple[float, ...]
    varies: bool
    motor_share: float = 0.0
    reads: tuple[str, ...] = ()
    dry: bool = True


def law_lists(
    active: Sequence[ActiveLaw], start: int, bodies: int, signals: Sequence[str]
) -> tuple[list[list[int]], list[float]]:
    """List the laws by port, and their parameters.

    A port's list is the number of its laws, then the kind of each and the place of its parameters. In front of these stand
    whether it is dry, and the shares that act on the hub and on the motor. A sensor's law has one entry for each signal that it
    changes, with the signal's number as a third column.
    """
    parameters: list[float] = []
    lists = []
    for port in list(LAW_LISTS)[:-1]:
        laws = [law for law in active if law.port == port]
        rows = [len(laws)]
        for law in laws:
            share = law.motor_share if bodies == 2 else 0.0
            parameters += [float(law.dry), 1.0 - share, share]
            rows += [law.kind, start + len(parameters)]
            parameters += law.parameters
        lists.append(rows)
    rows = [0]
    for law in (law for law in active if law.port == "sensor"):
        changed = [number for number, signal in enumerate(signals) if signal in law.reads]
        rows[0] += len(changed)
        for number in changed:
            rows += [law.kind, start + len(parameters), number]
        parameters += law.parameters
    return [*lists, rows], parameters
