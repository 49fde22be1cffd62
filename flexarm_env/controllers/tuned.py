"""Controllers that a search has tuned, as files: the options found, the search, and the loop's margins."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import tomlkit

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.files import read_toml, write_whole
from flexarm_env.thesis_drive import GEAR_RATIO, command_scale

#: Options that are commands per reading, of the thesis's drive: on angles, on motor speeds.
PER_ANGLE, PER_SPEED = ("proportional", "rate"), ("derivative",)
KEYS = ("controller", "arm", "version", "options", "search", "margins")
COMMENT = "Written by `flexarm tune`. Gains are those for the thesis's drive (5 A, gears 1.5); they are scaled to the arm's."


@dataclass(frozen=True)
class TunedController:
    """A controller with the options that a search has found.

    Attributes:
        controller: name of the law, in CONTROLLERS.
        arm: name of the arm on which it was tuned.
        version: of the package.
        options: of the law's class, gains as for the thesis's drive.
        search: budget, seed, score.
        margins: of the loop on that arm.
    """

    controller: str
    arm: str
    version: str
    options: Mapping[str, Any]
    search: Mapping[str, Any] = field(default_factory=dict)
    margins: Mapping[str, Any] = field(default_factory=dict)

    def save(self, path: Path) -> None:
        """Write the file, whole or not at all.

        Raises:
            InputError: for a place that cannot be written.
        """
        document = tomlkit.document()
        document.add(tomlkit.comment(COMMENT))
        for key, value in asdict(self).items():
            document.add(key, tomlkit.item(value))
        write_whole(path, tomlkit.dumps(document))

    @classmethod
    def load(cls, path: Path) -> TunedController:
        """Read a file.

        Raises:
            InputError: for a file that is not there, or is no tuned controller, in one line.
        """
        table = read_toml(path)
        texts = all(isinstance(table.get(key), str) for key in KEYS[:3])
        if not texts or not all(isinstance(table.get(key, {}), Mapping) for key in KEYS[3:]) or set(table) - set(KEYS):
            raise InputError(f"{path}: is no tuned controller; name a file that flexarm tune wrote")
        return cls(**({"options": {}} | table))


def tuned_folders() -> list[Path]:
    """List the folders of the shipped tuned controllers: inside an installed package, or beside it in a source tree."""
    here = Path(__file__).parent.parent
    return [here / "configs" / "controllers", here.parent / "configs" / "controllers"]


def shipped_controllers() -> dict[str, TunedController]:
    """Read the shipped tuned controllers, by the names of their files."""
    files = [path for folder in tuned_folders() for path in sorted(folder.glob("*.toml"))]
    return {path.stem: TunedController.load(path) for path in files}


def on_drive(arm: Arm, options: Mapping[str, Any]) -> dict[str, Any]:
    """Scale the gains among a law's options from the thesis's drive to an arm's."""
    scale = command_scale(arm)
    on_speed = scale * GEAR_RATIO / arm.constants["drive"]["gear_ratio"]
    factors = dict.fromkeys(PER_ANGLE, scale) | dict.fromkeys(PER_SPEED, on_speed)
    return {name: factors[name] * value if name in factors else value for name, value in options.items()}
