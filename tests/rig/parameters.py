"""The kernel's numbers as numpy records, which numba reads by name."""

from __future__ import annotations

import numpy as np

#: drive, transmission, hub and beam: arm-side SI units; what each is stands in the table of settings
PAR = """
    sub delay_steps h gear kphi jm jr bm bs tmf tms taf tas mesh_k mesh_c gap_low gap_high stribeck
    vs asym asymv posf posn posphi warm warm_tau loadf dahl bias cable cable0 tilt_torque tilt_dir
    cog cogn cogphi drag lag dead sat rate brush backemf ra hum humf humphi fix_w2 fix_c fix_j
    torque_ripple torque_ripple_n detent detent_n detent_period stiff_drift temp_step temp_time
    amp_hyst spot spot_at spot_width joined volts stop stop_at sag split jk servo
""".split()  # noqa: SIM905

#: sensors: gains, faults and the converters' steps
SENSE = """
    late_samples late_steps ksg ksg_base tachlag slag trip trip_phi sdrift potnl potn off_angle
    off_speed off_mid off_base off_tip crosstalk creep creep_tau step_angle step_speed step_strain step_tip
""".split()  # noqa: SIM905

COUNTS = ("sub", "delay_steps", "late_samples", "late_steps")

#: one clamped mode: ω² [rad²/s²], damping [1/s], ∫ x φ dm [kg^½ m], load of a tilted base per sine of the hub angle
#: [N kg^-½], moments at the gages [Nm kg^-½ m^-1] and deflection of the tip [kg^-½] per modal coordinate
MODE = np.dtype([(name, float) for name in ("omega2", "damp", "coupling", "gravity", "bend_mid", "bend_base", "tip")])

#: one node of the beam: place and the length that it stands for [m]
NODE = np.dtype([("x", float), ("weight", float)])


def record(names: list[str], values: dict[str, float]) -> np.void:
    """Return the record of `names` with their `values`; steps and samples are integers."""
    made = np.zeros((), np.dtype([(name, np.int64 if name in COUNTS else float) for name in names]))
    for name in names:
        made[name] = values[name]
    return made[()]
