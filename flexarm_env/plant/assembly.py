"""The matrices of an arm, assembled from beam, bodies, drive and sensors."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from flexarm_env.plant.beam import Beam, Matrix, spread_out, turned
from flexarm_env.plant.drive import drive_model, motor_current
from flexarm_env.plant.outputs import add_sensors
from flexarm_env.plant.reading import Coordinates
from flexarm_env.plant.reduction import reduce_beam
from flexarm_env.plant.structure import Key, LinearModel, Structure, exceeds, is_stacked, structure_of


def assemble(structure: Structure) -> LinearModel:
    """Build the matrices of an arm, or of many (thesis eqs. 3.9 to 3.14, consistent: see the errata).

    Args:
        structure: the arm's linear quantities; those of many arms are `stacked`.

    Returns:
        Matrices on the coordinates [hub, (motor), (root), v_1, s_1, …]; the motor's angle is that of the arm side.
        Those of stacked arms are (arms, rows, columns); those of one arm are kept for the next like it, and read-only.
    """
    return _assemble(structure) if is_stacked(structure) else _assemble_one(structure.key)


@lru_cache(maxsize=64)
def _assemble_one(key: Key) -> LinearModel:
    """Build the matrices of one arm, cached: fits try many arms whose laws alone differ."""
    structure = structure_of(key)
    model = _assemble(structure)
    model = reduce_beam(model, structure.vibrations) if structure.vibrations else model
    for quantity in vars(model).values():
        if isinstance(quantity, np.ndarray):
            quantity.flags.writeable = False
    return model


@dataclass(frozen=True)
class Numbering:
    """The coordinates of an arm, and those of its beam among them.

    Attributes:
        names: of all coordinates.
        kept: of the beam's own coordinates, hub first, those that the arm has: the root's slope only if it can turn.
        place: where these stand among all.
    """

    names: list[str]
    kept: list[int]
    place: NDArray[np.int_]

    @classmethod
    def of(cls, s: Structure, beam: Beam | None) -> Numbering:
        """Number the coordinates of an arm."""
        names = ["hub"] + (["motor"] if s.separate_motor else []) + (["fixture"] if s.soft_fixture else [])
        own = [] if beam is None else ([1] if s.soft_root else []) + list(range(2, beam.size))
        names += [] if beam is None else (["root"] if s.soft_root else []) + _node_names(s.elements)
        return cls(names, [0, *own], np.array([0, *range(len(names) - len(own), len(names))], dtype=int))

    def spread(self, rows: Matrix) -> Matrix:
        """Spread rows on the beam's own coordinates over all."""
        wide = np.zeros((*rows.shape[:-1], len(self.names)))
        wide[..., self.place] = rows[..., self.kept]
        if "fixture" in self.names:  # what is measured from the fixed line turns with the fixture, too
            wide[..., self.names.index("fixture")] = rows[..., 0]
        return wide


def _assemble(s: Structure) -> LinearModel:
    beam = Beam(s.elements, s.length, s.mass_per_length, s.bending_stiffness) if s.elements else None
    numbering = Numbering.of(s, beam)
    names, size = numbering.names, len(numbering.names)
    mass, damping, stiffness = (np.zeros((*np.shape(s.hub_inertia), size, size)) for _ in range(3))
    if beam is not None:
        _add_beam(s, beam, numbering, mass, damping, stiffness)
    motor = names.index("motor") if s.separate_motor else 0
    mass[..., 0, 0] += s.hub_inertia + (0.0 if beam is not None else s.payload * s.length**2)
    if s.soft_fixture:
        mass = _on_fixture(s, names, motor, mass, stiffness, damping)
    mass[..., motor, motor] += s.gear_ratio**2 * s.motor_inertia
    share = s.motor_viscous_share if s.separate_motor else 1.0
    damping[..., motor, motor] += s.viscous * share
    damping[..., 0, 0] += s.viscous * (1.0 - share)
    stiffness[..., 0, 0] += s.hub_stiffness
    model = drive_model(s, names, motor, mass, damping, stiffness)
    hub, current = motor if s.has_joint else 0, motor_current(s, size, motor)
    add_sensors(s, model, Coordinates(size, motor, s.gear_ratio, beam, numbering.spread, hub_body=hub, drive=current))
    if beam is not None:
        _add_beam_forces(s, beam, numbering, model)
    elif exceeds(s.link_moment, 0.0):
        _add_link_force(s, names, model)
    return model


def _tip(beam: Beam, numbering: Numbering) -> Matrix:
    """Compute the row of the deflection at the tip."""
    return numbering.spread(beam.deflection_rows(beam.length[..., None], absolute=True))


def _add_beam(s: Structure, beam: Beam, numbering: Numbering, mass: Matrix, damping: Matrix, stiffness: Matrix) -> None:
    """Add a beam with its tip and payload to the matrices."""
    pick = np.ix_(numbering.kept, numbering.kept)
    where = np.ix_(numbering.place, numbering.place)
    mass[..., where[0], where[1]] += beam.mass[..., pick[0], pick[1]]
    stiffness[..., where[0], where[1]] += beam.stiffness[..., pick[0], pick[1]]
    damping[..., where[0], where[1]] += (spread_out(s.beam_damping) * beam.stiffness)[..., pick[0], pick[1]]
    own_tip = _without(_tip(beam, numbering), numbering.names, "fixture")
    mass += spread_out(s.tip_mass + s.payload) * (turned(own_tip) * own_tip)
    turn = np.zeros(len(numbering.names))
    turn[0] = turn[-1] = 1.0
    mass += spread_out(s.tip_inertia) * np.outer(turn, turn)
    if s.soft_root:
        root = numbering.names.index("root")
        stiffness[..., root, root] += 1.0 / s.root_compliance


def _add_beam_forces(s: Structure, beam: Beam, numbering: Numbering, model: LinearModel) -> None:
    """Add the forces of drag and weight on a beam, and the velocities on which drag depends."""
    places, weights = beam.drag_points()
    rows = numbering.spread(beam.deflection_rows(places, absolute=True))
    drag = turned(weights[..., None] * rows)
    tip = _tip(beam, numbering)
    model.tip = numbering.spread(beam.deflection_rows(beam.length[..., None], absolute=False))[..., 0, :]
    own, hung = (np.asarray(mass)[..., None] * tip[..., 0, :] for mass in (s.tip_mass, s.payload))
    own = own + np.asarray(s.mass_per_length)[..., None] * drag.sum(axis=-1)
    model.beam_velocity = np.concatenate([rows, np.zeros_like(rows[..., :1, :])], axis=-2)
    model.beam_force = np.concatenate([drag, ((own + hung) / own[..., :1])[..., None]], axis=-1)


def _add_link_force(s: Structure, names: list[str], model: LinearModel) -> None:
    """Add the payload to the weight of a rigid link."""
    model.beam_force = np.array(model.beam_force)
    model.beam_force[..., 0, 0] += s.payload * s.length / s.link_moment
    if s.soft_fixture:
        model.beam_force[..., names.index("fixture"), 0] = model.beam_force[..., 0, 0]


def _without(rows: Matrix, names: list[str], name: str) -> Matrix:
    """Copy rows on the coordinates with 0 for the named one, if there is such a coordinate."""
    if name not in names:
        return rows
    copy = rows.copy()
    copy[..., names.index(name)] = 0.0
    return copy


def _on_fixture(s: Structure, names: list[str], motor: int, mass: Matrix, stiffness: Matrix, damping: Matrix) -> Matrix:
    """Put the stator on a damped spring; return the mass matrix, without the motor's inertia at its own coordinate.

    Hub and beam turn by their own angle and the fixture's; the rotor by gear ratio times its own and the fixture's.
    """
    fixture = names.index("fixture")
    turn = np.eye(len(names))
    turn[0, fixture] = 1.0
    mass = turn.T @ mass @ turn
    across = s.gear_ratio * s.motor_inertia + s.front_inertia * (1.0 - 1.0 / s.gear_ratio)
    mass[..., fixture, motor] += across
    mass[..., motor, fixture] += across
    own = s.motor_inertia + s.front_inertia * (1.0 - 1.0 / s.gear_ratio**2)
    mass[..., fixture, fixture] += s.fixture_inertia + own
    stiffness[..., fixture, fixture] += 1.0 / s.fixture_compliance
    damping[..., fixture, fixture] += s.fixture_damping_time / s.fixture_compliance
    return mass


def _node_names(elements: int) -> list[str]:
    return [name for node in range(1, elements + 1) for name in (f"deflection_{node}", f"slope_{node}")]
