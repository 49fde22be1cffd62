"""Find where the model of a flexible arm fails against measurements, and add the missing effect."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from flexarm_env.registration import register_all

__version__ = "0.1.0"

if TYPE_CHECKING:
    from flexarm_env.arm import Arm
    from flexarm_env.effects import Effect, catalogue
    from flexarm_env.errors import InputError
    from flexarm_env.identify.diagnose import diagnose
    from flexarm_env.identify.explain.compare import compare
    from flexarm_env.identify.fit import add, fit
    from flexarm_env.identify.inspect.inspection import inspect_recordings
    from flexarm_env.recordings.recording import Recording
    from flexarm_env.sensors import Sensor

#: Where each public name lives: loaded at first use, so that importing the package stays quick.
_PLACES = {
    "Arm": "arm",
    "Effect": "effects",
    "catalogue": "effects",
    "InputError": "errors",
    "Recording": "recordings.recording",
    "Sensor": "sensors",
    "add": "identify.fit",
    "compare": "identify.explain.compare",
    "diagnose": "identify.diagnose",
    "fit": "identify.fit",
    "inspect_recordings": "identify.inspect.inspection",
    "simulate": "experiments.simulate",
}

__all__ = [
    "Arm",
    "Effect",
    "InputError",
    "Recording",
    "Sensor",
    "add",
    "catalogue",
    "compare",
    "diagnose",
    "fit",
    "inspect_recordings",
    "simulate",
]

register_all()


def __getattr__(name: str) -> Any:
    if name not in _PLACES:
        raise AttributeError(f"module 'flexarm_env' has no attribute '{name}'")
    return getattr(importlib.import_module(f"flexarm_env.{_PLACES[name]}"), name)
