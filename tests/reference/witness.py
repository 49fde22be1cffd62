"""The second solver: matrix exponentials in absolute coordinates and extended precision."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import brentq

from reference.arm import Arm, Array
from reference.events import MAX_EVENTS_PER_STEP


def witness(arm: Arm, current: Array, dt: float, start: Array | None = None) -> dict[str, Array]:
    """Second solver: exact propagation in absolute coordinates; hub_angle, hub_speed, tip, tip_slope at k dt.

    Takes only M, B, K, the drive's constants and the friction torques from arm. In each mode the augmented
    state [q, q', net torque] is linear, so it advances by a matrix exponential (a Taylor series, in extended
    precision where the platform has it) over steps of a fortieth of the fastest period, or part of one.
    """
    d, y = arm.size, np.zeros(2 * arm.size + 1, dtype=np.longdouble)
    y[: 2 * d] = 0.0 if start is None else start
    width = dt / np.ceil(dt * arm._fastest * 40 / (2 * np.pi))
    clamped, slipping = (_Regime.build(arm, width, hub_free) for hub_free in (False, True))
    hold = -np.concatenate([arm.K[0], arm.B[0], [-1.0]]) - arm.M[0] @ clamped.system[d : 2 * d]
    samples = [y]
    for amperes in current:
        t, torque, forced = 0.0, arm.gear_ratio * arm.motor_constant * float(amperes), False
        for _ in range(MAX_EVENTS_PER_STEP):
            y[-1] = torque
            stuck = y[d] == 0 and abs(hold @ y) <= arm.static and not forced
            sign = 0 if stuck else np.sign(y[d] if y[d] != 0 else hold @ y)
            y[-1] = torque - sign * arm.coulomb
            rows = np.outer([-1, 1], hold) if stuck else sign * np.eye(1, 2 * d + 1, d)
            regime = clamped if stuck else slipping
            y, t, hit = regime.advance(y, t, dt, rows.astype(np.longdouble), arm.static if stuck else 0.0)
            forced = hit and stuck
            if hit and not stuck:
                y[d] = 0.0
            if t >= dt:
                break
        else:
            raise RuntimeError(f"livelock: over {MAX_EVENTS_PER_STEP} events in one input step")
        samples.append(y.copy())
    out = np.array(samples, dtype=float)
    return {"hub_angle": out[:, 0], "hub_speed": out[:, d], "tip": out[:, d - 2], "tip_slope": out[:, d - 1]}


@dataclass(frozen=True)
class _Regime:
    """Linear system of [q, q', net torque] (SI units) with its exponential over one scan width [s]."""

    system: Any
    step: Any
    width: float

    @staticmethod
    def build(arm: Arm, width: float, hub_free: bool) -> _Regime:
        d = arm.size
        K, right = arm.K.astype(np.longdouble), np.zeros((d, 2 * d + 1), dtype=np.longdouble)
        K[:, 0] = -K[:, 1:] @ arm.rigid[1:]  # rounding in K must not resist a rigid rotation
        K[0, 0] += arm.cable_stiffness
        right[:, :d], right[:, d : 2 * d], right[0, -1] = -K, -arm.B, 1.0
        free = slice(0, d) if hub_free else slice(1, d)
        system = np.zeros((2 * d + 1, 2 * d + 1), dtype=np.longdouble)
        system[:d, d : 2 * d] = np.eye(d)
        system[d : 2 * d][free] = _solve(arm.M[free, free], right[free])
        return _Regime(system, _exponential(system, width, np.eye(2 * d + 1, dtype=np.longdouble)), width)

    def advance(self, y: Any, t: float, end: float, rows: Any, offset: float) -> tuple[Any, float, bool]:
        """Go on from time t [s] to the end or until a `row . y + offset` falls below 0: (y, time, event?)."""
        rates = rows @ self.system
        while t < end:
            width = min(self.width, end - t)
            new = self.step @ y if width == self.width else _exponential(self.system, width, y)
            risk = (rows @ new + offset < 0) | ((rates @ y < 0) & (rates @ new > 0))
            times = [f for row in rows[risk] if (f := self._fall(row, offset, y, width)) is not None]
            if times:
                return _exponential(self.system, min(times), y), t + min(times), True
            y, t = new, t + width if width == self.width else end
        return y, end, False

    def _fall(self, row: Any, offset: float, y: Any, width: float) -> float | None:
        """When the margin falls through zero within width [s]: at its end, or at an extremum inside."""

        def margin(t: float) -> float:
            return float(row @ _exponential(self.system, t, y) + offset)

        def rate(t: float) -> float:
            return float(row @ self.system @ _exponential(self.system, t, y))

        turn = _root(rate, 0.0, width) if rate(0.0) * rate(width) < 0 else 0.0
        if turn and margin(turn) < 0 < margin(0.0):  # from rest, a dip at once is rounding: it has just broken away
            return _root(margin, 0.0, turn)
        return _root(margin, turn, width) if margin(width) < 0 else None


def _exponential(system: Any, width: float, y: Any) -> Any:
    """exp(system width) y by its Taylor series; width [s] is a fraction of the fastest period."""
    term = total = y
    for k in range(1, 21):
        term = system @ term * (np.longdouble(width) / k)
        total = total + term
    return total


def _solve(matrix: Array, right: Any) -> Any:
    """Solve a small system in extended precision: LAPACK's double solution, refined three times."""
    solution = np.zeros_like(right)
    for _ in range(4):
        residual = right - matrix.astype(np.longdouble) @ solution
        solution = solution + np.linalg.solve(matrix, residual.astype(float))
    return solution


def _root(function: Callable[[float], float], low: float, high: float) -> float:
    return float(brentq(function, low, high, xtol=1e-18, rtol=4 * np.finfo(float).eps))
