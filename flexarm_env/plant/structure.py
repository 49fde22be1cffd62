"""The linear part of an arm as named quantities, and its matrices, which follow from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from flexarm_env.plant.beam import Matrix
from flexarm_env.plant.reading import Channel

#: Drivers of the linear part: the command, dry friction and non-linear torque on hub and motor, the constant 1,
#: the side on which the gears touch (−1, 0, 1), and the angles of a held hub and a held motor.
DRIVERS = ("command", "hub_torque", "motor_torque", "one", "gear_side", "held_hub", "held_motor")
COMMAND, HUB_TORQUE, MOTOR_TORQUE, ONE, GEAR_SIDE, HELD_HUB, HELD_MOTOR = range(len(DRIVERS))

#: An arm's quantities; signals and the attributes of their channels.
Key = tuple[tuple[Any, ...], tuple[tuple[Any, ...], ...]]

#: Quantities that arms of one kind have in common.
WHOLE = ("elements", "vibrations", "has_joint", "sensors")
#: Frequency of a motor on touching gears with the hub held [rad/s]: where backlash requires a separate motor but no compliance
#: is given, stiff enough that windup stays below a pot's resolution; and on gears that are as good as rigid.
STIFF_GEARS, RIGID_GEARS = 960.0, 48e3
#: A beam's root that turns by less than this share of the beam's own turn (length over bending stiffness) is rigid: its
#: undamped mode is too fast to be seen, and costs fifty times a replay.
LEAST_ROOT_SHARE = 1e-3


#: A first-order lag below this time constant [s] is none: its response is over within any sample, and its rate leaves no digits.
SHORTEST_LAG = 1e-9


def exceeds(quantity: float | Matrix, limit: float) -> bool:
    """Whether a quantity of an arm, or of every stacked one, lies above a limit.

    Raises:
        ValueError: for stacked arms of which some lie above it: they are not of one kind.
    """
    if not isinstance(quantity, np.ndarray):
        return quantity > limit
    above = quantity > limit
    if above.any() != above.all():
        raise ValueError("stacked arms are of different kinds: build a plant of their own")
    return bool(above.all())


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
    vibrations: int = 0  # of the beam that are kept; 0: all that its elements have
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
    return Structure(elements=first.elements, vibrations=first.vibrations, has_joint=first.has_joint, **values)


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
    tip: Matrix  # (coordinates,): deflection of the tip from the hub's line


def arm_of(model: LinearModel, arm: int) -> LinearModel:
    """Take the matrices of one arm out of those of stacked ones."""
    arms = model.mass.ndim - 2
    own = {name: value[arm] if isinstance(value, np.ndarray) and arms else value for name, value in vars(model).items()}
    return LinearModel(**own)


def structure_of(key: Key) -> Structure:
    """Build the structure of a key anew."""
    quantities, sensors = key
    values: tuple[Any, ...] = (*quantities, {signal: Channel(*channel) for signal, *channel in sensors})
    return Structure(*values)


def is_stacked(structure: Structure) -> bool:
    """Whether a structure holds many arms."""
    return np.ndim(structure.hub_inertia) > 0
