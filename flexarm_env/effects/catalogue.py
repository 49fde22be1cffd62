"""The catalogue: effects of this folder, of the entry-point group `flexarm_env.effects`, and of files named by the user."""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import pkgutil
import sys
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from importlib.metadata import entry_points
from pathlib import Path

from flexarm_env.effects.base import Effect
from flexarm_env.effects.checks import checked
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.plant.ports import PORT_ARGUMENTS

#: Ports that run in the compiled kernel.
LAW_PORTS = tuple(PORT_ARGUMENTS)

Law = tuple[str, str, Callable[..., float], tuple[str, ...]]


class Catalogue(Mapping[str, type[Effect]]):
    """Effects by name, in alphabetical order, and the list of laws that the kernel is compiled with."""

    def __init__(self, effects: list[type[Effect]]) -> None:
        self._effects = {effect.name: effect for effect in sorted(effects, key=lambda e: e.name)}
        self.laws: list[Law] = []
        self.kinds: dict[tuple[str, str], int] = {}
        for name, effect in self._effects.items():
            for port in LAW_PORTS:
                function = effect.port(port)
                if function is not None:
                    self.kinds[name, port] = len(self.laws)
                    self.laws.append((port, name, function, tuple(effect.parameters)))

    def __getitem__(self, name: str) -> type[Effect]:
        if name not in self._effects:
            if is_of_file(name):
                raise InputError(f"effect '{name}' is of a file, which is not loaded here: load_effect, or --effects {name}")
            raise InputError(f"unknown effect '{name}'{did_you_mean(name, self._effects)}")
        return self._effects[name]

    def __contains__(self, name: object) -> bool:
        return name in self._effects

    def __iter__(self) -> Iterator[str]:
        return iter(self._effects)

    def __len__(self) -> int:
        return len(self._effects)

    @property
    def pairing(self) -> str:
        """Name of the effect beside which each other one is tried; "" if there is none."""
        return next((name for name, effect in self.items() if effect.pairs_with_all), "")

    def extended(self, *effects: type[Effect]) -> Catalogue:
        """Extend the catalogue by effects; one of the same name replaces the old."""
        names = {effect.name for effect in effects}
        return Catalogue([e for e in self._effects.values() if e.name not in names] + list(effects))


@lru_cache(maxsize=1)
def catalogue() -> Catalogue:
    """Collect the effects of this folder and of installed packages that register some."""
    package = importlib.import_module("flexarm_env.effects")
    found = []
    for module in pkgutil.iter_modules(package.__path__):
        if module.name not in ("base", "catalogue", "checks"):
            found += _effects_in(importlib.import_module(f"flexarm_env.effects.{module.name}"))
    found += [checked(point.load()) for point in entry_points(group="flexarm_env.effects")]
    return Catalogue(found)


def _effects_in(module: object) -> list[type[Effect]]:
    return [
        member
        for member in vars(module).values()
        if inspect.isclass(member) and issubclass(member, Effect) and "name" in vars(member)
    ]


def is_of_file(text: str) -> bool:
    """Whether a text names an effect of a user's file, and none of the catalogue.

    Example:
        >>> is_of_file("fan_drag.py:FanDrag"), is_of_file("fan_drag.py"), is_of_file("coulomb")
        (True, True, False)
    """
    return ":" in text or text.endswith(".py")


def load_effect(spec: str) -> type[Effect]:
    """Load a user's effect from "FILE.py:Name". This runs the file: name only files that you trust.

    Raises:
        InputError: for a file or class that is not there, a class that is no effect, and whatever the file raises but Ctrl-C.
    """
    import cloudpickle

    path_text, _, name = spec.rpartition(":")
    path = Path(path_text)
    if not path_text or not path.is_file():
        raise InputError(f"no effect in '{spec}': write FILE.py:Name, with a file that exists")
    module_name = f"flexarm_user_{path.stem}"
    module_spec = importlib.util.spec_from_file_location(module_name, path)
    if module_spec is None or module_spec.loader is None:
        raise InputError(f"'{path}' is no Python file: write FILE.py:Name")
    module = importlib.util.module_from_spec(module_spec)
    sys.modules[module_name] = module
    try:
        module_spec.loader.exec_module(module)
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        raise InputError(f"{path} does not load: {type(error).__name__}: {error}") from error
    cloudpickle.register_pickle_by_value(module)  # worker processes cannot import it by its name
    return _with_sources(checked(_chosen(path, name, module)))


def _chosen(path: Path, name: str, module: object) -> type[Effect]:
    """Look up an effect in a user's file."""
    found = vars(module).get(name)
    if found is None:
        raise InputError(f"{path} has no effect '{name}'{did_you_mean(name, [one.__name__ for one in _effects_in(module)])}")
    if not inspect.isclass(found) or not issubclass(found, Effect) or found is Effect:
        raise InputError(f"{path}: '{name}' is no effect; write class {name}(Effect), with Effect from flexarm_env.effects")
    return found


def _with_sources(effect: type[Effect]) -> type[Effect]:
    """Attach the source text to an effect's laws, from which the kernel is built: once unpickled they have no file."""
    for function in filter(None, map(effect.port, LAW_PORTS)):
        vars(function)["source"] = inspect.getsource(function)
    return effect
