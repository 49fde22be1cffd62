"""Arm files: reading of TOML with units. An arm file never runs code."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flexarm_env.arm_checks import check_constants, check_controller, check_link, check_needs
from flexarm_env.arm_sections import LEVEL, SECTIONS, defaults_of
from flexarm_env.control.table import law_from_table
from flexarm_env.effects import Catalogue
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.files import read_toml
from flexarm_env.parameters import INPUTS, read_value
from flexarm_env.recordings.checks import check_conditions
from flexarm_env.recordings.conditions import CONDITIONS
from flexarm_env.recordings.messages import file_error
from flexarm_env.sensors import known_sensors

if TYPE_CHECKING:
    from flexarm_env.arm import Arm

#: Noise of a sensor that is estimated from the recordings.
AUTO = "auto"
BESIDE = ("columns", "conditions", "controller", "fitted", "origin")
TOP = ("name", "description", "fixed", *SECTIONS, "sensors", "effects", *BESIDE)


def config_folders(kind: str) -> list[Path]:
    """List the folders of shipped "arms" or "agents": inside an installed package, or beside it in a source tree."""
    here = Path(__file__).parent
    return [here / "configs" / kind, here.parent / "configs" / kind]


def shipped_arms() -> dict[str, Path]:
    """List the files of the shipped arms by name.

    Example:
        >>> sorted(shipped_arms())[:3]
        ['cu-flexible', 'cu-rigid', 'dfki-pendulum']
    """
    return {path.stem: path for folder in config_folders("arms") for path in sorted(folder.glob("*.toml"))}


def arm_path(source: str | Path) -> Path | None:
    """Find the file of an arm, by its path or by the name of a shipped arm; None where there is none."""
    if os.path.isfile(source):  # pathlib's raises for a name longer than any
        return Path(source)
    return shipped_arms().get(str(source))


def read_arm(kind: type[Arm], source: str | Path, known: Catalogue) -> Arm:
    """Read an arm from a file or by the name of a shipped arm.

    Args:
        kind: class of the arm.
        source: path or name.
        known: catalogue of effects.

    Raises:
        InputError: for a missing or faulty file: one line with file, table and key, and how to mend it.
    """
    path = arm_path(source)
    if path is None:
        raise InputError(f"no arm '{source}': neither a file nor a shipped arm{did_you_mean(str(source), shipped_arms())}")
    table = read_toml(path)
    try:
        return arm_from_table(kind, table, path.stem, known)
    except InputError as error:
        raise file_error(path, error) from None


def arm_from_table(kind: type[Arm], table: Mapping[str, Any], name: str, known: Catalogue) -> Arm:
    """Build an arm from the tables of an arm file.

    Args:
        kind: class of the arm.
        table: the parsed file.
        name: of the arm, where the file states none.
        known: catalogue of effects.

    Raises:
        InputError: for an unknown, missing or impossible entry.
    """
    _refuse_unknown("", table, TOP)
    command, constants = _constants(table)
    sensors, auto_noise = _sensors(_table(table, "sensors"), command)
    arm = kind(
        name=_text(table, "name", name),
        input=command,
        constants=constants,
        sensors=sensors,
        fixed=_fixed(table.get("fixed", []), constants, sensors),
        auto_noise=auto_noise,
        columns=_table(table, "columns") if "columns" in table else None,
        conditions=_conditions(_table(table, "conditions", {}), constants),
        controller=law_from_table(table["controller"], command) if "controller" in table else None,
        fitted=_fitted(_table(table, "fitted", {})),
        origin=_table(table, "origin", {}),
        description=_text(table, "description", ""),
        known=known,
    )
    check_needs(arm)
    check_controller(arm)
    for effect, given in _table(table, "effects", {}).items():
        parameters = known[effect].parameters
        if not isinstance(given, Mapping):
            raise InputError(f"effects.{effect} is not a table; write [effects.{effect}]")
        _refuse_unknown(f"effects.{effect}.", given, parameters)
        missing = [key for key in parameters if key not in given and parameters[key].null is None]
        if missing:
            raise InputError(f"effects.{effect}.{missing[0]} is missing")
        absent = {key: p.null for key, p in parameters.items() if key not in given and p.null is not None}
        read = {key: read_value(f"effects.{effect}.{key}", value, parameters[key], command) for key, value in given.items()}
        arm = arm.with_effect(effect, **absent, **read)
    return arm


def _text(table: Mapping[str, Any], key: str, default: str) -> str:
    given = table.get(key, default)
    if not isinstance(given, str):
        raise InputError(f'{key} = {given!r} is no text; write it in quotes, as {key} = "bench 2"')
    if key == "name" and not given.isprintable():
        raise InputError(f"{key} = {given!r} has a character that cannot be printed; take it out")
    return given


def _constants(table: Mapping[str, Any]) -> tuple[str, dict[str, dict[str, float]]]:
    """Read the kind of the drive's command and the base constants by section."""
    drive = dict(_table(table, "drive"))
    command = drive.pop("input", "current")
    if not isinstance(command, str) or command not in INPUTS:
        raise InputError(f"drive.input = {command!r}{did_you_mean(str(command), INPUTS)}")
    constants = {"drive": _section("drive", drive, defaults_of("drive", command, table), command)}
    given = {"hub": _table(table, "hub", {} if "link" in table else None)}
    given |= {section: _table(table, section) for section in ("beam", "link", "joint") if section in table}
    constants |= {
        section: _section(section, values, defaults_of(section, command, table), command) for section, values in given.items()
    }
    if command == "torque" and "torque_constant" in drive:
        raise InputError('drive.torque_constant: a torque drive has none; take it out, or write input = "current"')
    check_constants(command, constants)
    if "fitted" not in table and "origin" not in table:  # a fit moves mass and inertia: motion shows mass times centre alone
        check_link(constants)
    return command, constants


def _fixed(given: Any, constants: Mapping[str, Any], sensors: Mapping[str, Any]) -> list[str]:
    allowed = [f"{section}.{key}" for section, values in constants.items() for key in values]
    allowed += [f"sensors.{signal}.gain" for signal in sensors]
    if not isinstance(given, list):
        raise InputError('fixed is not a list; write fixed = ["drive.torque_constant"]')
    for path in given:
        if path not in allowed:
            raise InputError(f"unknown constant '{path}' in fixed{did_you_mean(str(path), allowed)}")
    return [str(path) for path in given]


def _fitted(given: Mapping[str, Any]) -> dict[str, Any]:
    """Read value, interval and unit of each fitted path, as they were saved."""
    for path, entry in given.items():
        numbers = [entry.get(key) for key in ("value", "low", "high")] if isinstance(entry, Mapping) else [None]
        if any(isinstance(one, bool) or not isinstance(one, int | float) for one in numbers):
            raise InputError(f"fitted.{path} lacks a number; write value, low and high as they were saved, or leave it out")
    return dict(given)


def _conditions(given: Mapping[str, Any], constants: Mapping[str, Any]) -> dict[str, str]:
    """Read which constant takes its value from each condition of a recording."""
    allowed = [f"{part}.{key}" for part, values in constants.items() for key in values if not SECTIONS[part][key].is_count]
    found: dict[str, str] = {}
    for name, path in given.items():
        if path not in allowed:
            raise InputError(f"conditions.{name}: unknown constant {path!r}{did_you_mean(str(path), allowed)}")
        if path in found.values():
            raise InputError(f"conditions.{name}: another condition sets '{path}', too; keep one of them")
        check_conditions({name: 0.0})
        if name in CONDITIONS:
            raise InputError(f"conditions.{name}: every arm takes up '{name}' as it is; leave it out")
        found[name] = path
    return found


def _table(table: Mapping[str, Any], key: str, default: dict[str, Any] | None = None, prefix: str = "") -> dict[str, Any]:
    if key not in table:
        if default is not None:
            return default
        raise InputError(f"table [{key}] is missing")
    if not isinstance(table[key], dict):
        raise InputError(f"{prefix}{key} is not a table; write [{prefix}{key}]")
    found: dict[str, Any] = table[key]
    return found


def _refuse_unknown(prefix: str, table: Mapping[str, Any], allowed: Any) -> None:
    for key in table:
        if key not in allowed:
            raise InputError(f"unknown key '{prefix}{key}'{did_you_mean(key, allowed)}")


def _section(section: str, given: dict[str, Any], defaults: Mapping[str, float], command: str) -> dict[str, float]:
    parameters = SECTIONS[section]
    if "tilt" in parameters:
        given = _with_tilt(section, given)
    _refuse_unknown(f"{section}.", given, parameters)
    values = dict(defaults)
    values |= {key: read_value(f"{section}.{key}", value, parameters[key], command) for key, value in given.items()}
    for key, parameter in parameters.items():
        if key not in values:
            raise InputError(f"{section}.{key} is missing; it is a number{' in ' if parameter.unit else ''}{parameter.unit}")
    return values


def _with_tilt(section: str, given: dict[str, Any]) -> dict[str, Any]:
    """Replace `vertical = true`, a motion in a vertical plane, by the tilt of the axis."""
    if "vertical" not in given:
        return given
    if not isinstance(given["vertical"], bool):
        raise InputError(f"{section}.vertical = {given['vertical']!r}; write true or false")
    if "tilt" in given:
        raise InputError(f"{section}.vertical and {section}.tilt are both there; keep one of them")
    return {key: value for key, value in given.items() if key != "vertical"} | {"tilt": LEVEL if given["vertical"] else 0.0}


def _sensors(given: Mapping[str, Any], command: str) -> tuple[dict[str, dict[str, float]], list[str]]:
    """Read the settings of each sensor, and list those whose noise is estimated from recordings."""
    _refuse_unknown("sensors.", given, known_sensors())
    if not given:
        raise InputError("table [sensors] is empty: name at least one signal, as [sensors.arm_angle]")
    sensors, auto_noise = {}, []
    for signal in (signal for signal in known_sensors() if signal in given):
        table, settings = _table(given, signal, prefix="sensors."), known_sensors()[signal].settings()
        _refuse_unknown(f"sensors.{signal}.", table, settings)
        if table.get("noise") == AUTO:
            auto_noise.append(signal)
            table = table | {"noise": 0.0}
        values = {key: p.typical for key, p in settings.items()}
        values |= {key: read_value(f"sensors.{signal}.{key}", value, settings[key], command) for key, value in table.items()}
        sensors[signal] = values
    return sensors, auto_noise
