"""Contents of one picture, and the beam's shape from the plant's state."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flexarm_env.plant.assembly import assemble
from flexarm_env.plant.beam import Beam, Matrix
from flexarm_env.plant.structure import Structure


@dataclass(frozen=True, eq=False)
class Scene:
    """One moment of an arm.

    Attributes:
        time: [s].
        hub_angle: true angle of the hub, counter-clockwise seen from above [rad].
        stuck: whether the hub sticks.
        stations: (k,) positions along the beam, from the hub to the tip [m].
        deflection: (k,) true deflection at the stations, from the hub's line [m].
        target: commanded angle of the tip [rad], or None.
        command: share of the limit, −1 to 1.
        trace: times (n,) [s] and readings (n,) of the base strain [V] over the last seconds; both may be empty.
        title: one line.
    """

    time: float
    hub_angle: float
    stuck: bool
    stations: Matrix
    deflection: Matrix
    target: float | None
    command: float
    trace: tuple[Matrix, Matrix]
    title: str


def beam_shape(structure: Structure, stations: Matrix) -> Matrix:
    """Build the matrix of the beam's deflection from the hub's line: shape @ plant.physical() [m].

    Args:
        structure: the arm's linear quantities.
        stations: (k,) positions along the beam [m].

    Returns:
        (k, states); zeros for a rigid arm.
    """
    model = assemble(structure)
    coordinates = len(model.names)
    shape = np.zeros((len(stations), 2 * coordinates + len(model.extra)))
    if structure.elements == 0:
        return shape
    beam = Beam(structure.elements, structure.length, structure.mass_per_length, structure.bending_stiffness)
    rows = beam.deflection_rows(stations, absolute=False)
    shape[:, coordinates - 2 * structure.elements : coordinates] = rows[:, 2:]
    if "root" in model.names:
        shape[:, model.names.index("root")] = rows[:, 1]
    return shape
