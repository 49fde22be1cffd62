"""The base of a sensor: a signal with its name and unit, and the quantity of the arm that it measures."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import replace
from typing import ClassVar

from flexarm_env.arm_sections import SENSOR
from flexarm_env.parameters import Parameter
from flexarm_env.plant.reading import Channel, Coordinates, Reading

#: Defaults over the typical reading: end of the range, typical offset, largest offset.
RANGE, OFFSET, LARGEST_OFFSET = 10.0, 0.02, 500.0


class Sensor:
    """A signal that an arm may measure. A subclass in a file of its own in this folder is all that a new signal takes.

    The class states the attributes below and one method. ``reading(coordinates)`` returns a `flexarm_env.sensors.Reading`,
    made of rows of `flexarm_env.sensors.Coordinates`: ``hub``, ``motor``, ``deflection(x)``, ``displacement(x)`` and
    ``moment(x)``, x in m from the hub's axis. ``length`` is the x of the tip, ``position`` that of the sensor in the arm file. A
    row may be scaled and added to others. It stands for the quantity itself in ``Reading(position=row)``, for its rate in
    ``Reading(speed=row)``, for its acceleration in ``Reading(acceleration=row)``. A row of the beam refuses a rigid arm.

    An acceleration jumps with the command and the friction. Such a reading therefore passes a first-order filter, as that of
    every accelerometer does: the ``filter`` of the sensor's table, 0.1 ms at least. It is exact, stuck, sliding and in between.

    From the file follow the column in recordings and its unit, `simulate`, the residuals and the fit of the gain, the
    observation of the environments, labels of tables and pictures, and the parameter of the effect `sensor_offset`. The arm
    file names it as ``[sensors.tip_acceleration]``.

    Attributes:
        name: as in arm files and heads of recordings.
        unit: SI unit of the signal, as pint writes it.
        label: for tables and pictures.
        measures: the same within a sentence; "the " and the label by default.
        typical: usual size of the signal, in its unit; normalised observations are divided by it.
        largest: end of the range; 10 times the typical size by default.
        typical_offset: usual constant error; a fiftieth of the typical size by default.
        largest_offset: bound of a constant error; 500 times the typical size by default.
        usual_range: range of the signal in recordings of the thesis's arm. Typical sizes of effects in this unit are scaled by
            that of the recordings over it; None leaves them.
        gain_unit: of the gain; "" for a signal in the unit of the quantity.
        gain_spread: relative standard deviation that a fit assumes of the gain; 0 keeps the gain.
        defaults: of keys of the sensor's table in an arm file: {"filter": 0.001}, {"noise": 0.01}.
        needs: required of the arm: "beam", "motor_inertia", "hub_inertia" (or a beam), or its input, "current" or "voltage".
        strain: whether it is a strain gage, on which the effects of gages act.
        motor_side: whether the signal grows with the gear ratio.
        order: place among the signals.

    Example:
        >>> from typing import ClassVar
        >>> from flexarm_env.sensors import Reading, Sensor
        >>> class TipAcceleration(Sensor):
        ...     '''Accelerometer at the beam's tip, across the beam.'''
        ...
        ...     name = "tip_acceleration"
        ...     unit = "m/s**2"
        ...     label = "tip acceleration"
        ...     typical = 10.0
        ...     largest = 160.0
        ...     needs = ("beam",)
        ...     defaults: ClassVar = {"filter": 0.001, "noise": 0.05}
        ...
        ...     @staticmethod
        ...     def reading(coordinates):
        ...         return Reading(acceleration=coordinates.displacement(coordinates.length))
        >>> TipAcceleration.settings()["offset"].unit, TipAcceleration.offset_parameter().typical
        ('m/s**2', 0.2)
    """

    name: ClassVar[str]
    unit: ClassVar[str]
    label: ClassVar[str]
    measures: ClassVar[str] = ""
    typical: ClassVar[float] = 1.0
    largest: ClassVar[float | None] = None
    typical_offset: ClassVar[float | None] = None
    largest_offset: ClassVar[float | None] = None
    usual_range: ClassVar[float | None] = None
    gain_unit: ClassVar[str] = ""
    gain_spread: ClassVar[float] = 0.15
    defaults: ClassVar[Mapping[str, float]] = {}
    needs: ClassVar[tuple[str, ...]] = ()
    strain: ClassVar[bool] = False
    motor_side: ClassVar[bool] = False
    order: ClassVar[float] = 100.0

    @staticmethod
    def reading(coordinates: Coordinates) -> Reading:
        """Express the quantity that is measured, in SI units, of an arm or of stacked ones."""
        raise NotImplementedError

    @classmethod
    def channel(cls, gain: float = 1.0, offset: float = 0.0, filter: float = 0.0, position: float = 0.0) -> Channel:
        """Build the sensor's channel in a plant, with its settings in SI units."""
        return Channel(cls.reading, cls.strain, gain, offset, filter, position)

    @classmethod
    @functools.cache
    def settings(cls) -> Mapping[str, Parameter]:
        """Describe the keys of the sensor's table in an arm file, with this signal's units and defaults."""
        units = {"gain": cls.gain_unit, "per_volt": f"{cls.unit}/V", **dict.fromkeys(("offset", "noise", "resolution"), cls.unit)}
        spreads = {"gain": cls.gain_spread}
        return {
            key: replace(
                p, unit=units.get(key, p.unit), typical=cls.defaults.get(key, p.typical), spread=spreads.get(key, p.spread)
            )
            for key, p in SENSOR.items()
        }

    @classmethod
    def offset_parameter(cls) -> Parameter:
        """Describe the parameter of the effect `sensor_offset` for this signal."""
        typical = OFFSET * cls.typical if cls.typical_offset is None else cls.typical_offset
        largest = LARGEST_OFFSET * cls.typical if cls.largest_offset is None else cls.largest_offset
        return Parameter(
            cls.unit, -largest, largest, typical, null=0.0, meaning=f"offset of {cls.measures or f'the {cls.label}'}"
        )

    @classmethod
    def range_end(cls) -> float:
        """Estimate the largest reading, for the thesis's arm, in the signal's unit."""
        return RANGE * cls.typical if cls.largest is None else cls.largest


class StrainGage(Sensor):
    """A strain gage; its voltage is its gain times the bending moment at its position (thesis section 3.3)."""

    unit = "V"
    typical = 2.0
    largest = 10.0
    typical_offset = 0.05
    largest_offset = 1e3
    usual_range = 9.0
    gain_unit = "V/N/m"
    needs = ("beam",)
    strain = True

    @staticmethod
    def reading(coordinates: Coordinates) -> Reading:
        """Bending moment [Nm] at the gage."""
        return Reading(position=coordinates.moment(coordinates.position))
