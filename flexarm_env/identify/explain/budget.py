"""The error budget: how much of the held-out excess error the constants, each effect and nothing explain."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from flexarm_env.identify.explain.error_steps import ErrorStep
from flexarm_env.identify.percent import percent
from flexarm_env.identify.replay.error_measure import SignalError, excess
from flexarm_env.identify.settings import Settings
from flexarm_env.sensors import known_sensors

REST = "rest"


@dataclass(frozen=True)
class Budget:
    """Shares of the held-out excess error in windows, as a variance over the noise, that each step of a diagnosis removes.

    Shares sum to 1. A step that makes the error worse has a negative share. Where the arm as given leaves nothing to explain,
    shares have no meaning: they are NaN.

    Attributes:
        shares: of "constants", of each accepted effect in its order, and of the "rest" that nothing explains.
        signals: the same by signal.
        errors: by signal, the errors "nominal", after "constants" and after each effect.
        torque: rms torque on the moving hub [Nm] that the arm leaves unexplained: "nominal", after "constants" and "final"; empty
            where it was not estimated.

    Example:
        >>> from flexarm_env.identify.explain.budget import Budget
        >>> round(Budget({"constants": 0.1, "backlash": 0.85, "rest": 0.05}).explained, 2)
        0.95
    """

    shares: Mapping[str, float] = field(default_factory=dict)
    signals: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    errors: Mapping[str, Mapping[str, SignalError]] = field(default_factory=dict)
    torque: Mapping[str, float] = field(default_factory=dict)

    @property
    def explained(self) -> float:
        """Share of the excess that is explained; NaN where there is none."""
        return 1.0 - self.shares.get(REST, math.nan)

    @property
    def has_meaning(self) -> bool:
        """Whether there was an excess to explain."""
        return math.isfinite(self.explained)

    @property
    def left(self) -> dict[str, SignalError]:
        """The error of each signal that the last step leaves, the largest first."""
        last = {signal: list(errors.values())[-1] for signal, errors in self.errors.items()}
        return dict(sorted(last.items(), key=lambda one: -one[1].over_noise))

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data: shares, `null` where they have no meaning; by signal; the error left, in its unit."""
        return {
            **_plain(self.shares),
            "signals": {signal: _plain(shares) for signal, shares in self.signals.items()},
            "errors": {signal: {name: one.over_noise for name, one in errors.items()} for signal, errors in self.errors.items()},
            "left": {signal: {"value": one.rms, "unit": known_sensors()[signal].unit} for signal, one in self.left.items()},
            "torque": {"unit": "Nm", **_plain(self.torque)} if self.torque else {},
        }


def budget(steps: Sequence[ErrorStep], settings: Settings) -> Budget:
    """Share the excess error of the arm as given among the steps of a diagnosis."""
    least = settings.errors.nothing_left
    names = [step.name for step in steps]
    scores = [steps[0].before, *(step.after for step in steps)]
    errors = {
        signal: dict(zip(["nominal", *names], [score.signals[signal] for score in scores], strict=True))
        for signal in scores[0].signals
    }
    by_signal = {signal: _shares(names, [one.over_noise for one in found.values()], least) for signal, found in errors.items()}
    return Budget(_shares(names, [score.windows for score in scores], least), by_signal, errors)


def budget_notes(steps: Sequence[ErrorStep], settings: Settings) -> list[str]:
    """Describe the steps that make the error worse, of all signals together or of one of them."""
    return [note for step in steps for note in _worse(step, settings)]


def rest_notes(found: Budget, error: float, settings: Settings) -> list[str]:
    """Describe an error over the noise that the named effects leave: how much, and in which signal most."""
    worst = next(iter(found.left.items()), None)
    above = worst is not None and worst[1].over_noise > settings.errors.close
    if error <= settings.errors.explained and not above:
        return []
    parts = [f"the corrected model still errs by {error:.3g} times the noise"]
    if worst is not None:
        signal, one = worst
        unit = known_sensors()[signal].unit
        parts.append(f"most in {signal} ({one.over_noise:.3g} times, {one.rms:.2g} {unit} rms)")
    if found.has_meaning:
        parts.append(f"{percent(found.explained)} of the excess is explained")
    return [f"{', '.join(parts)}: more is missing, or the noise is larger than the arm file says"]


def torque_notes(found: Budget, effects: Sequence[str]) -> list[str]:
    """Describe how the unexplained torque on the hub changes with the constants and the effects."""
    known = {name: torque for name, torque in found.torque.items() if math.isfinite(torque)}
    if len(known) < len(found.torque) or not known:
        return []
    causes = {"nominal": "as given", "constants": "constants refitted", "final": f"with {' and '.join(effects)}"}
    parts = [f"{torque:.2g} ({causes[name]})" for name, torque in known.items()]
    return [f"unexplained torque on the hub in fast motion, rms: {' → '.join(parts)} Nm"]


def _worse(step: ErrorStep, settings: Settings) -> Iterator[str]:
    """Describe what a step makes worse."""
    numbers = settings.selecting
    cause = "the refit of the constants" if step.name == "constants" else f"adding {step.name}"
    before, after = step.before.windows, step.after.windows
    if after > max(before, settings.errors.nothing_left):
        yield f"{cause} raises the held-out error from {before:.3g} to {after:.3g} times the noise"
    for signal, old in step.before.signals.items():
        new = step.after.signals[signal]
        if new.over_noise > max((1.0 + numbers.noticed) * old.over_noise, settings.errors.nothing_left):
            yield f"{cause} raises the error of {signal} from {old.over_noise:.3g} to {new.over_noise:.3g} times the noise"


def _shares(names: Sequence[str], errors: Sequence[float], least: float) -> dict[str, float]:
    """Share the excess of the first error among steps, and what the last one leaves."""
    if not errors[0] > least:
        return dict.fromkeys([*names, REST], math.nan)
    left = [excess(error) for error in errors]
    removed = [(old - new) / left[0] for old, new in pairwise(left)]
    return dict(zip([*names, REST], [*removed, left[-1] / left[0]], strict=True))


def _plain(shares: Mapping[str, float]) -> dict[str, float | None]:
    return {name: share if math.isfinite(share) else None for name, share in shares.items()}
