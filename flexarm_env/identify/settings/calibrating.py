"""Calibrations: values that are moved, least squares, passes, last steps and intervals."""

from __future__ import annotations

from dataclasses import dataclass

from flexarm_env.identify.settings.number import tuned

#: Origins of several numbers.
BROYDEN = "with Broyden's correction: one diagnosis of three runs took 46 s of one core, before 71; no sweep recorded"
SCALES_OF_NULLS = "torque constants of null-21, null-38 and null-45 of seed 4 were 10, 5 and 11 % off, then 3, 1 and 3 %"
INERTIAS_OF_NULLS = (
    "motor inertias of null-38, null-45 and null-58 were 10, 11 and 15 % off, then 3, 0 and 10 %; no sweep recorded"
)


@dataclass(frozen=True)
class Parameters:
    """Scales, priors and difference steps of the values that a calibration moves."""

    widest: float = tuned(
        30.0, "Prior of an unbounded value, in typical sizes, so that a direction without information stays put."
    )
    positive: float = tuned(3.0, "Prior of the logarithm of a value without a null, such as a time.")
    least_step_constant: float = tuned(1e-3, "Narrowest difference of a constant's logarithm.")
    least_step_effect: float = tuned(
        1e-2,
        "Narrowest difference of an effect's value, over its size.",
        "stick-slip makes smaller differences of an effect look like noise; no sweep recorded",
    )
    smallest_size: float = tuned(
        1e-4,
        "Size of an effect below which the narrowest difference shrinks no further, in typical sizes.",
        "friction of 2e-5 of the typical one was lost behind differences of 3e-3 of it; no sweep recorded",
    )
    least_size: float = tuned(0.3, "Size of an effect below which the widest difference shrinks no further, in typical sizes.")
    widest_step: float = tuned(0.3, "Widest difference, over a constant's prior or an effect's size.")


@dataclass(frozen=True)
class LeastSquares:
    """Levenberg–Marquardt with differences as wide as the model is off."""

    first_damping: float = tuned(1e-3, "Damping at the start.", "customary (Marquardt, J. SIAM 11 (1963) 431)")
    less_damping: float = tuned(0.2, "Factor of the damping after a step that helps.")
    least_damping: float = tuned(1e-7, "Smallest damping.")
    more_damping: float = tuned(10.0, "Factor of the damping after a step that fails.", "customary (Marquardt 1963)")
    least_helpful: float = tuned(1e-3, "Damping below which a step is that of Gauss and Newton.", BROYDEN)
    largest_step: float = tuned(3.0, "Largest change of a scaled value in a step.")
    steps: int = tuned(4, "Steps along one Jacobian, which each corrects for the next.", BROYDEN)
    worthwhile: float = tuned(0.01, "Relative decrease of the cost below which a Jacobian is computed anew.", BROYDEN)
    trials: int = tuned(5, "Dampings that the first step along a Jacobian tries.", BROYDEN)
    shrinks: float = tuned(0.7, "Differences that shrank by less than this factor give the same Jacobian again.")
    narrow: float = tuned(
        8.0,
        "Factor by which differences are narrower in the last pass.",
        "EMPS: over wider differences, curvature bent its friction by 1.2 %",
    )
    fine: float = tuned(
        10.0,
        "Factor by which differences are finer where a calibration ends off the noise, though not far off.",
        "a payload beside a vibration of 45 Hz over 7 s: slopes over 1e-3 of the stiffness were 70 % off, over 1e-4 not",
    )
    largest_residual: float = tuned(1e4, "Largest residual, in standard deviations: one bad moment must not rule a fit.")


@dataclass(frozen=True)
class Calibrating:
    """Passes of a calibration, and when it is restarted."""

    iterations: int = tuned(6, "Jacobians at each level of process noise.")
    passes: int = tuned(
        3,
        "Passes at the arm's own torque noise: the first weighs by errors that it then removes, the last is narrow.",
        "two until the narrow one was added for EMPS, whose friction wide differences bent by 1.2 %",
    )
    tolerance: float = tuned(1e-2, "Relative decrease of the cost at which a level is left.", BROYDEN)
    final_tolerance: float = tuned(1e-4, "Relative decrease of the cost at which the last pass ends.", BROYDEN)
    last_iterations: int = tuned(
        2, "Jacobians when only the held-out part is new.", "a diagnosis did less twice; no sweep recorded"
    )
    brief_iterations: int = tuned(2, "Jacobians of a brief calibration.")
    continuations: int = tuned(
        4,
        "How often a calibration that stays far off is continued.",
        "one run of CU Boulder's arm ended 6 % off, by rounding; no sweep recorded",
    )
    scan_step: float = tuned(
        0.05,
        "Step at which a constant on which the fitted part hardly depends is scanned, in its prior's standard deviations.",
        "of a rigid axis that sticks once, late, the static friction within 4 % meets the rest, and its prior is 50 % wide",
    )
    weak: float = tuned(
        0.5,
        "Share of its prior by which such a constant changes the fitted part by less than the noise, along its slope.",
        "static friction that is a step: 0 to 0.5 of the noise, the next weakest constant of those axes 1.1",
    )
    memory: float = tuned(
        0.02,
        "Time over which the errors of a model that is far off are correlated.",
        "cu-flexible: searches strayed to a hub fifty times too heavy; no sweep recorded",
        "s",
    )


@dataclass(frozen=True)
class Refining:
    """Final Gauss–Newton steps along weakly observable directions, and the common scale of forces."""

    difference: float = tuned(1e-5, "Step of the differences.", INERTIAS_OF_NULLS)
    iterations: int = tuned(5, "Jacobians at each level at most.", "no sweep recorded")
    least_decrease: float = tuned(
        1.0,
        "Decrease of the cost along a Jacobian below which no other is computed.",
        "that of chance: twelve fits from wrong constants end 2 to 19 below the truth; at a hundredth of the cost up to 4 above",
    )
    least_promise: float = tuned(
        0.1,
        "Decrease of the cost that a step must promise.",
        "a value then ends within 0.3 of its standard deviation",
    )
    kept: float = tuned(
        0.5, "Share of its promise that a step must keep, or it is the last of its level.", "half way; no sweep recorded"
    )
    dampings: tuple[float, ...] = tuned(
        (0.0, 1e1, 1e2, 1e3, 1e4), "Dampings tried in turn, over the priors' weight.", INERTIAS_OF_NULLS
    )
    aside: float = tuned(
        0.3,
        "Distance to either side at which other minima are sought, in priors' standard deviations.",
        "26 null machines of seeds 2 and 3 then ended at 0.994 to 1.005 times the noise, before at 1.004 to 1.05",
    )
    alike: float = tuned(
        1.01,
        "Error over the least one's up to which another minimum shows how far values scatter.",
        "19 null machines of seed 982130: 1.01 to 1.05 give the same, 1.005 less; steps that end early lie beyond",
    )
    scale_step: float = tuned(0.02, "Step of the logarithm of the common scale.", SCALES_OF_NULLS)
    scale_furthest: float = tuned(0.5, "Furthest that the logarithm of the common scale moves at once.", SCALES_OF_NULLS)


@dataclass(frozen=True)
class ForecastFit:
    """Gauss–Newton steps on forecasts."""

    iterations: int = tuned(20, "Most steps.")
    brief_iterations: int = tuned(6, "Most steps of a candidate.", "no sweep recorded")
    settled: float = tuned(1e-4, "Gain per sample, in log density, that a step makes unless it is idle.")
    settled_share: float = tuned(0.02, "And share of what is left, since a model that lacks an effect need not be exact.")
    cooling: float = tuned(
        4.0, "Factor by which process noise may fall in a step, so that values settle before errors grow rough."
    )


@dataclass(frozen=True)
class Intervals:
    """How 90 % intervals are made."""

    quantile: float = tuned(1.6449, "Two-sided 90 % quantile of the normal distribution.", "the normal distribution")
    best_model: float = tuned(
        0.0005,
        "Relative standard deviation that no value beats: no model is more exact.",
        "practice p06: a lag of 20 ms is 0.07 % off, and scatter alone gives 0.025 %",
    )
    wrong_model: float = tuned(0.005, "Relative standard deviation of a value of a model that explains little of the errors.")
    block: float = tuned(0.25, "Length of the blocks over which residuals may be correlated.", unit="s")
