"""The thesis's models as arms: each is the shipped arm with effects removed, added or changed."""

from __future__ import annotations

import functools
from dataclasses import replace

from flexarm_env.arm import Arm
from flexarm_env.thesis.constants import TABLE


@functools.cache
def combined() -> Arm:
    """Build the combined model of thesis section 3.4: pinned while it slips, clamped while friction holds the hub.

    One element, no sensor noise, and the base gage at the root, where it measures M_o of eq. 4.4 (erratum 5 corrected).
    """
    arm = Arm.load("thesis")
    quiet = {path: 0.0 for signal in arm.sensors for path in (f"sensors.{signal}.noise", f"sensors.{signal}.resolution")}
    return arm.with_values({**quiet, "sensors.strain_base.position": 0.0})


@functools.cache
def unlimited() -> Arm:
    """Build the combined model without a limit of current (thesis Figs. 4.4 and 4.14)."""
    return combined().with_values({"drive.limit": 0.0})


@functools.cache
def coulomb_only() -> Arm:
    """Build the pinned beam with Coulomb friction and no static friction above it (thesis Fig. 3.5)."""
    return combined().without_effect("stiction")


@functools.cache
def pinned_only() -> Arm:
    """Build the pinned beam without dry friction (thesis section 4.2); viscous friction stays."""
    return coulomb_only().without_effect("coulomb")


def lighter_motor(arm: Arm, change: float) -> Arm:
    """Change the arm's motor inertia [kg m²] (thesis Fig. 3.6)."""
    return arm.with_values({"drive.motor_inertia": arm.value("drive.motor_inertia") + change})


def damped_beam(torque_per_rate: float = 0.003) -> Arm:
    """Build the combined model with damping in the beam (thesis Fig. 3.9).

    The thesis does not state the location of its 0.003 Nms. Here they damp bending: a beam of stiffness EI/L [Nm/rad] and
    damping 0.003 Nms/rad has the Kelvin-Voigt time 0.003 L/EI.

    Args:
        torque_per_rate: damping [Nms].
    """
    arm = combined()
    time = torque_per_rate * arm.value("beam.length") / arm.value("beam.bending_stiffness")
    return arm.with_effect("beam_damping", time=time)


def loaded(mass: float = 0.3) -> Arm:
    """Build the combined model with a payload [kg] (thesis Fig. 3.10)."""
    return combined().with_effect("payload", mass=mass)


def rigid(inertia: float | None = None, gap: float = 0.0) -> Arm:
    """Build the rigid model of chapter 2 (eqs. 2.1 to 2.14).

    Args:
        inertia: J_a of arm and hub [kg m²]; by default that of the beam, m L³/3, plus the hub, 10 % below the 0.158 of
            Table 2.1 (erratum 7).
        gap: backlash Δθ [rad, motor side].
    """
    arm = combined()
    inertia = beam_inertia(arm) + arm.value("hub.inertia") if inertia is None else inertia
    constants = {"drive": arm.constants["drive"], "hub": {"inertia": inertia}}
    sensors = {signal: arm.sensors[signal] for signal in ("arm_angle", "motor_speed")}
    made = replace(arm, name="rigid", constants=constants, sensors=sensors)
    return made.with_effect("backlash", gap=gap) if gap else made


def beam_inertia(arm: Arm) -> float:
    """Compute the inertia of the beam about the hub's axis, m L³/3 [kg m²]."""
    return arm.value("beam.mass_per_length") * arm.value("beam.length") ** 3 / 3.0


def motor_alone(inertia: float = TABLE["J_m"], viscous: float = 0.0011, coulomb: float = 0.11) -> Arm:
    """Build motor and shaft without the arm (thesis Appendix A, experiments 2 and 3), as a rigid arm at gear ratio 1.

    Args:
        inertia: J [kg m²].
        viscous: b [Nms].
        coulomb: T_f [Nm].
    """
    arm = rigid(0.0)
    drive = {**arm.constants["drive"], "gear_ratio": 1.0, "motor_inertia": inertia}
    effects = {"viscous": {"coefficient": viscous}, "coulomb": {"torque": coulomb}}
    return replace(arm, name="motor", constants={**arm.constants, "drive": drive}, effects=effects)


def stand_in() -> Arm:
    """Build the stand-in for the thesis's rig: six elements, motor and hub as two bodies, noisy sensors.

    The rig's recordings were not printed as numbers. This arm is a finer model, not a measurement.
    """
    return Arm.load("thesis-fem")
