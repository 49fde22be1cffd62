"""The arm: base constants, sensors and effects."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flexarm_env.arm_file import arm_from_table, read_arm
from flexarm_env.arm_sections import SECTIONS
from flexarm_env.arm_text import write_arm
from flexarm_env.control.law import ControlLaw
from flexarm_env.display import Shown
from flexarm_env.effects import Catalogue, Effect, catalogue
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.parameters import INPUTS, NEEDS, Parameter, read_value, reading_noise
from flexarm_env.sensors import Sensor, known_sensors

if TYPE_CHECKING:
    from flexarm_env.linear import LinearArm
    from flexarm_env.plant.active_laws import ActiveLaw
    from flexarm_env.plant.plant import Plant
    from flexarm_env.plant.structure import Structure

Values = Mapping[str, float]


@dataclass(frozen=True)
class Arm(Shown):
    """Model of a flexible or rigid arm: base constants, sensors and effects, in SI units. Immutable.

    A value has a path: "beam.length", "sensors.arm_angle.gain", "effects.coulomb.torque".

    Attributes:
        name: title in tables and pictures.
        input: kind of the command, "current", "voltage", "torque" or "position".
        constants: base constants by section and key, {"drive": {"gear_ratio": 1.5, …}, …}; without "beam" the arm is rigid, with
            "joint" a spring lies between hub and link.
        sensors: settings of each measured signal.
        effects: parameters of each effect.
        fixed: paths of constants that a fit keeps.
        auto_noise: signals whose noise is estimated from the recordings, `noise = "auto"` in the file. Their noise is 0 here.
        columns: the map of columns of foreign recordings, or None.
        conditions: by the name of a recording's condition, the path of the constant whose place its value takes.
        controller: the law under which recordings with a reference were made, or None.
        fitted: value, low and high end of the 90 % interval and unit of each fitted path.
        origin: recordings, command and seed of the fit.
        description: one line about the arm.
        known: catalogue of effects.

    Example:
        >>> from flexarm_env import Arm
        >>> arm = Arm.load("thesis").with_effect("backlash", gap=0.06)
        >>> arm
        Arm('thesis', current drive, effects: viscous, coulomb, stiction, backlash)
        >>> arm.value("beam.length"), arm.parameter("beam.length").unit
        (1.0, 'm')
    """

    name: str
    input: str
    constants: Mapping[str, Values]
    sensors: Mapping[str, Values]
    effects: Mapping[str, Values] = field(default_factory=dict)
    fixed: Sequence[str] = ()
    auto_noise: Sequence[str] = ()
    columns: Mapping[str, Any] | None = None
    conditions: Mapping[str, str] = field(default_factory=dict)
    controller: ControlLaw | None = None
    fitted: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    origin: Mapping[str, Any] = field(default_factory=dict)
    description: str = ""
    known: Catalogue = field(default_factory=catalogue, repr=False, compare=False)

    def __repr__(self) -> str:
        return f"Arm({self.name!r}, {self.input} drive, effects: {', '.join(self.effects) or 'none'})"

    @classmethod
    def load(cls, source: str | Path = "thesis", known: Catalogue | None = None) -> Arm:
        """Read an arm file, or a shipped arm by its name.

        Args:
            source: path of a TOML file, or "thesis", "thesis-fem", or that of a real rig, such as "emps"; `shipped_arms`
                lists them.
            known: catalogue of effects; the shipped and installed ones by default.

        Raises:
            InputError: for a missing or faulty file, with the table and key at fault.

        Example:
            >>> Arm.load("cu-rigid").signals
            ['arm_angle', 'motor_speed']
        """
        return read_arm(cls, source, known or catalogue())

    @classmethod
    def from_table(cls, table: Mapping[str, Any], name: str, known: Catalogue | None = None) -> Arm:
        """Build an arm from the tables of an arm file.

        Args:
            table: the parsed file.
            name: of the arm, where the file states none.
            known: catalogue of effects; the shipped and installed ones by default.

        Raises:
            InputError: for an unknown, missing or impossible entry.
        """
        return arm_from_table(cls, table, name, known or catalogue())

    def save(self, path: str | Path) -> None:
        """Write the arm to a TOML file, completely or not at all. `load` reads back every value bit for bit.

        Args:
            path: of the file; an existing one is replaced.

        Raises:
            InputError: if the file cannot be written.

        Example:
            >>> import tempfile
            >>> arm = Arm.load("thesis").with_effect("cogging")
            >>> with tempfile.TemporaryDirectory() as folder:
            ...     arm.save(f"{folder}/cogging.toml")
            ...     Arm.load(f"{folder}/cogging.toml") == arm
            True
        """
        write_arm(self, Path(path))

    def with_effect(self, name: str, **parameters: float | str) -> Arm:
        """Add an effect, or change its parameters.

        Args:
            name: of the effect, as `flexarm effects` lists it.
            **parameters: values in SI units, or texts with a unit. Others keep their value in the arm, or take their typical one.

        Returns:
            Another arm; this one is unchanged.

        Raises:
            InputError: for an unknown effect or parameter, a value out of bounds, or a part that the arm lacks.

        Example:
            >>> Arm.load("thesis").with_effect("backlash", gap=0.06).effects["backlash"]
            {'gap': 0.06}
        """
        effect = self.known[name]
        values = {key: p.typical for key, p in effect.parameters.items()} | dict(self.effects.get(name, {}))
        for key, value in parameters.items():
            if key not in effect.parameters:
                raise InputError(f"effect '{name}' has no parameter '{key}'{did_you_mean(key, effect.parameters)}")
            values[key] = read_value(f"effects.{name}.{key}", value, effect.parameters[key], self.input)
        self._check_needs(effect)
        return replace(self, effects={**self.effects, name: values})

    def _check_needs(self, effect: type[Effect]) -> None:
        words = NEEDS | {"strain": "a strain gage"}
        missing = [words.get(need, need) for need in effect.needs if not self.has(need)]
        if missing:
            raise InputError(f"effect '{effect.name}' needs {' and '.join(missing)}, which arm '{self.name}' does not have")

    def has(self, need: str) -> bool:
        """Whether the arm has a part, a sensor or an input.

        Args:
            need: "beam", "tip" (of a beam, or of a link with a length), "soft_gears" (a joint, or gears whose stiffness is
                stated), "windup" (shown by the motor's speed, or by a servo, which closes its loop around the motor), "motor"
                (with constants of its own: any drive but torque), "amplifier" (any drive but a servo), "motor_inertia",
                "hub_inertia" (or a beam or link), "supply" (a voltage that is stated, without a sensor of the current, which is
                not modelled behind a supply that sags), the name of a signal, "strain" for any strain gage, or the drive's input.

        Example:
            >>> Arm.load("cu-rigid").has("beam"), Arm.load("thesis").has("strain")
            (False, True)
        """
        if need == "motor_inertia":
            return self.constants["drive"]["motor_inertia"] > 0.0
        if need == "hub_inertia":
            return self.constants["hub"]["inertia"] > 0.0 or "beam" in self.constants or "link" in self.constants
        if need == "tip":
            return "beam" in self.constants or self.constants.get("link", {}).get("length", 0.0) > 0.0
        if need == "soft_gears":
            return "joint" in self.constants or self.constants["drive"]["gear_stiffness"] > 0.0
        if need == "windup":
            return self.input == "position" or "motor_speed" in self.sensors
        if need == "motor":
            return self.input != "torque"
        if need == "amplifier":
            return self.input != "position"
        if need == "supply":
            may_sag = "drive.supply_voltage" not in self.fixed  # a voltage that was measured has sagged already
            return self.constants["drive"]["supply_voltage"] > 0.0 and may_sag and "motor_current" not in self.sensors
        if need in INPUTS:
            return need == self.input
        if need == "strain":
            return any(self.sensor(signal).strain for signal in self.sensors)
        return need in self.constants if need == "beam" else need in self.sensors

    def can_have(self, name: str) -> bool:
        """Whether the arm has all parts, sensors and the input that an effect needs.

        Example:
            >>> Arm.load("cu-rigid").can_have("payload")
            False
        """
        return all(self.has(need) for need in self.known[name].needs)

    def without_effect(self, name: str) -> Arm:
        """Remove an effect; without it, return an equal arm.

        Example:
            >>> list(Arm.load("thesis").without_effect("coulomb").effects)
            ['viscous', 'stiction']
        """
        return replace(self, effects={key: value for key, value in self.effects.items() if key != name})

    def parameter(self, path: str) -> Parameter:
        """Look up unit, bounds, typical size and prior of a value.

        Args:
            path: "beam.length", "sensors.arm_angle.gain" or "effects.coulomb.torque".

        Example:
            >>> Arm.load("thesis").parameter("sensors.strain_base.gain").unit
            'V/N/m'
        """
        section, *rest = path.split(".")
        if section == "effects":
            return self.known[rest[0]].parameters[rest[1]]
        if section == "sensors":
            return self.sensor(rest[0]).settings()[rest[1]]
        found = SECTIONS[section][rest[0]]
        return replace(found, spread=0.0) if self._is_settled(path) else found

    def _is_settled(self, path: str) -> bool:
        """Whether a base constant is no property of this arm that a fit could move.

        So are the 1 in the place of a torque drive's constant, the shares of friction in front of a joint, where the hub is as
        well, and a mass that no gravity acts on.
        """
        return (
            (path == "drive.torque_constant" and self.input == "torque")
            or (path.endswith("_share") and "joint" in self.constants)
            or (path == "link.mass" and self.constants["link"]["tilt"] == 0.0)
        )

    def value(self, path: str) -> float:
        """Look up a value in SI units.

        Args:
            path: "beam.length", "sensors.arm_angle.gain" or "effects.coulomb.torque".

        Example:
            >>> Arm.load("thesis").value("effects.coulomb.torque")
            0.282

        Raises:
            InputError: for a path of no value of this arm.
        """
        section, *rest = path.split(".")
        try:
            if section in ("effects", "sensors"):
                name, key = rest
                return (self.effects if section == "effects" else self.sensors)[name][key]
            (key,) = rest
            return self.constants[section][key]
        except (KeyError, ValueError):
            raise self._no_value(path) from None

    def _no_value(self, path: str) -> InputError:
        tables = _by_path(self.constants, self.sensors, self.effects)
        paths = [f"{table}.{key}" for table, values in tables.items() for key in values]
        return InputError(f"arm '{self.name}' has no value '{path}'{did_you_mean(path, paths)}")

    def with_values(self, values: Values) -> Arm:
        """Replace values, which are not checked against their bounds.

        Args:
            values: in SI units by path.

        Returns:
            Another arm; this one is unchanged.

        Raises:
            InputError: for a path of no value of this arm.

        Example:
            >>> Arm.load("thesis").with_values({"beam.length": 0.8, "effects.coulomb.torque": 0.3}).value("beam.length")
            0.8
        """
        constants = {key: dict(table) for key, table in self.constants.items()}
        sensors = {key: dict(table) for key, table in self.sensors.items()}
        effects = {key: dict(table) for key, table in self.effects.items()}
        tables = _by_path(constants, sensors, effects)
        for path, value in values.items():
            table, _, key = path.rpartition(".")
            if key not in tables.get(table, {}):
                raise self._no_value(path)
            tables[table][key] = value
        return replace(self, constants=constants, sensors=sensors, effects=effects)

    @property
    def signals(self) -> Sequence[str]:
        """Names of the measured signals, in the order of the readings."""
        return list(self.sensors)

    @staticmethod
    def sensor(signal: str) -> type[Sensor]:
        """Look up the class of a signal's sensor: unit, label, range.

        Raises:
            InputError: for an unknown signal.

        Example:
            >>> Arm.sensor("tip_deflection").label
            'tip deflection'
        """
        if signal not in known_sensors():
            raise InputError(f"unknown signal '{signal}'{did_you_mean(signal, known_sensors())}")
        return known_sensors()[signal]

    def reading_noise(self, signal: str) -> float:
        """Look up the standard deviation of a reading, of its noise and of the rounding to steps, in the signal's unit.

        Raises:
            InputError: for a signal whose noise is estimated from recordings.

        Example:
            >>> round(Arm.load("thesis").reading_noise("arm_angle"), 5)
            0.00205
        """
        if signal in self.auto_noise:
            raise InputError(
                f"arm '{self.name}' has noise = \"auto\" for {signal}, which only recordings give: "
                f"write a number under [sensors.{signal}], as `flexarm compare` prints it"
            )
        return reading_noise(self.sensors[signal])

    def structure(self) -> Structure:
        """Build the linear part of the arm, with all linear effects applied."""
        from flexarm_env.machine import structure_of

        return structure_of(self.constants, self.input, self.sensors, self.present(), self.known)

    def present(self) -> list[tuple[str, Values]]:
        """Effects with a value other than null, by name, with their values."""
        return [(n, self.effects[n]) for n in sorted(self.effects) if not self.known[n].absent(self.effects[n])]

    def laws(self) -> list[ActiveLaw]:
        """List the nonlinear laws of all effects that are present, with their parameters."""
        from flexarm_env.machine import laws_of

        return laws_of(self.constants, self.signals, self.present(), self.known)

    def plant(self, interval: float, vibrations: int = 0) -> Plant:
        """Compile the arm for simulation.

        Args:
            interval: sampling time [s].
            vibrations: of the beam that are kept, the slowest; 0 keeps all that its elements have.

        Example:
            >>> import numpy as np
            >>> plant = Arm.load("thesis").plant(0.005)
            >>> plant.place()
            >>> plant.replay(np.full(100, 3.0)).shape  # readings (samples, signals) under 3 A
            (100, 4)
        """
        from flexarm_env.plant.plant import Plant

        structure = self.structure()
        structure.vibrations = vibrations
        return Plant(structure, self.laws(), self.known.laws, interval)

    def linearise(self, mode: str, interval: float) -> LinearArm:
        """Linearise the arm while its hub moves or is stuck.

        Args:
            mode: "moving" or "stuck".
            interval: sampling time [s].

        Raises:
            InputError: for another mode, or an interval that is not positive.

        Example:
            >>> frequencies, damping = Arm.load("thesis").linearise("stuck", 0.005).vibrations()
            >>> [round(float(f), 2) for f in frequencies]
            [2.43, 23.93]
        """
        from flexarm_env.linear import linearise

        return linearise(self, mode, interval)


@functools.cache
def short_name(path: str) -> str:
    """Shorten a path for tables: "beam.length" to length, "hub.inertia" to hub_inertia, "effects.x.y" to x_y."""
    section, *rest = path.split(".")
    return f"hub_{rest[0]}" if section == "hub" else "_".join(rest)


def _by_path(*parts: Mapping[str, Any]) -> dict[str, Any]:
    """List the tables of constants, sensors and effects by the path that is before a key."""
    constants, sensors, effects = parts
    found = {**constants, **{f"sensors.{name}": table for name, table in sensors.items()}}
    return found | {f"effects.{name}": table for name, table in effects.items()}
