"""The linear part of an arm as named quantities, and the matrices that follow from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any

import numpy as np

from flexarm_env.errors import InputError
from flexarm_env.plant.beam import Beam, Matrix, spread_out, turned
from flexarm_env.plant.reading import Channel, Coordinates, Current, Reading, time_constant

#: Drivers of the linear part: the command, dry friction and non-linear torque on hub and motor, the constant 1,
#: the side on which the gears touch (−1, 0, 1), and the angles of a held hub and a held motor.
DRIVERS = ("command", "hub_torque", "motor_torque", "one", "gear_side", "held_hub", "held_motor")
COMMAND, HUB_TORQUE, MOTOR_TORQUE, ONE, GEAR_SIDE, HELD_HUB, HELD_MOTOR = range(len(DRIVERS))

#: An arm's quantities; signals and the attributes of their channels.
Key = tuple[tuple[Any, ...], tuple[tuple[Any, ...], ...]]

#: Quantities that arms of one kind have in common.
WHOLE = ("elements", "has_joint", "sensors")
#: Frequency of a motor on touching gears with the hub held [rad/s]: where backlash requires a separate motor but no compliance
#: is given, stiff enough that windup stays below a pot's resolution; and on gears that are as good as rigid.
STIFF_GEARS, RIGID_GEARS = 960.0, 48e3
#: A beam's root that turns by less than this share of the beam's own turn (length over bending stiffness) is rigid: its
#: undamped mode is too fast to be seen, and costs fifty times a replay.
LEAST_ROOT_SHARE = 1e-3


#: A first-order lag below this time constant [s] is none: its response is over within any sample, and its rate leaves no digits.
SHORTEST_LAG = 1e-9


def exceeds(quantity: float | Matrix, limit: float) -> bool:
    """Whether a quantity of an arm, or of every stacked one, lies above a limit."""
    return bool((quantity > limit).all()) if isinstance(quantity, np.ndarray) else quantity > limit


@dataclass
class Structure:
    """Everything linear about an arm, arm side, in SI units. Effects of the structure port edit these quantities."""

    gear_ratio: float
    torque_constant: float
    motor_inertia: float
    hub_inertia: float
    resistance: float = 0.0  # 0: current drive
    motor_viscous_share: float = 0.0
    efficiency: float = 1.0  # of motor and gears
    command_gain: float = 1.0  # of the amplifier
    position_gain: float = 0.0  # of a servo [V/rad]; 0: the command is a current, a voltage or a torque
    rate_gain: float = 0.0  # of a servo [V s/rad]
    largest_voltage: float = 0.0  # 0: no limit
    largest_current: float = 0.0
    supply_voltage: float = 0.0
    supply_resistance: float = 0.0
    has_joint: bool = False  # whether the hub is in front of the gears' spring
    front_inertia: float = 0.0  # of the hub in front of a joint, part of the motor's
    link_moment: float = 0.0  # of a rigid link: mass times distance of its centre
    fixture_compliance: float = 0.0
    fixture_inertia: float = 0.0
    fixture_damping_time: float = 0.0
    elements: int = 0  # 0: a rigid arm
    length: float = 0.0
    mass_per_length: float = 0.0
    bending_stiffness: float = 0.0
    tip_mass: float = 0.0
    payload: float = 0.0  # beside it
    tip_inertia: float = 0.0
    viscous: float = 0.0
    hub_stiffness: float = 0.0
    hub_torque: float = 0.0
    beam_damping: float = 0.0
    root_compliance: float = 0.0
    gear_compliance: float = 0.0
    gear_damping_time: float = 5e-4  # of gears that touch: damping over stiffness
    gear_gap: float = 0.0
    current_lag: float = 0.0
    input_delay: float = 0.0
    sensors: dict[str, Channel] = field(default_factory=dict)

    @property
    def key(self) -> Key:
        """All quantities and sensors of one arm, to look up what was computed from them."""
        *quantities, sensors = vars(self).values()
        return tuple(quantities), tuple([(signal, *vars(channel).values()) for signal, channel in sensors.items()])

    @property
    def separate_motor(self) -> bool:
        """Whether motor and hub are two bodies."""
        return self.soft_gears or exceeds(self.gear_gap, 0.0)

    @property
    def soft_gears(self) -> bool:
        """Whether the gears wind up."""
        return exceeds(self.gear_compliance * self._motor_side, 1.0 / RIGID_GEARS**2)

    @property
    def _motor_side(self) -> float:
        """Inertia of the motor, arm side [kg m²]."""
        return self.gear_ratio**2 * self.motor_inertia

    @property
    def soft_root(self) -> bool:
        """Whether the beam's root can turn against the hub."""
        return exceeds(self.root_compliance * self.bending_stiffness, LEAST_ROOT_SHARE * self.length)

    @property
    def soft_fixture(self) -> bool:
        """Whether the machine stands on a spring that can be seen."""
        return exceeds(self.fixture_compliance * self.fixture_inertia, 1.0 / RIGID_GEARS**2)

    @property
    def gear_stiffness(self) -> float:
        """Stiffness of the touching gears, arm side [Nm/rad]."""
        return 1.0 / self.gear_compliance if self.soft_gears else STIFF_GEARS**2 * self._motor_side

    @property
    def amps_by_command(self) -> float:
        """Motor current per command at rest [A/A or A/V]."""
        return 1.0 / self.resistance if exceeds(self.resistance, 0.0) else 1.0

    @property
    def torque_by_amp(self) -> float:
        """Drive torque per motor current, arm side [Nm/A]."""
        return self.efficiency * self.gear_ratio * self.torque_constant

    @property
    def back_emf(self) -> float:
        """Voltage per speed of the motor's body, arm side [V s/rad]."""
        return self.gear_ratio * self.torque_constant

    @property
    def is_servo(self) -> bool:
        """Whether the command is the goal of a position loop."""
        return exceeds(self.position_gain, 0.0)

    @property
    def has_limits(self) -> bool:
        """Whether voltage or current of the drive depend on the motion otherwise than in proportion."""
        limits = (self.largest_voltage, self.largest_current) if self.is_servo else ()
        return any(exceeds(limit, 0.0) for limit in (*limits, self.supply_resistance))

    @property
    def torque_by_command(self) -> float:
        """Drive torque per command at rest, arm side [Nm/A, Nm/V or, of a servo's position error, Nm/rad]."""
        return self.torque_by_amp * self.amps_by_command * self.command_gain * (self.position_gain if self.is_servo else 1.0)


def stacked(structures: Sequence[Structure]) -> Structure:
    """Stack arms of one kind, which differ in their numbers only, into one structure of (arms,) quantities."""
    first, every = structures[0], [vars(structure) for structure in structures]
    values: dict[str, Any] = {name: np.array([each[name] for each in every]) for name in every[0] if name not in WHOLE}
    for signal in first.sensors:
        channels = [structure.sensors[signal] for structure in structures]
        rows = np.array([(c.gain, c.offset, c.filter, c.position) for c in channels])
        values.setdefault("sensors", {})[signal] = Channel(channels[0].reading, channels[0].strain, *rows.T)
    return Structure(elements=first.elements, has_joint=first.has_joint, **values)


@dataclass
class LinearModel:
    """M q̈ + B q̇ + K q = Q w + R e, ė = A e + F [q, q̇] + S w, y = Y [q, q̇, e] + D w."""

    names: list[str]
    mass: Matrix
    damping: Matrix
    stiffness: Matrix
    input: Matrix
    from_extra: Matrix
    extra: Matrix
    extra_from_motion: Matrix
    extra_from_input: Matrix
    output: Matrix
    output_from_input: Matrix
    beam_force: Matrix  # (coordinates, drag points + 1): by drag at each point, by a weight of 1 Nm about the hub without payload
    beam_velocity: Matrix  # (drag points + 1, coordinates): of each point; the last row is empty
    signals: list[str]
    settled: Matrix  # (extra, 2 coordinates): filters of accelerations from [q, q̇], of an arm long at constant speed


def structure_of(key: Key) -> Structure:
    """Build the structure of a key anew."""
    quantities, sensors = key
    values: tuple[Any, ...] = (*quantities, {signal: Channel(*channel) for signal, *channel in sensors})
    return Structure(*values)


def is_stacked(structure: Structure) -> bool:
    """Whether a structure holds many arms."""
    return np.ndim(structure.hub_inertia) > 0


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
    model = _assemble(structure_of(key))
    for quantity in vars(model).values():
        if isinstance(quantity, np.ndarray):
            quantity.flags.writeable = False
    return model


def _assemble(s: Structure) -> LinearModel:
    names = ["hub"] + (["motor"] if s.separate_motor else []) + (["fixture"] if s.soft_fixture else [])
    beam = Beam(s.elements, s.length, s.mass_per_length, s.bending_stiffness) if s.elements else None
    # a beam coordinate stands where its own numbering puts it, the root's slope only if it can turn
    kept = [] if beam is None else ([1] if s.soft_root else []) + list(range(2, beam.size))
    names += [] if beam is None else (["root"] if s.soft_root else []) + _node_names(s.elements)
    place = np.array([0, *range(len(names) - len(kept), len(names))], dtype=int)
    size = len(names)
    mass, damping, stiffness = (np.zeros((*np.shape(s.hub_inertia), size, size)) for _ in range(3))

    def spread(rows: Matrix) -> Matrix:
        wide = np.zeros((*rows.shape[:-1], size))
        wide[..., place] = rows[..., [0, *kept]]
        if s.soft_fixture:  # what is measured from the fixed line turns with the fixture, too
            wide[..., names.index("fixture")] = rows[..., 0]
        return wide

    if beam is not None:
        pick = np.ix_([0, *kept], [0, *kept])
        where = np.ix_(place, place)
        mass[..., where[0], where[1]] += beam.mass[..., pick[0], pick[1]]
        stiffness[..., where[0], where[1]] += beam.stiffness[..., pick[0], pick[1]]
        damping[..., where[0], where[1]] += (spread_out(s.beam_damping) * beam.stiffness)[..., pick[0], pick[1]]
        tip = spread(beam.deflection_rows(beam.length[..., None], absolute=True))
        own_tip = _without(tip, names, "fixture")
        mass += spread_out(s.tip_mass + s.payload) * (turned(own_tip) * own_tip)
        turn = np.zeros(size)
        turn[0] = turn[-1] = 1.0
        mass += spread_out(s.tip_inertia) * np.outer(turn, turn)
        if s.soft_root:
            root = names.index("root")
            stiffness[..., root, root] += 1.0 / s.root_compliance
    motor = names.index("motor") if s.separate_motor else 0
    mass[..., 0, 0] += s.hub_inertia + (0.0 if beam is not None else s.payload * s.length**2)
    if s.soft_fixture:
        mass = _on_fixture(s, names, motor, mass, stiffness, damping)
    mass[..., motor, motor] += s.gear_ratio**2 * s.motor_inertia
    share = s.motor_viscous_share if s.separate_motor else 1.0
    damping[..., motor, motor] += s.viscous * share
    damping[..., 0, 0] += s.viscous * (1.0 - share)
    stiffness[..., 0, 0] += s.hub_stiffness
    model = _drive(s, names, motor, mass, damping, stiffness)
    hub = motor if s.has_joint else 0
    _sensors(s, model, Coordinates(size, motor, s.gear_ratio, beam, spread, hub_body=hub, drive=_current(s, size, motor)))
    if beam is None and exceeds(s.link_moment, 0.0):
        model.beam_force = np.array(model.beam_force)
        model.beam_force[..., 0, 0] += s.payload * s.length / s.link_moment
        if s.soft_fixture:
            model.beam_force[..., names.index("fixture"), 0] = model.beam_force[..., 0, 0]
    if beam is not None:
        places, weights = beam.drag_points()
        rows = spread(beam.deflection_rows(places, absolute=True))
        drag = turned(weights[..., None] * rows)
        own, hung = (np.asarray(mass)[..., None] * tip[..., 0, :] for mass in (s.tip_mass, s.payload))
        own = own + np.asarray(s.mass_per_length)[..., None] * drag.sum(axis=-1)
        model.beam_velocity = np.concatenate([rows, np.zeros_like(rows[..., :1, :])], axis=-2)
        model.beam_force = np.concatenate([drag, ((own + hung) / own[..., :1])[..., None]], axis=-1)
    return model


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


def _drive(s: Structure, names: list[str], motor: int, mass: Matrix, damping: Matrix, stiffness: Matrix) -> LinearModel:
    size, arms = len(names), mass.shape[:-2]
    drivers = np.zeros((*arms, size, len(DRIVERS)))
    drivers[..., 0, HUB_TORQUE] = 1.0
    drivers[..., motor, MOTOR_TORQUE] = 1.0 if s.separate_motor else 0.0
    drivers[..., 0, ONE] = s.hub_torque
    torque_per_amp = s.torque_by_amp
    amps_per_command, amps_per_angle, amps_per_speed = _amps(s)
    lagged = exceeds(s.current_lag, SHORTEST_LAG)
    extra = int(lagged)
    model = LinearModel(
        names=names,
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        input=drivers,
        from_extra=np.zeros((*arms, size, extra)),
        extra=np.zeros((*arms, extra, extra)),
        extra_from_motion=np.zeros((*arms, extra, 2 * size)),
        extra_from_input=np.zeros((*arms, extra, len(DRIVERS))),
        output=np.zeros((*arms, 0, 0)),
        output_from_input=np.zeros((*arms, 0, len(DRIVERS))),
        beam_force=np.broadcast_to(np.eye(size, 1), (*arms, size, 1)),
        beam_velocity=np.zeros((*arms, 1, size)),
        signals=[],
        settled=np.zeros((*arms, extra, 2 * size)),
    )
    if lagged:
        model.from_extra[..., motor, 0] = torque_per_amp
        model.extra[..., 0, 0] = -1.0 / s.current_lag
        model.extra_from_input[..., 0, COMMAND] = amps_per_command / s.current_lag
        model.extra_from_motion[..., 0, motor] = amps_per_angle / s.current_lag
        model.extra_from_motion[..., 0, size + motor] = amps_per_speed / s.current_lag
    else:
        drivers[..., motor, COMMAND] = torque_per_amp * amps_per_command
        stiffness[..., motor, motor] -= torque_per_amp * amps_per_angle
        damping[..., motor, motor] -= torque_per_amp * amps_per_speed
    return model


def _amps(s: Structure) -> tuple[Any, Any, Any]:
    """Compute the motor current by command, and by angle and speed of the motor's body [A per unit], without limits and lag."""
    per_command = s.amps_by_command * s.command_gain
    per_speed = -s.back_emf / s.resistance if exceeds(s.resistance, 0.0) else 0.0
    if not s.is_servo:
        return per_command, 0.0, per_speed
    return per_command * s.position_gain, -per_command * s.position_gain, per_speed - per_command * s.rate_gain


def _current(s: Structure, size: int, motor: int) -> Current | None:
    """Express the motor's current; None where limits make it another function of the motion."""
    if s.has_limits:
        return None
    rows = np.zeros((2, *np.shape(s.hub_inertia), size))
    if exceeds(s.current_lag, SHORTEST_LAG):
        return Current(0.0, rows[0], rows[1], lagged=1.0)
    per_command, rows[0, ..., motor], rows[1, ..., motor] = _amps(s) if exceeds(s.efficiency, 0.0) else (0.0, 0.0, 0.0)
    return Current(per_command, rows[0], rows[1])


def _sensors(s: Structure, model: LinearModel, coordinates: Coordinates) -> None:
    size, arms = len(model.names), model.mass.shape[:-2]
    readings = [_reading(signal, channel, coordinates) for signal, channel in s.sensors.items()]
    filters = [time_constant(reading, channel) for reading, channel in zip(readings, s.sensors.values(), strict=True)]
    filtered = [i for i, filter in enumerate(filters) if exceeds(filter, SHORTEST_LAG)]
    before = model.extra.shape[-1]
    total = before + len(filtered)
    model.extra = _grown(model.extra, total, total)
    model.from_extra = _grown(model.from_extra, size, total)
    model.extra_from_motion = _grown(model.extra_from_motion, total, 2 * size)
    model.extra_from_input = _grown(model.extra_from_input, total, len(DRIVERS))
    model.settled = _grown(model.settled, total, 2 * size)
    model.output = np.zeros((*arms, len(s.sensors), 2 * size + total))
    model.output_from_input = np.zeros((*arms, len(s.sensors), len(DRIVERS)))
    model.signals = list(s.sensors)
    for i, (reading, channel) in enumerate(zip(readings, s.sensors.values(), strict=True)):
        row = np.zeros((*arms, 2 * size))
        if reading.position is not None:
            row[..., :size] = reading.position
        if reading.speed is not None:
            row[..., size:] = reading.speed
        if reading.current is not None:
            row[..., :size] += reading.current.position
            row[..., size:] += reading.current.speed
        # a filter behind a reading that jumps stores it without gain, so that the gain moves no rounding error of the motion
        inner, outer = (1.0, channel.gain) if reading.jumps else (channel.gain, 1.0)
        row *= np.asarray(inner)[..., None]
        model.output_from_input[..., i, ONE] = channel.offset
        if i not in filtered:
            model.output[..., i, : 2 * size] = row
            continue
        place = before + filtered.index(i)
        if reading.acceleration is not None:
            # A filtered acceleration is linear in the state: the speed less the filtered speed, over the time constant.
            rate = reading.acceleration * np.asarray(1.0 / filters[i])[..., None]
            row[..., size:] -= rate
            model.output[..., i, size : 2 * size] = rate * np.asarray(outer)[..., None]
            model.settled[..., place, :] = row
        if reading.current is not None:
            model.settled[..., place, :] = row
            model.extra_from_input[..., place, COMMAND] = reading.current.command / filters[i]
            if reading.current.lagged:
                model.extra[..., place, 0] = 1.0 / filters[i]
        model.extra[..., place, place] = -1.0 / filters[i]
        model.extra_from_motion[..., place, :] = row / np.asarray(filters[i])[..., None]
        model.output[..., i, 2 * size + place] = outer


def _reading(signal: str, channel: Channel, coordinates: Coordinates) -> Reading:
    try:
        return channel.reading(replace(coordinates, position=channel.position))
    except InputError as error:
        raise InputError(f"sensors.{signal} {error}") from None


def _grown(matrix: Matrix, rows: int, columns: int) -> Matrix:
    """Pad matrices with zeros below and to the right."""
    grown = np.zeros((*matrix.shape[:-2], rows, columns))
    grown[..., : matrix.shape[-2], : matrix.shape[-1]] = matrix
    return grown
