"""The arm: base constants, sensors and effects. Everything takes one, and the loop returns a better one."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flexarm_env.display import Shown
from flexarm_env.effects import Catalogue, Effect, catalogue
from flexarm_env.effects.catalogue import LAW_PORTS
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.parameters import SECTIONS, SENSOR, Parameter, sensor_unit
from flexarm_env.signals import INPUTS

if TYPE_CHECKING:
    from flexarm_env.linear import LinearArm
    from flexarm_env.plant.active_laws import ActiveLaw
    from flexarm_env.plant.plant import Plant
    from flexarm_env.plant.structure import Structure

Values = Mapping[str, float]


@dataclass(frozen=True)
class Arm(Shown):
    """A flexible (or rigid) arm. Immutable: every change returns another arm.

    Attributes:
        name: for a person.
        input: what the command is, "current" or "voltage".
        constants: base constants in SI units by section and key, as {"drive": {"gear_ratio": 1.5, …}, …}; without "beam" the
            arm is rigid.
        sensors: settings of each measured signal in SI units.
        effects: parameters of each effect in SI units.
        fixed: paths of constants that no fit may move.
        columns: how foreign recordings name their columns, or nothing.
        fitted: for each fitted value ("beam.bending_stiffness") its value, low and high end of the 90 % interval and unit.
        origin: from which recordings, by which command the fit came.
        description: one line for a person.
        known: the effects that exist.
    """

    name: str
    input: str
    constants: Mapping[str, Values]
    sensors: Mapping[str, Values]
    effects: Mapping[str, Values] = field(default_factory=dict)
    fixed: Sequence[str] = ()
    columns: Mapping[str, Any] | None = None
    fitted: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    origin: Mapping[str, Any] = field(default_factory=dict)
    description: str = ""
    known: Catalogue = field(default_factory=catalogue, repr=False, compare=False)

    def __repr__(self) -> str:
        return f"Arm({self.name!r}, {self.input} drive, effects: {', '.join(self.effects) or 'none'})"

    @classmethod
    def load(cls, source: str | Path = "thesis", known: Catalogue | None = None) -> Arm:
        """Read an arm file, or one of the shipped arms by name.

        Raises:
            InputError: for a file that is not there or not an arm file, in one line.
        """
        from flexarm_env.arm_file import read_arm

        return read_arm(source, known or catalogue())

    def save(self, path: str | Path) -> None:
        """Write the arm file, whole or not at all."""
        from flexarm_env.arm_file import write_arm

        write_arm(self, Path(path))

    def with_effect(self, name: str, **parameters: float) -> Arm:
        """Return the arm with an effect added or changed; parameters not given take their typical size.

        Raises:
            InputError: for an effect or parameter that does not exist, or a value out of bounds.
        """
        effect = self.known[name]
        values = {key: p.typical for key, p in effect.parameters.items()} | dict(self.effects.get(name, {}))
        for key, value in parameters.items():
            if key not in effect.parameters:
                raise InputError(f"effect '{name}' has no parameter '{key}'{did_you_mean(key, effect.parameters)}")
            values[key] = check_bounds(f"effects.{name}.{key}", float(value), effect.parameters[key])
        self._check_needs(effect)
        return replace(self, effects={**self.effects, name: values})

    def _check_needs(self, effect: type[Effect]) -> None:
        missing = [need for need in effect.needs if not self.has(need)]
        if missing:
            raise InputError(f"effect '{effect.name}' needs {' and '.join(missing)}, which arm '{self.name}' does not have")

    def has(self, need: str) -> bool:
        """Whether the arm has a beam, a motor or a hub with an inertia of its own, a sensor or an input of that name."""
        if need == "motor_inertia":
            return self.constants["drive"]["motor_inertia"] > 0.0
        if need == "hub_inertia":
            return self.constants["hub"]["inertia"] > 0.0 or "beam" in self.constants
        if need in INPUTS:
            return need == self.input
        return need in self.constants if need == "beam" else need in self.sensors

    def can_have(self, name: str) -> bool:
        """Whether the arm has what an effect needs."""
        return all(self.has(need) for need in self.known[name].needs)

    def without_effect(self, name: str) -> Arm:
        """Return the arm without an effect."""
        return replace(self, effects={key: value for key, value in self.effects.items() if key != name})

    def parameter(self, path: str) -> Parameter:
        """Return what is known about a value such as "beam.length", "sensors.arm_angle.gain", "effects.coulomb.torque"."""
        section, *rest = path.split(".")
        if section == "effects":
            return self.known[rest[0]].parameters[rest[1]]
        if section == "sensors":
            return replace(SENSOR[rest[1]], unit=sensor_unit(rest[0], rest[1]))
        return SECTIONS[section][rest[0]]

    def value(self, path: str) -> float:
        """Return the value at a path, in SI units."""
        section, *rest = path.split(".")
        if section in ("effects", "sensors"):
            table = self.effects if section == "effects" else self.sensors
            return table[rest[0]][rest[1]]
        return self.constants[section][rest[0]]

    def with_values(self, values: Values) -> Arm:
        """Return the arm with the values at some paths replaced (SI units, not checked against bounds)."""
        constants = {key: dict(table) for key, table in self.constants.items()}
        sensors = {key: dict(table) for key, table in self.sensors.items()}
        effects = {key: dict(table) for key, table in self.effects.items()}
        for path, value in values.items():
            section, *rest = path.split(".")
            if section == "effects":
                effects[rest[0]][rest[1]] = value
            elif section == "sensors":
                sensors[rest[0]][rest[1]] = value
            else:
                constants[section][rest[0]] = value
        return replace(self, constants=constants, sensors=sensors, effects=effects)

    @property
    def signals(self) -> Sequence[str]:
        """Names of the measured signals, in order."""
        return list(self.sensors)

    def structure(self) -> Structure:
        """Return the linear part with the effects of the structure port worked in."""
        from flexarm_env.plant.structure import Sensor, Structure

        beam = dict(self.constants.get("beam", {}))
        drive = self.constants["drive"]
        structure = Structure(
            gear_ratio=drive["gear_ratio"],
            torque_constant=drive["torque_constant"],
            motor_inertia=drive["motor_inertia"],
            hub_inertia=self.constants["hub"]["inertia"],
            resistance=drive["resistance"] if self.input == "voltage" else 0.0,
            motor_viscous_share=drive["motor_viscous_share"],
            gear_compliance=1.0 / drive["gear_stiffness"] if drive["gear_stiffness"] > 0.0 else 0.0,
            elements=int(beam.pop("elements", 0)),
            sensors={signal: Sensor(s["gain"], s["offset"], s["filter"], s["position"]) for signal, s in self.sensors.items()},
            **beam,
        )
        for name, values in self.present():
            port = self.known[name].port("structure")
            if port is not None:
                port(structure, **values)
        return structure

    def present(self) -> list[tuple[str, Values]]:
        """Effects that are not absent, with their values, in the order of their names."""
        return [(n, self.effects[n]) for n in sorted(self.effects) if not self.known[n].absent(self.effects[n])]

    def laws(self) -> list[ActiveLaw]:
        """Return the laws of friction, torque, drag and drive that act."""
        from flexarm_env.plant.active_laws import ActiveLaw

        active = []
        yields = any(self.known[name].port("presliding") for name, _ in self.present())
        for name, values in self.present():
            effect = self.known[name]
            for port in LAW_PORTS:
                if effect.port(port) is not None:
                    varies = effect.varies if port == "friction" else port in ("factor", "presliding", "torque", "weight", "drag")
                    parameters = tuple(values[key] for key in effect.parameters)
                    share = self.constants["drive"][effect.motor_share] if effect.motor_share and not yields else 0.0
                    active.append(ActiveLaw(self.known.kinds[name, port], port, parameters, varies, share, effect.reads))
        return active

    def plant(self, interval: float) -> Plant:
        """Return the compiled plant of this arm, sampled every `interval` seconds."""
        from flexarm_env.plant.plant import Plant

        return Plant(self.structure(), self.laws(), self.known.laws, interval)

    def linearise(self, mode: str, interval: float) -> LinearArm:
        """Return the state space of the arm in a mode, "moving" or "stuck", sampled every `interval` seconds."""
        from flexarm_env.linear import linearise

        return linearise(self, mode, interval)


def check_bounds(path: str, value: float, parameter: Parameter) -> float:
    """Return a value if it lies within its parameter's bounds.

    Raises:
        InputError: otherwise.
    """
    if not parameter.low <= value <= parameter.high:
        unit = f" {parameter.unit}" if parameter.unit else ""
        raise InputError(f"{path} = {value:g}{unit} is out of bounds: allowed are {parameter.low:g} to {parameter.high:g}{unit}")
    return value


@functools.cache
def short_name(path: str) -> str:
    """Name of a value for a person: "beam.length" is length, "hub.inertia" hub_inertia, "effects.x.y" x_y."""
    section, *rest = path.split(".")
    return f"hub_{rest[0]}" if section == "hub" else "_".join(rest)
