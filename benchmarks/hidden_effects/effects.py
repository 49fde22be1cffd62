"""Each hidden effect on the rig: the setting that scales it, its other settings, and their ranges."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

Ranges = Mapping[str, tuple[float, float]]


@dataclass(frozen=True)
class Hidden:
    """One effect of the rig.

    Attributes:
        setting: of the rig that scales the effect.
        strongest: largest plausible value of the setting.
        others: the rig's other settings, each drawn uniformly from its range.
        signed: whether its size may have either sign.
        inverse: whether a smaller setting is a stronger effect.
        of_peak: whether sizes are shares of the largest command without the effect.
    """

    setting: str
    strongest: float
    others: Ranges = field(default_factory=dict)
    signed: bool = False
    inverse: bool = False
    of_peak: bool = False


PHASE = (-math.pi, math.pi)

#: Effects of the catalogue, without those of the model (viscous, coulomb, stiction) and one without a size (higher_modes).
CATALOGUE = {
    "stribeck": Hidden("stribeck", 0.6, {"vs": (0.08, 0.4)}),
    "asymmetric_coulomb": Hidden("asym", 0.18, signed=True),
    "asymmetric_viscous": Hidden("asymv", 0.2, signed=True),
    "position_friction": Hidden("posf", 0.18, {"posn": (1.5, 6.0), "posphi": PHASE}),
    "friction_warmup": Hidden("warm", 0.9, {"warm_tau": (1.5, 8.0)}),
    "load_friction": Hidden("loadf", 0.6),
    "presliding": Hidden("dahl", 8.0, inverse=True),
    "constant_torque": Hidden("bias", 0.3, signed=True),
    "cable_stiffness": Hidden("cable", 2.0, {"cable0": (-0.3, 0.3)}),
    "base_tilt": Hidden("tilt", 0.5, {"tilt_dir": PHASE}),
    "cogging": Hidden("cog", 0.2, {"cogn": (4.0, 12.0), "cogphi": PHASE}),
    "backlash": Hidden("gap", 0.4, {"gap_at": (0.2, 0.8)}),
    "gear_compliance": Hidden("gearc", 15.0, inverse=True),
    "beam_damping": Hidden("beam_damp", 0.02),
    "air_drag": Hidden("drag", 2.0),
    "root_compliance": Hidden("root", 0.05),
    "payload": Hidden("payload", 0.5),
    "tip_inertia": Hidden("tip_inertia", 0.05),
    "current_lag": Hidden("lag", 0.2),
    "input_delay": Hidden("delay", 0.1),
    "dead_zone": Hidden("dead", 0.5),
    "saturation": Hidden("sat", 0.1, inverse=True, of_peak=True),
    "rate_limit": Hidden("rate", 4.0, inverse=True),
    "brush_drop": Hidden("brush", 0.7),
    "tach_filter": Hidden("tachlag", 0.3),
    "tach_ripple": Hidden("trip", 0.6, {"trip_phi": PHASE}),
    "strain_drift": Hidden("sdrift", 0.2, signed=True),
    "strain_lag": Hidden("slag", 0.2),
    "pot_nonlinearity": Hidden("potnl", 0.3, {"potn": (1.0, 4.0)}, signed=True),
    "sensor_offset": Hidden("off_mid", 0.5, signed=True),
    "time_offset": Hidden("late", 0.06),
}

#: Effects outside the catalogue.
OUTSIDE = {
    "hum": Hidden("hum", 0.5, {"humf": (3.0, 9.0), "humphi": PHASE}),
    "fixture": Hidden("fix_j", 0.01, {"fix_f": (9.0, 18.0)}, inverse=True),
    "torque_ripple": Hidden("torque_ripple", 0.9, {"torque_ripple_n": (7.0, 15.0)}),
    "detent": Hidden("detent", 0.3, {"detent_period": (2.0, 5.0)}),
    "crosstalk": Hidden("crosstalk", 0.3, signed=True),
    "stiff_drift": Hidden("stiff_drift", 0.04, signed=True),
    "temp_step": Hidden("temp_step", 0.9, signed=True),
    "amp_hysteresis": Hidden("amp_hyst", 1.5),
    "sticky_spot": Hidden("spot", 1.0, {"spot_at": (-0.5, 0.5)}),
    "gage_creep": Hidden("creep", 0.6),
}

#: Constants of the rig that are wrong in the model; static and sliding friction of a body by one factor.
CONSTANTS = (("kphi",), ("jm",), ("jh",), ("bm",), ("bs",), ("tmf", "tms"), ("taf", "tas"), ("ei",), ("density",), ("ksg",))
