"""Tight reference solver of the flexible arm: slow, plain, and independent of the package.

The model is the consistent one of the thesis (eqs. 3.1-3.14 with the errata mended): n equal Euler-Bernoulli
elements on a hub that slips with Coulomb friction or sticks. The coordinates q = [hub angle, v_1, s_1, ...,
v_n, s_n] (deflection [m] and slope [rad] of each node) are absolute, measured from the line of the start:

    M q" + B q' + K q = [N k_phi i - T_f, 0, ...],   T_f = T_c sgn(hub speed) while the hub slips.

At zero hub speed the hub sticks as long as |hold torque| <= T_s; otherwise it slips the hold torque's way.

Two solvers share nothing but M, B and K:
- `ReferenceArm.simulate`: DOP853, restarted at every input step and every event. Each solver step's dense
  output is a polynomial of degree 7 in time, so all its roots are found: no pair of crossings can hide.
  The first root is then polished by Newton's method on true solver steps, not on the dense output.
- `witness`: matrix exponentials in absolute coordinates and extended precision, events by scan and brentq.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray
from scipy.integrate import DOP853
from scipy.linalg import eigh
from scipy.optimize import brentq

Array = NDArray[np.float64]

NODES = 0.5 * (1 + chebyshev.chebpts1(8))  # in (0, 1): degree 7 is exact
TO_CHEBYSHEV = np.linalg.inv(chebyshev.chebvander(2 * NODES - 1, 7))
MAX_EVENTS_PER_STEP = 10_000


@dataclass(frozen=True)
class Mode:
    """One linear regime: z" = weights (force + gain z), until a row of `rows z + offsets` falls below 0."""

    sign: int
    weights: Array
    force: Array
    gain: Array
    rows: Array
    offsets: Array

    def slope(self, _time: float, z: Array) -> Array:
        """Time derivative of z = [positions, speeds]; SI units."""
        half = len(self.force)
        out = np.empty(2 * half)
        out[:half] = z[half:]
        out[half:] = self.weights @ (self.force + self.gain @ z)
        return out


@dataclass(frozen=True)
class ReferenceArm:
    """Arm of the thesis (Table A.1) with n elements; torques, dampings and hub_inertia are on the arm's side.

    Units: payload kg; viscous N m s; coulomb and static (total, not the excess) N m; extra_damping a square
    matrix (1 + 2n) in absolute coordinates, added to B; beam_damping s (Kelvin-Voigt: C = time * K_beam);
    cable_stiffness N m/rad about angle 0; length m; mass_per_length kg/m; rigidity N m^2; inertias kg m^2;
    motor_constant N m/A. The hub's inertia is gear_ratio^2 motor_inertia + hub_inertia.
    """

    elements: int = 1
    payload: float = 0.0
    viscous: float = 1.5**2 * 0.0008 + 0.1
    coulomb: float = 1.5 * 0.066 + 0.183
    static: float = 1.5 * 0.09487 + 0.21574
    extra_damping: Array | None = None
    beam_damping: float = 0.0
    cable_stiffness: float = 0.0
    length: float = 1.0
    mass_per_length: float = 0.42381
    rigidity: float = 68.944e9 * 1.1475e-10
    gear_ratio: float = 1.5
    motor_inertia: float = 0.00193
    hub_inertia: float = 0.00129
    motor_constant: float = 0.33

    def __post_init__(self) -> None:
        if self.static < self.coulomb:
            raise ValueError("static is the total at rest: it cannot be below coulomb")

    @property
    def size(self) -> int:
        """Number of coordinates, 1 + 2 * elements."""
        return 1 + 2 * self.elements

    @cached_property
    def rigid(self) -> Array:
        """Coordinates of a rigid rotation by 1 rad: angle 1, deflections x, slopes 1."""
        x = self.length * np.arange(1, self.elements + 1) / self.elements
        return np.concatenate([[1.0], np.column_stack([x, np.ones(self.elements)]).ravel()])

    def _assemble(self, element: Array) -> Array:
        total = np.zeros((self.size + 1, self.size + 1))
        for first in range(0, 2 * self.elements, 2):
            total[first : first + 4, first : first + 4] += element
        return total[1:, 1:]  # the hub does not deflect: node 0 keeps its slope only

    @cached_property
    def K_beam(self) -> Array:
        """Stiffness of the beam alone (thesis eq. 3.8, primes restored), SI units."""
        h = self.length / self.elements
        upper = [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h]]
        lower = [[-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]]
        return self._assemble(self.rigidity / h**3 * np.array(upper + lower))

    @cached_property
    def K(self) -> Array:
        """Stiffness with the cable's at the hub, SI units."""
        return self.K_beam + self.cable_stiffness * self._hub_only()

    @cached_property
    def M_bare(self) -> Array:
        """Mass of beam and payload without the hub's inertia (thesis eqs. 3.7, 3.14), SI units."""
        h = self.length / self.elements
        upper = [[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h]]
        lower = [[54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h]]
        mass = self._assemble(self.mass_per_length * h / 420 * np.array(upper + lower))
        mass[-2, -2] += self.payload
        return mass

    @cached_property
    def M(self) -> Array:
        """Mass with the hub's inertia, SI units."""
        return self.M_bare + (self.gear_ratio**2 * self.motor_inertia + self.hub_inertia) * self._hub_only()

    @cached_property
    def B(self) -> Array:
        """Damping: viscous at the hub, Kelvin-Voigt in the beam, and the extra matrix; SI units."""
        damping = self.viscous * self._hub_only() + self.beam_damping * self.K_beam
        return damping if self.extra_damping is None else damping + self.extra_damping

    def _hub_only(self) -> Array:
        matrix = np.zeros((self.size, self.size))
        matrix[0, 0] = 1.0
        return matrix

    @cached_property
    def _gain(self) -> Array:
        """Force per z = [angle, q_f - rigid_f angle, and their rates], so a big angle cancels nothing."""
        relative = np.eye(self.size)
        relative[:, 0] = self.rigid
        stiffness = self.K_beam.copy()
        stiffness[:, 0] = 0.0  # a rigid rotation bends nothing, exactly
        stiffness[0, 0] = self.cable_stiffness
        viscous = self.B - self.beam_damping * self.K_beam
        bending = self.beam_damping * self.K_beam
        bending[:, 0] = 0.0
        return -np.hstack([stiffness, viscous @ relative + bending])

    @cached_property
    def _hold_row(self) -> Array:
        """Row u, hold torque = u . force: the hub's force less what the clamped beam's acceleration takes."""
        return np.concatenate([[1.0], -np.linalg.solve(self.M[1:, 1:], self.M[1:, 0])])

    @cached_property
    def _weights(self) -> tuple[Array, Array]:
        """Acceleration of z per force: (stuck, slipping)."""
        stuck = np.zeros((self.size, self.size))
        stuck[1:, 1:] = np.linalg.inv(self.M[1:, 1:])
        slip = np.array(np.linalg.inv(self.M), dtype=np.float64)
        slip[1:] -= np.outer(self.rigid[1:], slip[0])
        return stuck, slip

    def _mode(self, sign: int, torque: float) -> Mode:
        force = np.zeros(self.size)
        force[0] = torque - sign * self.coulomb
        if sign:
            row = np.zeros((1, 2 * self.size))
            row[0, self.size] = sign
            return Mode(sign, self._weights[1], force, self._gain, row, np.zeros(1))
        hold = self._hold_row @ self._gain
        rows, offsets = np.array([-hold, hold]), np.array([self.static - torque, self.static + torque])
        return Mode(0, self._weights[0], force, self._gain, rows, offsets)

    def _sign(self, z: Array, torque: float, breaking_away: bool) -> int:
        """Decide the mode: the hub's direction of motion, 0 when it sticks."""
        if z[self.size] != 0.0:
            return int(np.sign(z[self.size]))
        hold = torque + float(self._hold_row @ self._gain @ z)
        return 0 if abs(hold) <= self.static and not breaking_away else int(np.sign(hold))

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

    @cached_property
    def _fastest(self) -> float:
        """Largest angular frequency of the unconstrained hub [rad/s]; the clamped ones lie below it."""
        return float(np.sqrt(eigh(self.K, self.M, eigvals_only=True)[-1]))

    def _relative(self, state: Array) -> Array:
        half = np.asarray(state, dtype=float).reshape(2, self.size).copy()
        half[:, 1:] -= half[:, :1] * self.rigid[1:]
        return half.ravel()

    def moment_at(self, x: float, q: Array) -> Array:
        """Bending moment EI y'' [N m] at x [m] for absolute q (..., size); on a node, the outer element's."""
        q = np.asarray(q, dtype=float)
        return (q[..., 1:] - q[..., :1] * self.rigid[1:]) @ self._bending(x)

    def _bending(self, x: float) -> Array:
        """Row (2n,): moment [N m] at x [m] per node coordinate relative to the hub's line."""
        h = self.length / self.elements
        element = min(int(x / h + 1e-12), self.elements - 1)
        a = x / h - element
        shape = np.array([(12 * a - 6) / h**2, (6 * a - 4) / h, (6 - 12 * a) / h**2, (6 * a - 2) / h])
        row = np.zeros(2 * self.elements + 2)
        row[2 * element : 2 * element + 4] = self.rigidity * shape
        return row[2:]

    def energy(self, state: Array) -> Array:
        """Kinetic and elastic energy [J] of absolute states (..., 2 * size)."""
        q, speed = np.split(np.asarray(state, dtype=float), 2, axis=-1)
        bend = q - q[..., :1] * self.rigid
        kinetic = np.einsum("...i,ij,...j", speed, self.M, speed)
        elastic = np.einsum("...i,ij,...j", bend, self.K_beam, bend) + self.cable_stiffness * q[..., 0] ** 2
        return 0.5 * (kinetic + elastic)

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


def frequencies(elements: int, hub: str = "free", payload: float = 0.0) -> Array:
    """Natural frequencies [Hz], ascending, without 0; hub "free", "bare" (no inertia) or "clamped"."""
    arm = ReferenceArm(elements=elements, payload=payload)
    if hub == "clamped":
        squares = eigh(arm.K[1:, 1:], arm.M[1:, 1:], eigvals_only=True)
    elif hub in ("free", "bare"):
        squares = eigh(arm.K, arm.M if hub == "free" else arm.M_bare, eigvals_only=True)[1:]
    else:
        raise ValueError(f"hub must be 'free', 'bare' or 'clamped', not {hub!r}")
    return np.sqrt(squares) / (2 * np.pi)


def pulse_current(seconds: float = 5.0, dt: float = 0.005, amperes: float = 3.0) -> Array:
    """The thesis's pulse [A]: on from 0.5 s to 1.0 s (section 3.1), one value per dt [s]."""
    time = dt * (np.arange(round(seconds / dt)) + 0.5)
    return np.where((time > 0.5) & (time < 1.0), amperes, 0.0)


def white_noise_current(seed: int, steps: int, sigma: float = 1.0) -> Array:
    """Gaussian current (steps,) [A] of standard deviation sigma [A], independent from step to step."""
    return np.random.default_rng(seed).normal(0.0, sigma, steps)


def witness(arm: ReferenceArm, current: Array, dt: float, start: Array | None = None) -> dict[str, Array]:
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
    def build(arm: ReferenceArm, width: float, hub_free: bool) -> _Regime:
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
