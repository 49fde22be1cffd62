"""Validation of effect classes."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping

from flexarm_env.effects.base import Effect
from flexarm_env.errors import InputError, did_you_mean
from flexarm_env.parameters import Parameter
from flexarm_env.plant.ports import PORT_ARGUMENTS
from flexarm_env.units import check_unit


def checked(effect: type[Effect]) -> type[Effect]:
    """Validate an effect and return it.

    Raises:
        InputError: for a missing or invalid attribute or port.
    """
    where = f"effect {effect.__name__}"
    for attribute in ("name", "equation", "parameters", "looks_like"):
        if not hasattr(effect, attribute):
            raise InputError(f"{where} lacks '{attribute}'")
    if not isinstance(effect.name, str) or not (effect.name.isidentifier() and effect.name.isascii()):
        raise InputError(f"{where}: name is {effect.name!r}; write it in letters, digits and _")
    if not isinstance(effect.parameters, Mapping) or not effect.parameters:
        raise InputError(f"{where}: parameters is {effect.parameters!r}; give a dict with one Parameter at least")
    for key, parameter in effect.parameters.items():
        if not isinstance(parameter, Parameter):
            raise InputError(f"{where}: parameters['{key}'] is {parameter!r}; write Parameter(unit, low, high, typical)")
        if parameter.unit:
            check_unit(parameter.unit)
    if effect.scan_phase and effect.scan_phase not in effect.parameters:
        raise InputError(f"{where}: scan_phase is {effect.scan_phase!r}{did_you_mean(effect.scan_phase, effect.parameters)}")
    others = effect.confused_with
    if not isinstance(others, (tuple, list)) or not all(isinstance(o, str) and o != effect.name for o in others):
        raise InputError(f"{where}: confused_with is {others!r}; give a tuple of other effects' names")
    ports = {port: function for port in ("structure", *PORT_ARGUMENTS) if (function := effect.port(port))}
    if not ports:
        raise InputError(f"{where} has no port: give it one of structure, {', '.join(PORT_ARGUMENTS)}")
    for port, function in ports.items():
        _check_port(f"{where}: {port}", function, (*PORT_ARGUMENTS.get(port, ("structure",)), *effect.parameters))
    return effect


def _check_port(where: str, function: Callable[..., float], allowed: tuple[str, ...]) -> None:
    if not inspect.isfunction(function) or function.__name__ == "<lambda>":
        raise InputError(f"{where} is no function of its own; write it with @staticmethod and def")
    for name, taken in inspect.signature(function).parameters.items():
        every = taken.kind is taken.VAR_KEYWORD and "structure" in allowed  # that port is not compiled
        if name not in allowed and not every:
            raise InputError(f"{where} takes '{name}'{did_you_mean(name, allowed)}")
