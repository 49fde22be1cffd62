"""The effects of the benchmark that no catalogue holds."""

from __future__ import annotations

from benchmarks.machines.effects import Hidden, detailed, plain
from benchmarks.machines.scales import (
    PHASE,
    coulomb,
    limit,
    motor_cycles,
    of_torque,
    rotary,
    strain,
)

OUTSIDE: dict[str, Hidden] = {
    "hum": detailed("hum", "", of_torque(0.2), lambda m: {"humf": (3.0, 9.0), "humphi": PHASE}),
    "torque_ripple": detailed(
        "torque_ripple", "", lambda m: 0.8, lambda m: {"torque_ripple_n": motor_cycles(m, 4.0, 24.0)}, possible=rotary
    ),
    "detent": Hidden(
        of_torque(0.15),
        lambda m, size, details: {"detent": size / m.values["drive.gear_ratio"], **details},
        lambda m: {"detent_n": motor_cycles(m, 4.0, 12.0), "detent_period": (2.0, 5.0)},
        possible=rotary,
    ),
    "crosstalk": plain(
        "crosstalk",
        "",
        lambda m: 0.3 * strain(m) / (m.speed * m.values["drive.gear_ratio"]),
        signed=True,
        possible=lambda m: m.arm.has("strain"),
        sensor=True,
    ),
    "gage_creep": detailed(
        "creep", "", lambda m: 0.6, lambda m: {"creep_tau": (1.0, 3.0)}, possible=lambda m: m.arm.has("strain"), sensor=True
    ),
    "stiff_drift": plain("stiff_drift", "", lambda m: 0.04, signed=True, possible=lambda m: m.clamped > 0.0),
    "temp_step": detailed(
        "temp_step", "", lambda m: 0.8, lambda m: {"temp_time": (2.0, 4.0)}, signed=True, possible=lambda m: coulomb(m) > 0.0
    ),
    "amp_hysteresis": plain("amp_hyst", "", lambda m: 0.4 * limit(m)),
    "sticky_spot": detailed(
        "spot",
        "",
        of_torque(0.3),
        lambda m: {"spot_at": (-0.5 * m.angle, 0.5 * m.angle), "spot_width": (0.04 * m.angle, 0.1 * m.angle)},
    ),
    "motor_saturation": plain(
        "sag", "", lambda m: 0.6 * (m.values["drive.gear_ratio"] * m.values["drive.torque_constant"] / m.torque) ** 2
    ),
}
