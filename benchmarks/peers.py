"""The same arm as a user would write it for other solvers: separate matrices in absolute coordinates, numpy, scipy.

Only the numbers of the arm file come from the package: the solutions are independent of the plant's.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]
Values = Mapping[str, Mapping[str, float]]

#: Width [rad/s] of the tanh that replaces the sign of the hub's speed, for solvers without events.
SMOOTH = 1e-3
MOST_EVENTS = 2000


@dataclass(frozen=True)
class Friction:
    """Dry friction and its variations: parameters of the effects of the same names, zero where absent."""

    coulomb: float = 0.0
    stiction: float = 0.0
    stribeck: float = 0.0
    falloff: float = 1.0
    asymmetric: float = 0.0
    amplitude: float = 0.0
    cycles: float = 0.0
    phase: float = 0.0

    def sliding(self, direction: float, speed: float, angle: float) -> float:
        """Compute the friction [Nm] that opposes motion in a direction (±1)."""
        total = self.coulomb + direction * self.asymmetric + self.stribeck * math.exp(-((speed / self.falloff) ** 2))
        return max(total + self.amplitude * math.sin(self.cycles * angle + self.phase), 0.0)

    def static(self, direction: float, angle: float) -> float:
        """Compute the largest friction [Nm] of a hub at rest against a push in a direction: at least that of sliding."""
        total = self.coulomb + self.stiction + self.stribeck
        total += self.amplitude * math.sin(self.cycles * angle + self.phase)
        return max(total, self.sliding(direction, 0.0, angle))


class Peer:
    """M q̈ + B q̇ + K q = e₀ (N k i − T), on q = [hub angle, v₁, s₁, …], absolute, and t di/dt + i = command.

    The state is [hub angle, deflections and slopes against the hub's line, speeds likewise, current].
    """

    def __init__(self, constants: Mapping[str, Mapping[str, float]], effects: Mapping[str, Mapping[str, float]]) -> None:
        beam, drive = constants["beam"], constants["drive"]
        self.n = int(beam["elements"])
        self.size = 1 + 2 * self.n
        h = beam["length"] / self.n
        nodes = h * np.arange(self.n + 1)
        upper = [[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h]]
        lower = [[54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h]]
        mass = self._spread(np.array(upper + lower) * beam["mass_per_length"] * h / 420)
        upper = [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h]]
        lower = [[-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]]
        stiffness = self._spread(np.array(upper + lower) * beam["bending_stiffness"] / h**3)[2:, 2:]
        rigid = np.column_stack([nodes, np.ones(self.n + 1)]).ravel()
        turn = np.hstack([rigid[:, None], np.eye(2 * self.n + 2)[:, 2:]])  # absolute from [angle, relative]
        self.mass = turn.T @ mass @ turn
        self.mass[0, 0] += drive["gear_ratio"] ** 2 * drive["motor_inertia"] + constants["hub"]["inertia"]
        full, damping = (np.zeros((self.size, self.size)) for _ in range(2))
        full[1:, 1:] = stiffness
        damping[1:, 1:] = stiffness * effects.get("beam_damping", {}).get("time", 0.0)
        damping[0, 0] += effects.get("viscous", {}).get("coefficient", 0.0)
        cable = effects.get("cable_stiffness", {"stiffness": 0.0, "rest_angle": 0.0})
        full[0, 0] += cable["stiffness"]
        self.torque = cable["stiffness"] * cable["rest_angle"]
        self.per_amp = drive["gear_ratio"] * drive["torque_constant"]
        self.lag = effects.get("current_lag", {}).get("time", 0.0)
        none: dict[str, float] = {}
        stribeck, position = effects.get("stribeck", none), effects.get("position_friction", none)
        self.friction = Friction(
            coulomb=effects.get("coulomb", none).get("torque", 0.0),
            stiction=effects.get("stiction", none).get("extra", 0.0),
            stribeck=stribeck.get("extra", 0.0),
            falloff=stribeck.get("falloff_speed", 1.0),
            asymmetric=effects.get("asymmetric_coulomb", none).get("torque", 0.0),
            amplitude=position.get("amplitude", 0.0),
            cycles=position.get("cycles", 0.0),
            phase=position.get("phase", 0.0),
        )
        self.pull = -np.hstack([full, damping])
        self.free = np.linalg.inv(self.mass)
        self.held = np.zeros_like(self.free)
        self.held[1:, 1:] = np.linalg.inv(self.mass[1:, 1:])
        self.answer = self.free[:, 0].copy()  # acceleration by 1 Nm on the hub
        self.free_pull, self.held_pull = self.free @ self.pull, self.held @ self.pull
        self.hold = self.pull[0] - self.mass[0] @ self.held_pull  # torque that friction takes at rest, less the drive's

    def _spread(self, element: Array) -> Array:
        total = np.zeros((2 * self.n + 2, 2 * self.n + 2))
        for first in range(0, 2 * self.n, 2):
            total[first : first + 4, first : first + 4] += element
        return total

    def moment_row(self, x: float, constants: Values) -> Array:
        """Build the row (size,) of the bending moment [Nm] at x [m]."""
        beam = constants["beam"]
        h = beam["length"] / self.n
        element = min(int(x / h), self.n - 1)
        u = x / h - element
        row = np.zeros(2 * self.n + 2)
        shape = [(12 * u - 6) / h**2, (6 * u - 4) / h, (6 - 12 * u) / h**2, (6 * u - 2) / h]
        row[2 * element : 2 * element + 4] = shape
        return np.concatenate([[0.0], beam["bending_stiffness"] * row[2:]])

    def _drive(self, y: Array, command: float) -> float:
        return self.torque + self.per_amp * (float(y[-1]) if self.lag else command)

    def _slope(self, y: Array, command: float, direction: float | None, width: float) -> Array:
        out = np.empty_like(y)
        z, m = y[: 2 * self.size], self.size
        out[:m] = z[m:]
        out[-1] = (command - y[-1]) / self.lag if self.lag else 0.0
        if direction == 0.0:
            out[m : 2 * m] = self.held_pull @ z
            return out
        speed, angle = float(z[m]), float(z[0])
        sign = math.tanh(speed / width) if direction is None else direction
        dry = self.friction.sliding(math.copysign(1.0, sign), speed, angle)
        out[m : 2 * m] = self.free_pull @ z + self.answer * (self._drive(y, command) - sign * dry)
        return out

    def smooth(self, command: Array, interval: float, rtol: float) -> Array:
        """Solve with LSODA and a tanh in place of the sign; return states (samples, 2 · size + 1)."""
        states = [np.zeros(2 * self.size + 1)]
        for start, stop in _pieces(command):
            times = interval * np.arange(start, stop + 1)
            slope = _with(self._slope, float(command[start]), None)
            found = solve_ivp(slope, times[[0, -1]], states[-1], "LSODA", times, rtol=rtol, atol=1e-3 * rtol)
            states += list(found.y.T[1:])
        return np.array(states)

    def exact(self, command: Array, interval: float, rtol: float, atol: float | None = None) -> Array:
        """Solve with DOP853 and events where the hub stops or breaks away; states as `smooth`."""
        y = np.zeros(2 * self.size + 1)
        out = np.zeros((len(command), len(y)))
        tolerance = {"rtol": rtol, "atol": 1e-3 * rtol if atol is None else atol}
        for start, stop in _pieces(command):
            u, end = float(command[start]), interval * stop
            t, broke = interval * start, False
            times = interval * np.arange(start + 1, stop + 1)
            for _ in range(MOST_EVENTS):
                direction = self._direction(y, u, broke)
                slope, events = _with(self._slope, u, direction), self._events(direction, u)
                left = times[times > t]
                found: Any = solve_ivp(slope, (t, end), y, "DOP853", left, events=events, **tolerance)
                if len(found.t):
                    first = round(found.t[0] / interval)
                    out[first : first + len(found.t)] = found.y.T
                if found.status == 0:
                    y = found.y[:, -1]
                    break
                which = next(i for i, at in enumerate(found.t_events) if len(at))
                t, y, broke = float(found.t_events[which][0]), found.y_events[which][0].copy(), direction == 0.0
                if not broke:
                    y[self.size] = 0.0
            else:
                raise RuntimeError(f"more than {MOST_EVENTS} events")
        return out

    def _push(self, y: Array, command: float) -> float:
        return self._drive(y, command) + float(self.hold @ y[: 2 * self.size])

    def _direction(self, y: Array, command: float, broke: bool) -> float:
        if y[self.size] != 0.0:
            return math.copysign(1.0, y[self.size])
        push = self._push(y, command)
        if not broke and abs(push) <= self.friction.static(math.copysign(1.0, push), float(y[0])):
            return 0.0
        return math.copysign(1.0, push)

    def _events(self, direction: float, command: float) -> Callable[[float, Array], float]:
        def stops(_t: float, y: Array) -> float:
            return float(direction * y[self.size])

        def breaks_away(_t: float, y: Array) -> float:
            push = self._push(y, command)
            return self.friction.static(math.copysign(1.0, push), float(y[0])) - abs(push)

        event: Any = breaks_away if direction == 0.0 else stops
        event.terminal, event.direction = True, -1.0
        return event


def _with(slope: Callable[..., Array], command: float, direction: float | None) -> Callable[[float, Array], Array]:
    return lambda _t, y: slope(y, command, direction, SMOOTH)


def _pieces(command: Array) -> list[tuple[int, int]]:
    """Split a command (samples,) into stretches of constant value, first and last sample; its last value is not applied."""
    edges = [0, *(np.flatnonzero(np.diff(command[:-1])) + 1), len(command) - 1]
    return list(zip(map(int, edges[:-1]), map(int, edges[1:]), strict=True))
