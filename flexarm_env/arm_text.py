"""Arms as the TOML text of an arm file."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

from flexarm_env.arm_file import AUTO
from flexarm_env.arm_sections import SECTIONS, defaults_of
from flexarm_env.control.table import law_table
from flexarm_env.files import write_whole
from flexarm_env.parameters import Parameter

if TYPE_CHECKING:
    from tomlkit.items import Table

    from flexarm_env.arm import Arm


def write_arm(arm: Arm, path: Path) -> None:
    """Write an arm file, completely or not at all.

    Raises:
        InputError: if the file cannot be written.
    """
    write_whole(path, arm_text(arm))


def arm_text(arm: Arm) -> str:
    """Format an arm as TOML, in SI units with the unit beside each value. Defaults are left out.

    Example:
        >>> from flexarm_env import Arm
        >>> text = arm_text(Arm.load("thesis").with_effect("backlash", gap=0.06))
        >>> text.splitlines()[-2:]
        ['[effects.backlash]', 'gap = "0.06 rad"']
    """
    import tomlkit

    document = tomlkit.document()
    document["name"] = arm.name
    if arm.description:
        document["description"] = arm.description
    if arm.fixed:
        document["fixed"] = list(arm.fixed)
    for section in arm.constants:
        document[section] = _constants(arm, section)
    document["sensors"] = _sensors(arm)
    if arm.effects:
        document["effects"] = _effects(arm)
    controller = law_table(arm.controller, arm.input) if arm.controller else None
    for key, extra in (
        ("columns", arm.columns),
        ("conditions", dict(arm.conditions)),
        ("controller", controller),
        ("fitted", arm.fitted),
        ("origin", arm.origin),
    ):
        if extra:
            document[key] = extra
    return tomlkit.dumps(document)


def _constants(arm: Arm, section: str) -> Table:
    """Make the table of a section of base constants."""
    import tomlkit

    table = tomlkit.table()
    if section == "drive":
        table["input"] = arm.input
    defaults = defaults_of(section, arm.input, arm.constants)
    for key, value in arm.constants[section].items():
        if defaults.get(key) != value:
            _put(table, key, value, SECTIONS[section][key].under(arm.input))
    return table


def _sensors(arm: Arm) -> Table:
    """Make the table of the sensors' settings."""
    import tomlkit

    sensors = tomlkit.table(is_super_table=True)
    for signal, values in arm.sensors.items():
        table = tomlkit.table()
        for key, value in values.items():
            setting = arm.parameter(f"sensors.{signal}.{key}")
            if key == "noise" and signal in arm.auto_noise:
                table[key] = AUTO
            elif setting.typical != value:
                _put(table, key, value, setting)
        sensors[signal] = table
    return sensors


def _effects(arm: Arm) -> Table:
    """Make the table of the effects' parameters."""
    import tomlkit

    effects = tomlkit.table(is_super_table=True)
    for name, values in arm.effects.items():
        table = tomlkit.table()
        for key, value in values.items():
            _put(table, key, value, arm.known[name].parameters[key].under(arm.input))
        effects[name] = table
    return effects


def _put(table: Table, key: str, value: float, parameter: Parameter) -> None:
    if parameter.is_count:
        table[key] = int(value)
    elif parameter.unit and math.isfinite(value):
        table[key] = f"{float(value)!r} {parameter.unit}"
    else:
        table[key] = float(value)
