"""Numbers printed in the thesis: Tables 2.1 and A.1, and the measurements of Appendix A."""

from __future__ import annotations

import numpy as np

#: Tables 2.1 and A.1, each on the thesis's side of the gears: kg m², Nm, Nms, rad.
TABLE = {
    "N": 1.5,
    "J_m": 0.00193,
    "J_hub": 0.00129,
    "J_a": 0.158,
    "T_mf": 0.066,
    "T_ms": 0.09487,
    "T_af": 0.183,
    "T_as": 0.21574,
    "b_m": 0.0008,
    "b_s": 0.1,
    "gap": 0.01164,
    "kphi": 0.33,
}
#: Section 3.4: modulus [Pa], second moment [m⁴], mass per length [kg/m]; the length [m] follows from section 3.3.
MODULUS, SECOND_MOMENT, MASS_PER_LENGTH, LENGTH = 68.944e9, 1.1475e-10, 0.42381, 1.0
#: Section 3.4, Fig. 3.6: change of J_m [kg m²].
INERTIA_CHANGE = 0.0003
#: Section 4.1: delays [s] of the clamped and of the pinned model.
CLAMPED_DELAY, PINNED_DELAY = 0.074, 0.026
#: Frequencies [Hz] that the thesis states: rig moving and stuck (section 3), beam without hub inertia.
RIG_MOVING, RIG_STUCK, BEAM_PINNED, BEAM_CLAMPED = 10.0, 2.0, 10.6, 2.4

#: Experiment 1: V_a [V], I_a [mA], tacho [V], arm speed [rpm], E [V], motor speed [rad/s], kφ [Vs/rad].
EXPERIMENT_1 = np.array(
    [
        [5.431, 384.2, 1.343, 93.7, 4.912, 14.71, 0.3339],
        [6.464, 397.5, 1.630, 113.8, 5.927, 17.87, 0.3317],
        [7.499, 411.4, 1.917, 133.5, 6.944, 20.97, 0.3311],
        [8.488, 424.8, 2.189, 152.5, 7.915, 23.95, 0.3305],
        [9.492, 429.0, 2.461, 171.2, 8.913, 26.89, 0.3315],
        [10.498, 443.4, 2.743, 190.8, 9.899, 29.97, 0.3303],
        [11.503, 453.2, 3.023, 210.3, 10.891, 33.03, 0.3297],
        [12.489, 466.8, 3.298, 229.3, 11.859, 36.01, 0.3293],
    ]
)
#: Armature resistance that the thesis states [ohm], and its tachometer [V per rpm].
RESISTANCE, TACHOMETER = 1.23, 9.5 / 1000.0
#: Experiment 2: V_a [V], I_a [mA], tacho [V], E_a [V], P [W], motor speed [rad/s], P/ω [Nm].
EXPERIMENT_2 = np.array(
    [
        [5.016, 375, 1.208, 4.555, 1.708, 13.3122, 0.1283],
        [6.000, 385, 1.493, 5.526, 2.128, 16.4529, 0.1293],
        [7.009, 415, 1.767, 6.499, 2.697, 19.4723, 0.1385],
        [8.028, 424, 2.055, 7.506, 3.183, 22.6461, 0.1406],
        [8.997, 433, 2.323, 8.464, 3.665, 25.5995, 0.1432],
        [10.000, 442, 2.601, 9.456, 4.180, 28.6630, 0.1458],
        [10.99, 453, 2.887, 10.433, 4.726, 31.8147, 0.1485],
        [12.077, 464, 3.181, 11.506, 5.339, 35.0546, 0.1523],
        [12.995, 477, 3.440, 12.408, 5.919, 37.9088, 0.1561],
        [13.011, 479, 3.445, 12.422, 5.950, 37.9639, 0.1567],
        [13.997, 483, 3.725, 13.403, 6.474, 41.0495, 0.1577],
        [15.008, 492, 4.012, 14.403, 7.086, 44.2122, 0.1603],
    ]
)
#: Experiment 3: initial speed [rad/s], time to stop [s], initial slope [rad/s²], J from slope, T_f after it, J from t_c.
EXPERIMENT_3 = np.array(
    [
        [55.87, 0.714, -96.55, 0.0006365, 0.02524, 0.001770],
        [48.30, 0.625, -91.97, 0.0005776, 0.02322, 0.001745],
        [40.82, 0.575, -86.15, 0.0005212, 0.01898, 0.001848],
    ]
)
#: Results of experiments 2 and 3: b [Nms], T_f [Nm]. Experiments 4 and 5: b, T_f, static motor, static whole.
MOTOR_VISCOUS, MOTOR_COULOMB = 0.0011, 0.11
WHOLE_VISCOUS, WHOLE_COULOMB, STATIC_MOTOR, STATIC_WHOLE = 0.0452, 0.188, 0.09487, 0.2387
