"""The thesis's rigid model with backlash: gears that collide without rebound (eqs. 2.13 to 2.22).

The effect `backlash` of the catalogue has compliant teeth (4000 Nm/rad) that rebound. No effect can express eq. 2.19, an
instantaneous, perfectly inelastic collision, so this module integrates it separately.

The conditions are derived from the contact force, since eq. 2.22 separates the gears where a speed changes sign. With
g = θ_m − N θ_a the motor pushes the arm forward at g = 0 and back at g = −Δθ. The gears separate when the contact force
would become tensile, and collide when g returns to one of the two.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from flexarm_env.controllers.pd import DERIVATIVE, PROPORTIONAL
from flexarm_env.thesis.constants import TABLE

Floats = NDArray[np.float64]

STEP = 1e-5  # [s]


def speed_after(motor: float, arm: float, arm_inertia: float = TABLE["J_a"]) -> float:
    """Compute the motor speed after a collision of the gears (thesis eq. 2.19) [rad/s].

    Args:
        motor: motor speed before [rad/s].
        arm: arm speed before [rad/s].
        arm_inertia: J_a [kg m²].
    """
    J_m, N = TABLE["J_m"], TABLE["N"]
    return (J_m * motor + arm_inertia * arm / N) / (J_m + arm_inertia / N**2)


def follow(
    target: Floats,
    interval: float,
    gap: float = TABLE["gap"],
    arm_inertia: float = TABLE["J_a"],
    rate: float = np.inf,
    printed: bool = False,
) -> Floats:
    """Follow a target under the thesis's PD from rest at angle 0, with the teeth in contact for a forward push.

    Args:
        target: (samples,) [rad].
        interval: from sample to sample [s].
        gap: Δθ [rad, motor side].
        arm_inertia: J_a [kg m²].
        rate: limit on the change of the current [A/s].
        printed: whether gears separate by eq. 2.22 as printed.

    Returns:
        (samples, 5): arm angle [rad], motor speed [rad/s], arm speed [rad/s], current [A], side of contact
        (1, −1, 0 apart).
    """
    t, stride = TABLE, round(interval / STEP)
    numbers = np.array(
        [t["N"], t["kphi"], t["J_m"], arm_inertia, t["b_m"], t["b_s"], t["T_mf"], t["T_af"], t["T_ms"], t["T_as"], gap, rate,
         PROPORTIONAL, DERIVATIVE, 5.0, float(printed)]
    )  # fmt: skip
    out = np.zeros((len(target), 5))
    march(numbers, np.ascontiguousarray(target), STEP, stride, out)
    return out


@njit(cache=True, error_model="numpy")
def slide(speed, torque, inertia, viscous, coulomb, static, step):  # type: ignore[no-untyped-def]
    """Step the speed of a body with dry friction: it stops at zero, and breaks away against static friction only."""
    if speed == 0.0:
        if abs(torque) <= static:
            return 0.0
        side = 1.0 if torque > 0.0 else -1.0
    else:
        side = 1.0 if speed > 0.0 else -1.0
    after = speed + step * (torque - viscous * speed - side * coulomb) / inertia
    return after if after * side > 0.0 else 0.0


@njit(cache=True, error_model="numpy")
def parts(side, before, after, torque, numbers, step):  # type: ignore[no-untyped-def]
    """Whether gears in contact on a side separate in this step; speeds and torque are the motor's."""
    gears, arm, rubs, viscous = numbers[0], numbers[3], numbers[7], numbers[5]
    if before == 0.0 and after == 0.0:
        return torque * side < -numbers[8]
    if numbers[15] > 0.0:
        return before * after <= 0.0 and before * side > 0.0
    way = 1.0 if before + after > 0.0 else -1.0
    load = arm * (after - before) / (step * gears) + viscous * before / gears + rubs * way
    return load * side < 0.0


@njit(cache=True, error_model="numpy")
def march(numbers, target, step, stride, out):  # type: ignore[no-untyped-def]
    """Fill out (samples, 5) by semi-implicit steps of fixed length."""
    gears, kphi, motor, arm, b_m, b_s, t_mf, t_af, t_ms, t_as, gap, rate, p, d, limit, _ = numbers
    inertia, viscous = motor + arm / gears**2, b_m + b_s / gears**2
    coulomb, static = t_mf + t_af / gears, t_ms + t_as / gears
    motor_angle = arm_angle = motor_speed = arm_speed = amps = 0.0
    side = 1.0
    for k in range(out.shape[0] * stride):
        wanted = p * (target[k // stride] - arm_angle) - d * motor_speed
        wanted = min(max(wanted, -limit), limit)
        amps = min(max(wanted, amps - rate * step), amps + rate * step)
        if k % stride == 0:
            row = out[k // stride]
            row[0], row[1], row[2], row[3], row[4] = arm_angle, motor_speed, arm_speed, amps, side
        torque = kphi * amps
        if side != 0.0:
            after = slide(motor_speed, torque, inertia, viscous, coulomb, static, step)
            if gap > 0.0 and parts(side, motor_speed, after, torque, numbers, step):
                side = 0.0
            else:
                motor_speed, arm_speed = after, after / gears
        if side == 0.0:
            motor_speed = slide(motor_speed, torque, motor, b_m, t_mf, t_ms, step)
            arm_speed = slide(arm_speed, 0.0, arm, b_s, t_af, t_as, step)
        motor_angle += step * motor_speed
        arm_angle += step * arm_speed
        play = motor_angle - gears * arm_angle
        ahead, behind = motor_speed > gears * arm_speed, motor_speed < gears * arm_speed
        if side == 0.0 and ((play >= 0.0 and ahead) or (play <= -gap and behind)):
            side = 1.0 if play >= 0.0 else -1.0
            motor_angle = gears * arm_angle - (0.0 if side > 0.0 else gap)
            motor_speed = (motor * motor_speed + arm * arm_speed / gears) / inertia
            arm_speed = motor_speed / gears
