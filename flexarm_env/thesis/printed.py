"""The thesis's equations as printed, and the effect of their misprints against the consistent ones.

Nothing here is an option of the product. A misprint that can be simulated is an arm with other constants. Dividing the
hub's row but not its column by N (erratum 3) makes the hub's inertia N J_m + J_hub/N in place of N² J_m + J_hub. It makes
the hub's damping N b_m + b_s/N, and the hub's coordinate the motor's angle.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh

from flexarm_env.arm import Arm
from flexarm_env.thesis import fixed_step
from flexarm_env.thesis.constants import EXPERIMENT_1, LENGTH, MASS_PER_LENGTH, RESISTANCE, TABLE
from flexarm_env.thesis.runs import Floats, Run

PI2 = 2.0 * np.pi


def arm(consistent: Arm) -> Arm:
    """Build the arm with the first column of M_T and K_T as printed after thesis eq. 3.9 (erratum 3)."""
    N = consistent.value("drive.gear_ratio")
    motor = consistent.value("drive.motor_inertia") / N
    viscous = N * TABLE["b_m"] + TABLE["b_s"] / N
    values = {"drive.motor_inertia": motor, "hub.inertia": consistent.value("hub.inertia") / N}
    values |= {"effects.viscous.coefficient": viscous}
    # its hub coordinate is the motor's angle: the arm's angle is that over N, and the motor's speed is its rate
    values |= {"sensors.arm_angle.gain": 1.0 / N, "sensors.motor_speed.gain": 1.0 / N}
    return consistent.with_values(values)


def beam_from_shapes() -> tuple[float, float]:
    """Compute the stuck first frequency [Hz] with k_ij of φ_i φ_j as printed (eqs. 3.8, 3.22), and of their curvatures."""
    model = fixed_step.pinned()
    mass = model.mass[1:, 1:]
    shapes = fixed_step.STIFFNESS * mass / MASS_PER_LENGTH
    return _first(shapes, mass), _first(model.stiffness[1:, 1:], mass)


def growth_rate() -> tuple[float, float]:
    """Compute the real part of A's fastest pole [1/s] with M⁻¹K, M⁻¹B as printed (eqs. 3.12, 3.30), and with their signs."""
    model = fixed_step.pinned()
    found = []
    for sign in (1.0, -1.0):
        lower = sign * np.linalg.solve(model.mass, np.hstack([model.stiffness, model.damping]))
        matrix = np.vstack([np.hstack([np.zeros((3, 3)), np.eye(3)]), lower])
        found.append(float(np.max(np.linalg.eigvals(matrix).real)))
    return found[0], round(found[1], 9)  # the rigid motion's pole is zero up to rounding


def first_pinned(change: float = 0.0) -> tuple[float, float]:
    """Compute the first pinned frequency [Hz] as printed and consistent, with J_m changed [kg m²] (erratum 3)."""
    N, motor = TABLE["N"], TABLE["J_m"] + change
    hubs = (N * motor + TABLE["J_hub"] / N, N**2 * motor + TABLE["J_hub"])
    first, second = (float(fixed_step.pinned(hub).frequencies()[0]) for hub in hubs)
    return first, second


def moment_under_tip_force() -> tuple[float, float]:
    """Compute the moment at 0.55 m per tip force [m] with +0.6 v as printed (section 3.3), and with −0.6 v."""
    v, s = _under_tip_force()
    EI = fixed_step.STIFFNESS
    return EI * (0.6 * v + 1.3 * s), EI * (-0.6 * v + 1.3 * s)


def torque_under_tip_force() -> tuple[float, float]:
    """Compute M_o [Nm] under 1 N at the tip by eq. 4.4 as printed, with EI twice in its first term, and with EI once."""
    v, s = _under_tip_force()
    EI, N = fixed_step.STIFFNESS, TABLE["N"]
    return 6.0 * EI / N * EI * v - 2.0 / N * EI * s, EI / N * (6.0 * v - 2.0 * s)


def gage(made: Run) -> Floats:
    """Compute the second gage by section 3.3 as printed, EI(0.6 v + 1.3 s) [V], from a run's two gages (erratum 4)."""
    per_volt = 1.0 / (fixed_step.GAGE * fixed_step.STIFFNESS)
    root, middle = made.signals["strain_base"] * per_volt, made.strain * per_volt
    # root = 6 v − 2 s, middle = −0.6 v + 1.3 s
    v, s = np.linalg.solve(np.array([[6.0, -2.0], [-0.6, 1.3]]), np.vstack([root, middle]))
    return np.asarray(fixed_step.GAGE * fixed_step.STIFFNESS * (0.6 * v + 1.3 * s))


def rigid_inertia() -> tuple[float, float]:
    """Compute J_a [kg m²] as printed and from the beam's mass (erratum 7)."""
    return TABLE["J_a"], MASS_PER_LENGTH * LENGTH**3 / 3.0 + TABLE["J_hub"]


def mean_motor_constant() -> tuple[float, float]:
    """Compute the mean kφ [Vs/rad] of experiment 1 with R_a as stated, and with R_a implied by column E (erratum 9)."""
    volts, amps, speed = EXPERIMENT_1[:, 0], EXPERIMENT_1[:, 1] / 1000.0, EXPERIMENT_1[:, 5]
    first, second = (float(np.mean((volts - amps * R) / speed)) for R in (RESISTANCE, 1.35))
    return first, second


def _under_tip_force() -> tuple[float, float]:
    """Compute tip deflection [m] and slope [rad] of the clamped beam under 1 N."""
    L, EI = LENGTH, fixed_step.STIFFNESS
    return L**3 / (3.0 * EI), L**2 / (2.0 * EI)


def _first(stiffness: np.ndarray, mass: np.ndarray) -> float:
    return float(np.sqrt(eigh(stiffness, mass, eigvals_only=True)[0]) / PI2)
