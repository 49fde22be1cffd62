"""The origin of a saved arm's values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from flexarm_env import __version__
from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.estimate import Estimate
from flexarm_env.identify.settings import Settings
from flexarm_env.recordings.recording import Recording


def with_origin(
    arm: Arm,
    fitted: Arm,
    values: Sequence[Estimate],
    recordings: Sequence[Recording],
    command: str,
    seed: int,
    settings: Settings,
) -> Arm:
    """Give `arm` the values and effects of `fitted`, their intervals, and their origin.

    Args:
        arm: as it came, with all its sensors and their stated noise.
        fitted: the same with fitted values, perhaps with fewer sensors.
        values: the fitted values.
        recordings: to which they were fitted.
        command: that made the fit.
        seed: recorded with the result.
        settings: numbers of the method; the arm keeps their digest.
    """
    fits: dict[str, dict[str, Any]] = {e.path: e.as_json() for e in values}
    origin = {
        "command": command,
        "version": __version__,
        "seed": seed,
        "settings": settings.digest(),
        "recordings": [{"name": r.name, "sha256": r.sha256} for r in recordings],
    }
    sensors = {
        signal: {**values, **fitted.sensors.get(signal, {}), "noise": values["noise"], "resolution": values["resolution"]}
        for signal, values in arm.sensors.items()
    }
    return replace(
        fitted,
        name=arm.name if arm.name.endswith("-fitted") else f"{arm.name}-fitted",
        sensors=sensors,
        auto_noise=arm.auto_noise,
        fitted=fits,
        origin=origin,
    )
