"""Results as plain data for JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flexarm_env.pictures import words

if TYPE_CHECKING:
    from collections.abc import Sequence

    from flexarm_env.identify.calibrate.estimate import Estimate
    from flexarm_env.identify.explain.comparison import Comparison
    from flexarm_env.identify.results import Addition, Fit


def of_comparison(result: Comparison) -> dict[str, Any]:
    """Give a comparison without its curves."""
    return {
        "error": result.error,
        "free_run": result.free_run,
        "closed_loop": result.closed_loop,
        "noise": result.noise,
        "rows": [vars(row) for row in result.rows],
        "loop_rows": [vars(row) for row in result.loop_rows],
        "notes": result.notes,
    }


def of_fit(result: Fit) -> dict[str, Any]:
    """Give the errors and constants of a fit, and its settings."""
    return _calibrated(result, result.estimates)


def of_addition(result: Addition) -> dict[str, Any]:
    """Give the errors, parameters and constants of an added effect, and the settings."""
    prefix = f"effects.{result.effect}."
    own = [e for e in result.estimates if e.path.startswith(prefix)]
    others = [e for e in result.estimates if not e.path.startswith(prefix)]
    parameters = {e.path.removeprefix(prefix): e.as_json() for e in own}
    return {"effect": result.effect, "parameters": parameters} | _calibrated(result, others)


def _calibrated(result: Fit | Addition, constants: Sequence[Estimate]) -> dict[str, Any]:
    return {
        "error": result.error,
        "free_run": result.free_run,
        "closed_loop": result.closed_loop,
        "constants": {words.constant_name(e): e.as_json() for e in constants},
        "notes": result.notes,
        "settings": result.settings.as_json(),
        "seconds": round(result.seconds, 1),
    }
