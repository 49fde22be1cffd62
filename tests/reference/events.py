"""The reference arm by DOP853, restarted at every input step and every event."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray
from scipy.integrate import DOP853

from reference.arm import Arm, Array, Mode

NODES = 0.5 * (1 + chebyshev.chebpts1(8))  # in (0, 1): degree 7 is exact
TO_CHEBYSHEV = np.linalg.inv(chebyshev.chebvander(2 * NODES - 1, 7))
MAX_EVENTS_PER_STEP = 10_000


class ReferenceArm(Arm):
    """The arm with its solver."""

    def simulate(
        self, current: Array, dt: float, rtol: float = 1e-12, atol: float = 1e-16, start: Array | None = None
    ) -> dict[str, Any]:
        """Integrate with current (K,) [A], each held for dt [s], from start (2 * size,) = [q, q'] or rest.

        Returns arrays sampled at k dt, k = 0..K: time [s], hub_angle [rad], hub_speed [rad/s], tip [m] and
        tip_slope [rad] (absolute), moment_mid (x = 0.55 m) and moment_base (x = 0) [N m], energy [J], stuck
        (the mode just before k dt; at k = 0 just after), state (K + 1, 2 * size) absolute; and events, the
        number of mode changes, with event_times [s] and event_kinds (the new directions -1, 0, +1).
        """
        z = np.zeros(2 * self.size) if start is None else self._relative(start)
        states: list[Array] = [z]
        modes: list[int] = []
        events: list[tuple[float, int]] = []
        for k, amperes in enumerate(np.asarray(current, dtype=float)):
            torque, t, breaking_away = self.gear_ratio * self.motor_constant * float(amperes), 0.0, False
            modes = modes or [self._sign(z, torque, False)]
            sign = modes[-1]
            for _ in range(MAX_EVENTS_PER_STEP):
                previous, sign = sign, self._sign(z, torque, breaking_away)
                if sign != previous:
                    events.append((k * dt + t, sign))
                mode = self._mode(sign, torque)
                t, z, ended = self._advance(z, mode, t, dt, (rtol, atol))
                if not ended or t >= dt:
                    break
                breaking_away = sign == 0
            else:
                raise RuntimeError(f"livelock: over {MAX_EVENTS_PER_STEP} events in input step {k}")
            states.append(z)
            modes.append(sign)
        return self._result(np.array(states), np.array(modes), events, dt)

    def _advance(self, z: Array, mode: Mode, t: float, end: float, tolerance: tuple[float, float]) -> tuple[float, Array, bool]:
        """Integrate one mode from t towards end [s]; stop at its first event. Returns (time, z, event?)."""
        limit = 1.0 / self._fastest  # a sixth of the fastest period: well below half of it
        from_rest = mode.sign != 0 and z[self.size] == 0.0
        solver = _solver(mode, t, z, end, tolerance, min(limit / 3, end - t), limit)
        while solver.status == "running":
            old_t, old_z = solver.t, solver.y
            message = solver.step()
            if solver.status == "failed":
                raise RuntimeError(f"DOP853 failed: {message}")
            found = _first_fall(solver, mode, from_rest)
            from_rest = False
            if found is not None:
                row, guess = found
                t, z = _polish(mode, row, guess, (old_t, old_z), end, tolerance)
                if mode.sign:
                    z[self.size] = 0.0
                return t, z, True
        return end, solver.y, False

    def _result(self, z: Array, modes: NDArray[Any], events: list[tuple[float, int]], dt: float) -> dict[str, Any]:
        bend = z[:, 1 : self.size]
        q = z[:, : self.size] + z[:, :1] * np.concatenate([[0.0], self.rigid[1:]])
        speed = z[:, self.size :] + z[:, self.size, None] * np.concatenate([[0.0], self.rigid[1:]])
        state = np.hstack([q, speed])
        return {
            "time": dt * np.arange(len(z)),
            "hub_angle": q[:, 0],
            "hub_speed": speed[:, 0],
            "tip": q[:, -2],
            "tip_slope": q[:, -1],
            "moment_mid": bend @ self._bending(0.55),
            "moment_base": bend @ self._bending(0.0),
            "energy": self.energy(state),
            "stuck": modes == 0,
            "state": state,
            "events": len(events),
            "event_times": np.array([time for time, _ in events]),
            "event_kinds": np.array([kind for _, kind in events], dtype=int),
        }


def _solver(mode: Mode, t: float, z: Array, end: float, tolerance: tuple[float, float], first: float, limit: float) -> Any:
    rtol, atol = tolerance
    return DOP853(mode.slope, t, z, end, rtol=rtol, atol=atol, first_step=first, max_step=limit)


def _first_fall(solver: Any, mode: Mode, from_rest: bool) -> tuple[int, float] | None:
    """First time [s] in the last solver step at which a row of the mode falls through zero, and that row."""
    width = solver.t - solver.t_old
    dense = solver.dense_output()(solver.t_old + width * NODES)
    best: tuple[int, float] | None = None
    for row in range(len(mode.rows)):
        values = mode.rows[row] @ dense + mode.offsets[row]
        coefficients = TO_CHEBYSHEV @ (values / NODES if from_rest else values)  # the root at the start divided out
        if coefficients[0] > np.abs(coefficients[1:]).sum():
            continue  # surely positive on the whole step
        roots = chebyshev.chebroots(chebyshev.chebtrim(coefficients))
        real = roots[(roots.imag == 0) & (np.abs(roots) <= 1)].real
        falling = real[chebyshev.chebval(real, chebyshev.chebder(coefficients)) < 0]
        share = 0.5 * (1 + falling.min()) if len(falling) else 1.0
        ends_below = mode.rows[row] @ solver.y + mode.offsets[row] < 0
        if (len(falling) or ends_below) and (best is None or solver.t_old + width * share < best[1]):
            best = row, solver.t_old + width * share
    return best


def _polish(
    mode: Mode,
    row: int,
    guess: float,
    origin: tuple[float, Array],
    end: float,
    tolerance: tuple[float, float],
) -> tuple[float, Array]:
    """Newton's method for the event time on true solver steps from origin (time, z); returns (time, z)."""
    start, z_start = origin
    time, z = guess, z_start.copy()
    for _ in range(4):
        if time <= start:
            return start, z_start.copy()
        solver = _solver(mode, start, z_start, time, tolerance, time - start, np.inf)
        while solver.status == "running":
            solver.step()
        z = solver.y.copy()
        rate = mode.rows[row] @ mode.slope(time, z)
        change = -(mode.rows[row] @ z + mode.offsets[row]) / rate if rate < 0 else 0.0
        if abs(change) <= 1e-15 * end or abs(change) > 1e-6 * end:  # converged, or a graze: keep the root
            break
        time = min(max(time + change, start), end)
    return time, z
