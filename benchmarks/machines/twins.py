"""Effects that move a machine alike in its recordings, so that no method parts them there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from benchmarks.machines.catalogue import PLANT
from benchmarks.machines.effects import Sized
from benchmarks.machines.experiments import Run
from benchmarks.machines.model import Model
from benchmarks.machines.strength import Yardstick

#: Effects that move a machine alike unless it rests, or unless its commands change fast; size of the second over the first's.
ALIKE = {
    "constant_torque": ("asymmetric_coulomb", -1.0),
    "asymmetric_coulomb": ("constant_torque", -1.0),
    "input_delay": ("current_lag", 1.0),
    "current_lag": ("input_delay", 1.0),
}
#: Difference over the noise below which two effects move a machine alike: the error of one in place of the other is 1.001.
SAME = 0.05


def twins(machine: Model, runs: Sequence[Run], hidden: Sequence[Sized]) -> dict[str, str]:
    """Find effects that move a machine as a hidden one does, on the rig and in these experiments.

    Args:
        machine: with its true constants.
        runs: its experiments.
        hidden: the effects that it has beyond its model.

    Returns:
        The hidden effect of each such twin, by the twin's name.
    """
    found = {}
    for place, own in enumerate(hidden):
        other, ratio = ALIKE.get(own.name, ("", 0.0))
        if other and other not in (sized.name for sized in hidden):
            twin = replace(own, name=other, hidden=PLANT[other], size=ratio * own.size)
            instead = [*hidden[:place], twin, *hidden[place + 1 :]]
            yard = Yardstick(machine, runs, hidden)
            with_own, with_twin = (
                yard.difference(machine, [sized.settings(machine) for sized in every]) for every in (hidden, instead)
            )
            rounded = [yard.signature(twin)] if twin.hidden.part == "delay" else []  # on the rig, of whole steps
            if yard.left(with_twin - with_own, rounded) < SAME:
                found[other] = own.name
    return found
