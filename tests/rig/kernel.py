"""The time stepping of the rig, in one file because numba's cache does not notice edits elsewhere.

Scheme: position Verlet (drift h/2, kick h, drift h/2) with each body's dry friction solved inside the kick as a
bounded impulse (Moreau): a body whose free speed the impulse can stop does stop *exactly*, and stays until the
load exceeds its static budget. Motor rotor and arm hub are two bodies, so each sticks on its own.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

TWO_PI = 2.0 * math.pi

Beam = tuple[np.ndarray, np.ndarray, np.ndarray]  # modes, nodes, shape (nodes, modes): see parameters.py

# Places in the state vector: angles and speeds of motor and hub, and the memories of drive, sensors and effects.
TM, WM, TH, W, LAG, RATE, PLAY, TACH, SMID, SBASE, BASE, BASE_W, DAHL, TIME, CREEP_M, CREEP_B = range(16)
STATES = 16

CREEP = 1e-100  # [rad/s], moving but slower than any effect of the speed


@njit(cache=True)
def bounded(free: float, impulse: float) -> float:
    """Return the speed after dry friction took at most `impulse` off the free speed [rad/s]."""
    if abs(free) <= impulse:
        return 0.0
    return free - math.copysign(impulse, free)


@njit(cache=True)
def split(speed: float, force: float, sliding: float, static: float, leaving: float, inertia: float, h: float) -> float:
    """Return the speed [rad/s] of a body after a step of `h` [s], split where the body stands still.

    Args:
        sliding, static, leaving: dry friction [Nm] at that speed, at rest, and while it leaves.
    """
    left = h
    if speed != 0.0:
        net = force - math.copysign(sliding, speed)
        after = speed + h * net / inertia
        if after * speed >= 0.0:
            return after
        left = h + speed * inertia / net
    if abs(force) <= static:
        return 0.0
    return bounded(left * force / inertia, left * leaving / inertia)


@njit(cache=True)
def drive(s: np.ndarray, p: np.void, command: float) -> float:
    """Return the mean motor current [A] over a step for a (delayed) command [A or V]; the amplifier's memory sits in `s`."""
    i = command
    if p.dead > 0.0:
        i = 0.0 if abs(i) <= p.dead else i - math.copysign(p.dead, i)
    if p.amp_hyst > 0.0:
        s[PLAY] = min(max(s[PLAY], i - 0.5 * p.amp_hyst), i + 0.5 * p.amp_hyst)
        i = s[PLAY]
    if p.brush > 0.0:
        drop = p.brush / p.ra
        i = 0.0 if abs(i) <= drop else i - math.copysign(drop, i)
    if p.backemf > 0.0:
        i -= p.backemf * p.kphi * s[WM] / p.ra
    i = min(max(i, -p.sat), p.sat)
    if p.rate > 0.0:
        ahead = i - s[RATE]
        ramp = min(abs(ahead) / (p.rate * p.h), 1.0)  # share of the step for which the current still rises or falls
        s[RATE] += math.copysign(ramp * p.rate * p.h, ahead)
        i = s[RATE] - math.copysign(0.5 * ramp * ramp * p.rate * p.h, ahead)
    if p.volts > 0.0:
        i = (i - p.kphi * s[WM]) / p.ra
    if p.lag > 0.0:
        behind = i - s[LAG]
        s[LAG] += behind * (1.0 - math.exp(-p.h / p.lag))
        i -= behind * (p.lag / p.h) * (1.0 - math.exp(-p.h / p.lag))
    return i


@njit(cache=True)
def mesh_torque(s: np.ndarray, p: np.void) -> float:
    """Return the torque that the gear puts on the arm [Nm]: spring and damper in contact, nothing in the gap."""
    delta = s[TM] / p.gear - s[TH]
    if p.gap_low <= delta <= p.gap_high and p.gap_high > p.gap_low:
        return 0.0
    edge = p.gap_high if delta > p.gap_high else p.gap_low
    torque = p.mesh_k * (delta - edge) + p.mesh_c * (s[WM] / p.gear - s[W])
    if p.gap_high > p.gap_low and torque * (delta - edge) < 0.0:
        return 0.0
    return torque


@njit(cache=True)
def motor_torque(s: np.ndarray, p: np.void, current: float) -> float:
    """Return the electromagnetic and magnetic torque on the rotor [Nm, motor side]."""
    torque = p.kphi * current
    if p.sag > 0.0:
        torque *= max(1.0 - p.sag * current * current, 1.0 / 3.0)
    if p.torque_ripple != 0.0:
        torque *= 1.0 + p.torque_ripple * math.sin(p.torque_ripple_n * s[TM])
    if p.cog != 0.0:
        torque += p.cog * math.sin(p.cogn * s[TM] + p.cogphi)
    if p.detent != 0.0:
        swell = 1.0 + math.sin(TWO_PI * s[TIME] / p.detent_period)
        torque += p.detent * swell * math.sin(p.detent_n * s[TM])
    return torque


@njit(cache=True)
def friction_scale(s: np.ndarray, p: np.void) -> float:
    """Return the common factor on all dry friction from warming up and from a temperature step."""
    scale = 1.0
    if p.warm != 0.0:
        scale -= p.warm * (1.0 - math.exp(-s[TIME] / p.warm_tau))
    if p.temp_step != 0.0 and s[TIME] >= p.temp_time:
        scale += p.temp_step
    return scale


@njit(cache=True)
def arm_budget(s: np.ndarray, p: np.void, free: float, load: float) -> float:
    """Return the dry friction available at the arm hub [Nm] in the direction of the free speed `free`."""
    level = p.tas if s[W] == 0.0 else p.taf
    if p.stribeck != 0.0:
        level += p.stribeck * math.exp(-((s[W] / p.vs) ** 2))
    if p.posf != 0.0:
        level += p.posf * math.sin(p.posn * s[TH] + p.posphi)
    if p.spot != 0.0:
        level += p.spot * math.exp(-(((s[TH] - p.spot_at) / p.spot_width) ** 2))
    level += p.loadf * abs(load)
    if s[W] != 0.0:
        level += p.asym if free > 0.0 else -p.asym
    return max(level, 0.0)


@njit(cache=True)
def outside_torque(s: np.ndarray, p: np.void) -> float:
    """Return the speed-free torques on the hub [Nm]: constant, cable, tilt (rigid part), hum, end stops."""
    torque = p.bias - p.cable * (s[TH] - p.cable0)
    if p.tilt_torque != 0.0:
        torque -= p.tilt_torque * math.sin(s[TH] - p.tilt_dir)
    if p.hum != 0.0:
        torque += p.hum * math.sin(TWO_PI * p.humf * s[TIME] + p.humphi)
    if p.stop > 0.0 and abs(s[TH]) > p.stop_at:
        torque -= p.stop * (s[TH] - math.copysign(p.stop_at, s[TH]))
    return torque


@njit(cache=True)
def drag_load(s: np.ndarray, rate: np.ndarray, p: np.void, beam: Beam, force: np.ndarray) -> float:
    """Add the quadratic air drag to the modal forces and return its torque about the hub [Nm]."""
    _, nodes, shape = beam
    torque = 0.0
    for g in range(nodes.size):
        speed = nodes[g].x * s[W]
        for j in range(rate.size):
            speed += shape[g, j] * rate[j]
        f = -p.drag * abs(speed) * speed * nodes[g].weight
        torque += nodes[g].x * f
        for j in range(rate.size):
            force[j] += shape[g, j] * f
    return torque


@njit(cache=True)
def base_motion(s: np.ndarray, p: np.void, torque: float) -> float:
    """Advance a compliant base under the gear's reaction and return its angular acceleration [rad/s²]."""
    if p.fix_j <= 0.0:
        return 0.0
    accel = -torque / p.fix_j - p.fix_w2 * s[BASE] - p.fix_c * s[BASE_W]
    s[BASE_W] += p.h * accel
    s[BASE] += p.h * s[BASE_W]
    return accel


@njit(cache=True)
def hub_speed(s: np.ndarray, p: np.void, force: float, load: float, scale: float) -> float:
    """Return the hub's next speed [rad/s] from the force [Nm] on its residual inertia, with its friction.

    `p.jk` is that inertia and, of a hub with the motor on it, half a step of linear damping: the trapezoidal rule.
    """
    if p.dahl > 0.0:
        level = max(arm_budget(s, p, s[W], load) * scale, 1e-9)
        s[DAHL] += p.h * (s[W] - p.dahl * abs(s[W]) * s[DAHL] / level)
        return s[W] + p.h * (force - p.dahl * s[DAHL]) / p.jk
    if p.split > 0.0:
        before = s[W]
        sliding = arm_budget(s, p, before, load) * scale
        s[W] = 0.0
        static = arm_budget(s, p, force, load) * scale
        s[W] = math.copysign(CREEP, force)
        leaving = arm_budget(s, p, force, load) * scale
        s[W] = before
        return split(before, force, sliding, static, leaving, p.jk, p.h)
    free = s[W] + p.h * force / p.jk
    return bounded(free, p.h * arm_budget(s, p, free, load) * scale / p.jk)


@njit(cache=True)
def beam_forces(s: np.ndarray, eta: np.ndarray, rate: np.ndarray, p: np.void, beam: Beam, force: np.ndarray) -> float:
    """Fill the modal forces [N kg^-½] and return the torque [Nm] of drag and beam on the hub's residual inertia."""
    m = beam[0]
    force[:] = 0.0
    torque = drag_load(s, rate, p, beam, force) if p.drag > 0.0 else 0.0
    side = math.sin(s[TH] - p.tilt_dir) if p.tilt_torque != 0.0 else 0.0
    stiff = 1.0 + p.stiff_drift * s[TIME]
    for j in range(eta.size):
        force[j] -= m[j].gravity * side + stiff * m[j].omega2 * eta[j] + m[j].damp * rate[j]
        torque -= m[j].coupling * force[j]
    return torque


@njit(cache=True)
def step(s: np.ndarray, eta: np.ndarray, rate: np.ndarray, p: np.void, beam: Beam, current: float, force: np.ndarray) -> None:
    """Advance the mechanics by one step of `p.h` seconds, in place."""
    m, half = beam[0], 0.5 * p.h
    s[TIME] += half
    s[TM] += half * s[WM]
    s[TH] += half * s[W]
    for j in range(eta.size):
        eta[j] += half * rate[j]
    tau = p.gear * motor_torque(s, p, current) if p.joined > 0.0 else mesh_torque(s, p)
    scale = friction_scale(s, p)
    base = base_motion(s, p, tau)
    rotor = motor_torque(s, p, current) - tau / p.gear - p.bm * s[WM] - p.jm * base
    hub = tau + outside_torque(s, p) - p.bs * s[W] - p.asymv * abs(s[W]) - p.jr * base
    hub += beam_forces(s, eta, rate, p, beam, force)
    if p.joined == 0.0:
        if p.split > 0.0:
            s[WM] = split(s[WM], rotor, p.tmf * scale, p.tms * scale, p.tmf * scale, p.jm, p.h)
        else:
            budget = (p.tms if s[WM] == 0.0 else p.tmf) * scale
            s[WM] = bounded(s[WM] + p.h * rotor / p.jm, p.h * budget / p.jm)
    before = s[W]
    s[W] = hub_speed(s, p, hub, tau, scale)
    if p.joined > 0.0:
        s[WM] = p.gear * s[W]
    accel = (s[W] - before) / p.h + base
    s[TM] += half * s[WM]
    s[TH] += half * s[W]
    for j in range(eta.size):
        rate[j] += p.h * (force[j] - m[j].coupling * accel)
        eta[j] += half * rate[j]
    s[TIME] += half


@njit(cache=True)
def energy(s: np.ndarray, eta: np.ndarray, rate: np.ndarray, p: np.void, m: np.ndarray) -> float:
    """Return the energy [J] of rotor, hub, beam and gear mesh (no cable, no tilt)."""
    delta = s[TM] / p.gear - s[TH]
    pen = delta - min(max(delta, p.gap_low), p.gap_high)
    twice = p.jm * s[WM] ** 2 + p.jr * s[W] ** 2 + p.mesh_k * pen**2
    stiff = 1.0 + p.stiff_drift * s[TIME]
    for j in range(eta.size):
        twice += (rate[j] + m[j].coupling * s[W]) ** 2 + stiff * m[j].omega2 * eta[j] ** 2
    return 0.5 * twice


@njit(cache=True)
def moments(eta: np.ndarray, m: np.ndarray) -> tuple[float, float]:
    """Return the bending moments EI y″ [Nm] at the mid and the base gage."""
    mid, base = 0.0, 0.0
    for j in range(eta.size):
        mid += m[j].bend_mid * eta[j]
        base += m[j].bend_base * eta[j]
    return mid, base


@njit(cache=True)
def bridges(s: np.ndarray, eta: np.ndarray, p: np.void, q: np.void, m: np.ndarray) -> tuple[float, float]:
    """Return the two bridge voltages [V] before lag and noise."""
    mid, base = moments(eta, m)
    mid, base = q.ksg * mid, q.ksg_base * base
    if q.creep != 0.0:
        blend = p.h / q.creep_tau
        s[CREEP_M] += blend * (q.creep * mid - s[CREEP_M])
        s[CREEP_B] += blend * (q.creep * base - s[CREEP_B])
        mid += s[CREEP_M]
        base += s[CREEP_B]
    return mid + q.crosstalk * s[WM], base + q.crosstalk * s[WM]


@njit(cache=True)
def filters(s: np.ndarray, p: np.void, q: np.void, mid: float, base: float) -> None:
    """Advance the first-order lags of tachometer and strain amplifiers."""
    blend = 1.0 - math.exp(-p.h / q.tachlag) if q.tachlag > 0.0 else 1.0
    speed = s[WM]
    if q.trip != 0.0:
        speed *= 1.0 + q.trip * math.sin(s[TM] + q.trip_phi)
    s[TACH] += blend * (speed - s[TACH])
    blend = 1.0 - math.exp(-p.h / q.slag) if q.slag > 0.0 else 1.0
    s[SMID] += blend * (mid - s[SMID])
    s[SBASE] += blend * (base - s[SBASE])


@njit(cache=True)
def latch(s: np.ndarray, eta: np.ndarray, m: np.ndarray, q: np.void, t: float, row: np.ndarray) -> None:
    """Write what the sensors would show without noise: angle [rad], speed [rad/s], strains [V], deflection of the tip [m]."""
    row[0] = s[TH] + q.potnl * math.sin(q.potn * s[TH]) + q.off_angle
    row[1] = s[TACH] + q.off_speed
    row[2] = s[SMID] + q.off_mid + q.sdrift * t
    row[3] = s[SBASE] + q.off_base + q.sdrift * t
    row[4] = q.off_tip
    for j in range(eta.size):
        row[4] += m[j].tip * eta[j]


@njit(cache=True)
def quantise(value: float, lsb: float) -> float:
    """Round to the converter's step; a step of 0 leaves the value alone."""
    return value if lsb <= 0.0 else lsb * np.rint(value / lsb)


@njit(cache=True)
def interval(
    k: int,
    s: np.ndarray,
    eta: np.ndarray,
    rate: np.ndarray,
    p: np.void,
    q: np.void,
    beam: Beam,
    command: np.ndarray,
    force: np.ndarray,
    row: np.ndarray,
) -> float:
    """Advance from sample `k` to the next, latch the sensors into `row`; return the last current [A]."""
    current = 0.0
    for j in range(p.sub):
        at = (k * p.sub + j - p.delay_steps) // p.sub
        current = drive(s, p, command[at] if at >= 0 else 0.0)
        step(s, eta, rate, p, beam, current, force)
        mid, base = bridges(s, eta, p, q, beam[0])
        filters(s, p, q, mid, base)
        if j == p.sub - 1 - q.late_steps:
            latch(s, eta, beam[0], q, (k * p.sub + j + 1) * p.h, row)
    return current


@njit(cache=True)
def run(
    p: np.void,
    q: np.void,
    beam: Beam,
    feed: np.ndarray,
    target: np.ndarray,
    gains: tuple[float, float, float],
    noise: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Run from rest with command = feed + P (target - angle) - D speed on measured signals, held per sample.

    A servo has the motor's own angle in the place of the measured one, arm side and without noise.

    Args:
        gains: P [A/rad], D [A s/rad], limit of the command [A]; V in place of A where commands are voltages.
        feed: [A], (n,). target: [rad], (n,). noise: added before rounding, (n, 5).

    Returns:
        Commands (n,), measurements (n, 5), and truth (n, 7): hub angle, motor speed, hub speed, strains without
        faults, motor current, energy.
    """
    m = beam[0]
    n, modes = feed.size, m.size
    s, eta, rate, force = np.zeros(STATES), np.zeros(modes), np.zeros(modes), np.zeros(modes)
    command, shown, clean, truth = np.zeros(n), np.zeros((n, 5)), np.zeros((n + 1, 5)), np.zeros((n, 7))
    lsb = (q.step_angle, q.step_speed, q.step_strain, q.step_strain, q.step_tip)
    current = 0.0
    latch(s, eta, m, q, 0.0, clean[0])
    for k in range(n):
        mid, base = moments(eta, m)
        truth[k, 0], truth[k, 1], truth[k, 2], truth[k, 5] = s[TH], s[WM], s[W], current
        truth[k, 3], truth[k, 4], truth[k, 6] = q.ksg * mid, q.ksg_base * base, energy(s, eta, rate, p, m)
        late = max(k - q.late_samples, 0)
        for c in range(5):
            shown[k, c] = quantise(clean[late, c] + noise[k, c], lsb[c])
        angle = s[TM] / p.gear if p.servo > 0.0 else shown[k, 0]
        u = feed[k] + gains[0] * (target[k] - angle) - gains[1] * shown[k, 1]
        command[k] = min(max(u, -gains[2]), gains[2])
        current = interval(k, s, eta, rate, p, q, beam, command, force, clean[k + 1])
    return command, shown, truth
