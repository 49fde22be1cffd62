"""The thesis's method: fixed steps with stick or slip decided at each (section 3.4, "a step size of 1e-9, using C code").

It has two uses. Row T19 measures its time and its error against the product's exact motion. It also runs the thesis's clamped
model (eqs. 3.26 to 3.31), which no arm file can represent: the beam's moment acts on the hub, but not the beam's inertia.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.thesis.constants import LENGTH, MASS_PER_LENGTH, MODULUS, SECOND_MOMENT, TABLE
from flexarm_env.thesis.kernels import Beam, LawArrays, march
from flexarm_env.thesis.law import Law

Floats = NDArray[np.float64]

STIFFNESS = MODULUS * SECOND_MOMENT  # EI [Nm²]


@dataclass(frozen=True, eq=False)
class Model:
    """M q̈ + B q̇ + K q = [τ − T_f, 0, 0] with q = [hub angle, deflection, slope], arm side.

    Attributes:
        mass: (3, 3).
        damping: (3, 3).
        stiffness: (3, 3).
        moment: (3,), M_o [Nm, motor side] per q.
        strain: (3,), the gage at 0.55 m [V] per q.
        coulomb: T_c [Nm].
        static: T_s [Nm].
    """

    mass: Floats
    damping: Floats
    stiffness: Floats
    moment: Floats
    strain: Floats
    coulomb: float
    static: float

    def frequencies(self) -> Floats:
        """Compute the non-zero natural frequencies [Hz], in rising order."""
        squares = np.linalg.eigvals(np.linalg.solve(self.mass, self.stiffness)).real
        return np.sort(np.sqrt(squares[squares > 1e-3])) / (2.0 * np.pi)

    def without_friction(self) -> Model:
        """Remove dry friction from the model."""
        return Model(self.mass, self.damping, self.stiffness, self.moment, self.strain, 0.0, 0.0)


def _rows() -> tuple[Floats, Floats]:
    """Compute M_o [Nm, motor side] and strain [V] per deflection and slope, measured from the hub's line."""
    L, EI = LENGTH, STIFFNESS
    moment = EI / TABLE["N"] * np.array([6.0 / L**2, -2.0 / L])
    x = 0.55
    strain = GAGE * EI * np.array([6.0 / L**2 - 12.0 * x / L**3, -2.0 / L + 6.0 * x / L**2])
    return moment, strain


#: K_SG [V/Nm], thesis section 3.3.
GAGE = 2.27


def pinned(hub: float | None = None) -> Model:
    """Build the consistent pinned model (thesis eq. 3.9 with erratum 3 corrected), in absolute coordinates.

    Args:
        hub: inertia of motor and hub [kg m²]; by default that of Table 2.1.
    """
    L, t = LENGTH, TABLE
    hub = t["N"] ** 2 * t["J_m"] + t["J_hub"] if hub is None else hub
    mass = (
        MASS_PER_LENGTH
        * L
        / 420.0
        * np.array([[4 * L * L, 13 * L, -3 * L * L], [13 * L, 156, -22 * L], [-3 * L * L, -22 * L, 4 * L * L]])
    )
    mass[0, 0] += hub
    stiffness = (
        STIFFNESS / L**3 * np.array([[4 * L * L, -6 * L, 2 * L * L], [-6 * L, 12, -6 * L], [2 * L * L, -6 * L, 4 * L * L]])
    )
    moment, strain = (np.array([-row @ [L, 1.0], *row]) for row in _rows())
    return Model(mass, _damping(), stiffness, moment, strain, *_friction())


def clamped(hub: float) -> Model:
    """Build the thesis's clamped model with a rotating hub (eqs. 3.26 to 3.31), deflection and slope from the hub's line.

    Args:
        hub: N² J [kg m²]. The thesis's J is that of eq. 2.1, which counts the arm twice, since M_o already is its
            reaction.
    """
    L, m = LENGTH, MASS_PER_LENGTH
    mass = np.zeros((3, 3))
    mass[0, 0] = hub
    mass[1:, 0] = [7.0 * m * L**2 / 20.0, -m * L**3 / 20.0]
    mass[1:, 1:] = m * L / 420.0 * np.array([[156.0, -22.0 * L], [-22.0 * L, 4.0 * L**2]])
    moment, strain = (np.array([0.0, *row]) for row in _rows())
    stiffness = np.zeros((3, 3))
    stiffness[1:, 1:] = STIFFNESS / L**3 * np.array([[12.0, -6.0 * L], [-6.0 * L, 4.0 * L**2]])
    stiffness[0] = -TABLE["N"] * moment
    return Model(mass, _damping(), stiffness, moment, strain, *_friction())


def _damping() -> Floats:
    damping = np.zeros((3, 3))
    damping[0, 0] = TABLE["N"] ** 2 * TABLE["b_m"] + TABLE["b_s"]
    return damping


def _friction() -> tuple[float, float]:
    t = TABLE
    return t["N"] * t["T_mf"] + t["T_af"], t["N"] * t["T_ms"] + t["T_as"]


def simulate(model: Model, law: Law, duration: float, step: float, every: float) -> Floats:
    """Integrate from rest at angle 0 by a fixed step.

    Args:
        model: to integrate.
        law: of the current.
        duration: [s].
        step: [s].
        every: from one sample to the next [s].

    Returns:
        (samples, 5): hub angle [rad], motor speed [rad/s], strain [V], current [A], whether the hub is stuck.
    """
    samples, stride = round(duration / every), round(every / step)
    clamped = np.zeros((3, 3))
    clamped[1:, 1:] = np.linalg.inv(model.mass[1:, 1:])
    beam = Beam(
        np.linalg.inv(model.mass), clamped, model.mass[0].copy(), model.damping, model.stiffness, model.moment, model.strain
    )
    friction = np.array([TABLE["N"], TABLE["kphi"], model.coulomb, model.static])
    out = np.zeros((samples, 5))
    march(beam, friction, LawArrays(*law.packed(step)), step, stride, out)
    return out
