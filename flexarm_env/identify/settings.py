"""Every tuned number of the method: its value, its meaning, and how it was found.

One frozen dataclass per stage; `Settings` holds them all. Results carry the settings under which they were made, and
`flexarm diagnose --settings` prints them. Errors are rms over the noise, so that 1 is perfect; an excess is a variance over that
of the noise, less 1.

In the origins of values, seeds and cases such as `null-38` are those of the benchmark of hidden effects, and EMPS, `thesis` and
`cu-flexible` are shipped arms. "No sweep recorded" means that the value was tried on the cases named, and no other is on record.
"""

from __future__ import annotations

import dataclasses
import hashlib
import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

UNKNOWN = "not known"
#: Origin of numbers of the inspection that were not swept.
SLOWLY = "no false alarm on 60 sets of seed 31 thinned to 20, 50 and 100 Hz, where 42, 38 and 1 had one before"
UNHARMED = "no false alarm on 134 sets of sound recordings, 120 of them of seed 31; no sweep recorded"
#: Error over noise of a reading that is not finite: any large finite number.
FAILED_ERROR = 1e6
#: Smallest excess of an error and smallest command [A or V], so that ratios to them stay finite.
LEAST_EXCESS = LEAST_COMMAND = 1e-9
#: Largest logarithm of a value over its origin, so that the exponential stays finite.
LARGEST_LOG = 20.0
#: Smallest frequency [Hz] that divides: of an arm that does not vibrate.
LEAST_FREQUENCY = 1e-9
#: Weight of a group of lead times without readings.
LEAST_COUNT = 1e-9
#: Smallest norm that divides.
LEAST_NORM = 1e-300


def tuned(value: Any, meaning: str, found: str = UNKNOWN, unit: str = "") -> Any:
    """Declare a number of the method.

    Args:
        value: a number, or a tuple of numbers.
        meaning: a sentence for a person.
        found: how the value was found: a paper, a sweep, the seeds of the benchmark; `UNKNOWN` where nobody wrote it down.
        unit: SI unit; "" for a ratio or a count.
    """
    return field(default=value, metadata={"meaning": meaning, "found": found, "unit": unit})


@dataclass(frozen=True)
class Number:
    """One tuned number, for tables.

    Attributes:
        stage: the field of `Settings` that holds it.
        name: within the stage.
        value: a number, or a tuple of numbers.
        unit: SI unit; "" for a ratio or a count.
        meaning: a sentence.
        found: how it was found.
    """

    stage: str
    name: str
    value: Any
    unit: str
    meaning: str
    found: str


@dataclass(frozen=True)
class ErrorScale:
    """Rungs of one ladder: the error of a model over the noise."""

    converged: float = tuned(
        1.002,
        "A calibration that ends below this is not continued.",
        "26 null machines of seeds 2 and 3 then ended at 0.994 to 1.005 times the noise, before at 1.004 to 1.05",
    )
    at_noise: float = tuned(
        1.01,
        "Rivals of an accepted effect are tried where the error is above this.",
        "with the exchange of confused effects, for misses of seed 4; no sweep recorded",
    )
    calibrated: float = tuned(
        1.02,
        "A calibration that ends below this is not restarted from the nominal constants.",
        "lowered from 1.1 for position_friction-3, stribeck-payload and asymmetric_viscous-backlash of seed 5, then within 1.05",
    )
    near: float = tuned(
        1.03,
        "Above this a calibration that ends close to the noise is continued twice.",
        "with the second continuation, for play between gears, whose error is rough; no sweep recorded",
    )
    nothing_left: float = tuned(
        1.1,
        "A held-out error below this leaves nothing to explain.",
        "raised from 1.08 before the benchmark existed, reason not known; it leaves some effects of strength 1 unfound",
    )
    explained: float = tuned(
        1.2,
        "A held-out error in windows below this is explained, whatever share was removed.",
        "seed 5: right answers ended at 1.165 or below, effects outside the catalogue that were mislabelled at 1.3 to 2.5; above "
        "it effects are named `partly`: of the answers `effects` of seeds 4, 5, 6 and 8, 4 of 602 right ones and 9 of 27 wrong "
        "ones end above it",
    )
    close: float = tuned(
        1.4,
        "A model below this is close to the noise: rivals are ordered by BIC, and calibrations refined.",
        "seven pairs of seeds 1 to 3, all right with it: windows alone took a constant torque for a tilted base",
    )
    free_run_explained: float = tuned(
        1.5,
        "A held-out error of the free run below this is explained.",
        "a weak saturation of seeds 1 to 3, lost without it, ended at 1.46",
    )
    far_off: float = tuned(
        3.0,
        "A model above this is far off: something is missing.",
        "first value not known; kept, since the models of CU Boulder's real arms end above it",
    )


@dataclass(frozen=True)
class Preparation:
    """How recordings are prepared, split and checked before anything is calibrated."""

    held_out_share: float = tuned(0.35, "Share of each recording, at its end, that no calibration sees.")
    default_noise: float = tuned(
        2e-3,
        "Noise of a signal that states none and shows none, over the signal's range.",
        "first value not known; since noise is estimated, only for signals too short or too still for that",
    )
    least_noise_share: float = tuned(
        1e-6,
        "Estimated noise is at least this share of the signal's range.",
        "one step of a converter of 20 bits, finer than those of laboratories: simulated signals without noise end here",
    )
    least_noise: float = tuned(1e-12, "Noise of a constant signal without stated noise.", "guards a division", "SI")
    noise_disagrees: float = tuned(
        2.0,
        "Ratio of estimated to stated noise, or its reverse, that is worth a note.",
        "estimates on simulated arms lie within 15 %; none of the practice recordings and simulated arms reaches it",
    )
    motion_adds: float = tuned(
        1.5,
        "Ratio of the noise at rest and in motion at which a note gives both.",
        "on simulated arms at 100 Hz, whose noise is the same in both, starts and stops alone make up to 1.5",
    )
    uneven: float = tuned(1e-3, "Sampling counts as uneven where a step differs from the median by more than this share.")
    window: float = tuned(1.0, "Length of the windows in which errors are measured.", "chosen for the public definition", "s")
    least_window_samples: int = tuned(10, "Shortest window.", unit="samples")
    fewest_samples: int = tuned(50, "Shortest recording.", unit="samples")
    shortest: float = tuned(1.0, "Recordings that are shorter together are insufficient.", unit="s")
    least_motion: float = tuned(8.0, "Motion below this multiple of a signal's noise is insufficient.")
    at_limit: float = tuned(0.999, "Share of the largest command at which a command counts as at its limit.")
    much_at_limit: float = tuned(0.3, "Share of samples at the limit that is worth a note.")
    fewest_levels: int = tuned(4, "A command with no more levels than this is a square wave, not a saturated one.")
    settling: float = tuned(
        0.05,
        "Where torque noise is stated, calibrations ignore errors before this time: they show an uncertain start.",
        "EMPS: the unknown start moved a Coulomb friction by 2 %; the published recipe drops 49 ms (Janot, Gautier, Brunot 2019)",
        "s",
    )
    longest_lag: float = tuned(0.05, "Longest lag of a recorded command behind its control law that is tried.", unit="s")
    largest_law_error: float = tuned(
        0.25,
        "A control law that misses the recorded command by more than this share at any lag is not that of the recording.",
        "laws of EMPS and CU Boulder miss by 0.002 to 0.15; CU Boulder's with another recording's gains, 8 for 6, by 0.33",
    )
    late_least_shown: float = tuned(
        0.05,
        "Less is held out where the fitted part shows less than this share of the excess.",
        "limits that act once, late, after misses of saturation in seed 5; no sweep recorded",
    )
    late_least_held_out: float = tuned(
        0.1,
        "Share of a recording's time and samples that stays held out.",
        "limits that act once, late, after misses of saturation in seed 5; no sweep recorded",
    )


@dataclass(frozen=True)
class Thinning:
    """Samples that are left out of recordings whose rate is far above what the arm needs."""

    longest_step: float = tuned(
        0.004,
        "Longest step of thinned recordings.",
        "two thirds of the smallest typical delay in the catalogue (6 ms: input_delay, time_offset); lags are typically 10 ms",
        "s",
    )
    share_of_lag: float = tuned(
        0.5,
        "Longest step over the shortest time constant of the arm's sensors and drive.",
        "two samples in each time constant, as for the longest step and typical lags of 10 ms",
    )
    share_of_period: float = tuned(
        0.05,
        "Longest step over the period of the fastest of the `slowest` vibrations.",
        "20 samples in a period; keeps the 500 Hz of the arms `thesis` (29.6 Hz) and `thesis-fem` (20.2 Hz)",
    )
    slowest: int = tuned(
        2,
        "Slowest vibrations of the free and of the held hub that count.",
        "recordings of the thesis's arms show two by far above the noise; of faster ones, the response to the command counts",
    )
    command_error: float = tuned(
        0.2,
        "Error that the mean command makes in a signal, rms over its noise in windows, that is left.",
        "raises an error of 1 to 1.02, a fifth of what counts as nothing left (`errors.nothing_left`)",
    )
    fewest_samples: int = tuned(
        500, "Fewest samples that a thinned recording keeps.", "two seconds at the longest step; no sweep recorded", "samples"
    )


@dataclass(frozen=True)
class ReferenceSizes:
    """Quantities in recordings of the thesis's arm, for which typical sizes of effects are given."""

    torque: float = tuned(0.35, "Rms torque of the drive.", "recordings of the arm `thesis`", "N*m")
    angle: float = tuned(2.5, "Range of the hub's angle.", "recordings of the arm `thesis`", "rad")
    speed: float = tuned(0.8, "Range of the angle over the root of the time.", "recordings of the arm `thesis`", "rad/s**0.5")
    command: float = tuned(5.0, "Largest command.", "recordings of the arm `thesis`", "A")
    inertia: float = tuned(0.147, "Inertia at the hub, motor included.", "arm `thesis`, Table A.1", "kg*m**2")
    least_ratio: float = tuned(1e-9, "Smallest ratio of a size to its reference.", "guards a division")
    least_speed: float = tuned(1e-12, "Smallest speed scale of recordings.", "guards a division", "rad/s**0.5")


@dataclass(frozen=True)
class InitialStates:
    """How the state at the start of a recording is estimated."""

    still: float = tuned(
        10.0,
        "A hub within this multiple of the noise of its first angle is still.",
        "with the fit of the start: simulated runs cut while driven, moving and vibrating, and cu-flexible; no sweep recorded",
    )
    held_time: float = tuned(
        0.1,
        "A hub that is still for this long counts as held.",
        "with the fit of the start: simulated runs cut while driven, moving and vibrating, and cu-flexible; no sweep recorded",
        "s",
    )
    vibrates: float = tuned(
        2.0,
        "A beam signal of a held hub that scatters by this multiple of its noise vibrates.",
        "with the fit of the start: simulated runs cut while driven, moving and vibrating, and cu-flexible; no sweep recorded",
    )
    significant: float = tuned(
        6.0,
        "Multiple of the standard deviation at which a start differs from rest.",
        "taken from an earlier test for a deflected beam; how it was found there is not known",
    )
    at_rest: float = tuned(3.0, "A first speed within this multiple of the noise is one of rest.")
    at_zero: float = tuned(4.0, "A first angle within this multiple of the noise is zero.")
    first_samples: int = tuned(
        20,
        "Samples of the parabola from which a moving hub's speed is estimated.",
        "with the fit of the start: simulated runs cut while driven, moving and vibrating, and cu-flexible; no sweep recorded",
        "samples",
    )
    first_time: float = tuned(0.004, "Stretch whose mean shows a deflected beam.", unit="s")
    longest_held: float = tuned(
        0.5,
        "Longest stretch that the state of a held hub is fitted to.",
        "with the fit of the start: simulated runs cut while driven, moving and vibrating, and cu-flexible; no sweep recorded",
        "s",
    )
    longest_moving: float = tuned(
        0.15,
        "Longest stretch that the state of a moving hub is fitted to.",
        "with the fit of the start: simulated runs cut while driven, moving and vibrating, and cu-flexible; no sweep recorded",
        "s",
    )
    fewest: int = tuned(
        3, "Shortest stretch.", "Appendix A's printed tables, sampled slowly, need samples for the start", "samples"
    )
    iterations: int = tuned(
        3,
        "Gauss–Newton steps.",
        "with the fit of the start: simulated runs cut while driven, moving and vibrating, and cu-flexible; no sweep recorded",
    )
    difference: float = tuned(
        1e-4,
        "Step of the differences, in unit-energy coordinates.",
        "with the fit of the start: simulated runs cut while driven, moving and vibrating, and cu-flexible; no sweep recorded",
    )
    gain: float = tuned(0.999, "A step that leaves more than this share of the cost ends the iterations.")
    modes: int = tuned(
        4,
        "Modes of the beam that may vibrate.",
        "with the fit of the start: simulated runs cut while driven, moving and vibrating, and cu-flexible; no sweep recorded",
    )
    faster_modes: float = tuned(
        0.3,
        "Expected size of the faster modes over that of the first.",
        "with the fit of the start: simulated runs cut while driven, moving and vibrating, and cu-flexible; no sweep recorded",
    )
    least_size: float = tuned(1e-12, "Smallest expected size of a mode.", "guards a division")
    least_seen: float = tuned(
        1e-4,
        "Directions that the stretch shows less than this, over the best shown one, stay at rest.",
        "with the fit of the start: simulated runs cut while driven, moving and vibrating, and cu-flexible; no sweep recorded",
    )


@dataclass(frozen=True)
class ProcessNoise:
    """Standard deviations of the torque noise that observers assume, over the rms torque of the drive."""

    calibration: tuple[float, ...] = tuned((0.03, 0.003, 0.0003), "Levels that a calibration goes through before its own.")
    calibration_more: tuple[float, ...] = tuned(
        (0.3, 0.03, 0.003, 0.0003),
        "Levels of one for which those are too few.",
        "a small arm driven by voltage ended at 2.6 times the noise; with it at the noise",
    )
    calibration_last: tuple[float, ...] = tuned(
        (0.0003,),
        "Levels of one that continues near the noise.",
        "the last level of `calibration`, for play between gears, whose error is rough",
    )
    brief: tuple[float, ...] = tuned(
        (0.003,), "Level of a brief calibration.", "the middle level of `calibration`; one level saves time"
    )
    refinement: tuple[float, ...] = tuned(
        (3e-3, 3e-4, 3e-5),
        "Levels of the final Gauss–Newton steps.",
        "with 1e-3 and 1e-4 alone one of two starts far from the minimum of a simulated square ended at 1.14 times the noise",
    )
    refinement_aside: tuple[float, ...] = tuned(
        (3e-4, 3e-5),
        "Levels of those that begin to either side.",
        "practice recordings with Stribeck friction: hub inertia 1.4 % off; other levels were tried with earlier steps only",
    )
    screening: tuple[float, ...] = tuned(
        (0.01, 0.003, 0.001, 0.0003),
        "Candidates are screened at the first level at which errors exceed `screening.visible`: more feedback hides a small "
        "steady torque, less makes the errors of a model that is far off rough.",
        "at 0.01 alone small steady torques hid; the lower levels were added for them, no sweep recorded",
    )
    windows: tuple[float, ...] = tuned(
        (1e-4, 2e-3, 2e-2),
        "Levels of the replays from whose states windows start.",
        "a single 2e-3 at first; why these three is not known",
    )
    windows_brief: tuple[float, ...] = tuned(
        (2e-3, 2e-2), "Those of a brief error.", "two levels of `windows`, which save two replays of four"
    )
    detection: float = tuned(
        0.01, "Level of the innovations from which detectable sizes are estimated.", "the first level of `screening`"
    )


@dataclass(frozen=True)
class Observers:
    """Steady-state Kalman gains of the corrected replay."""

    hub_share: float = tuned(0.05, "Energy that process noise gives every coordinate, over what it gives the hub.")
    doublings: int = tuned(
        14, "Steps of the doubling iteration for the Riccati equation.", "2**14 samples reach the steady state"
    )
    unstable: float = tuned(1.0001, "A gain whose closed loop grows by more than this per sample is dropped.")
    held_drift: float = tuned(
        0.05,
        "Drift of a held angle per sample, over the noise of its sensor, at full torque noise.",
        "0.07 and 0.075 were tried: a backlash, a real arm of CU Boulder or a table of Appendix A failed",
    )
    size_steps: float = tuned(
        64.0,
        "Factor between the torque sizes that the drift of a held angle distinguishes.",
        "chosen so that calibrations of the arm `thesis` and of the real recordings end where they did",
    )
    least_process: float = tuned(1e-12, "Process variance of states beyond positions and speeds.", "keeps the covariance regular")


@dataclass(frozen=True)
class Forecasts:
    """Forecasts from filtered states, and the disturbances that explain their errors."""

    horizon: float = tuned(
        0.25,
        "Length of the windows in which readings are forecast.",
        "of 0.1, 0.25, 0.5 and 1 s on a real rigid axis all order hypotheses alike; longer ones are rougher where a hub sticks",
        "s",
    )
    groups: int = tuned(14, "Groups of lead times within a window.", "spaced evenly in the logarithm")
    first_torque: float = tuned(0.1, "Process noise at which a first calibration begins, over the rms torque of the drive.")
    least_torque: float = tuned(5e-5, "Smallest process noise, over the rms torque of the drive: all but a free replay.")
    largest_torque: float = tuned(100.0, "Largest process noise, over the rms torque of the drive.")
    least_readings: float = tuned(
        0.14, "Smallest variance of a sensor's noise, over that assumed.", "stated noise is seldom 2.7 times too large"
    )
    largest_readings: float = tuned(1e8, "Largest variance of a sensor's noise, over that assumed.")
    torque_step: float = tuned(2.0, "Factor between levels of process noise that are tried.", "3 ends 12 % above the least cost")
    torques_tried: int = tuned(12, "Levels to either side that are tried without a replay.")
    readings_tried: int = tuned(120, "Variances of a sensor's noise that are tried without a replay, evenly in the logarithm.")


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
class Promising:
    """Promises of effects, before any is fitted."""

    torques: tuple[float, ...] = tuned(
        (1.0, 0.1),
        "Process noise of the observers under which effects are weighed, over that which the errors call for.",
        "effects on torques show under a weak observer, those on sensors under either",
    )
    least_change: float = tuned(1e-6, "A change of the errors below this share is none.")
    largest_factor: float = tuned(10.0, "Largest factor by which an effect's size is changed at once.")
    windows: int = tuned(
        40,
        "Windows in which effects are weighed, spread over all recordings.",
        "10 s; the six best of a practice case rank as in all of them",
    )
    every: int = tuned(2, "Of the levels of process noise that suit the errors, every so many are considered.")


@dataclass(frozen=True)
class ForecastSearching:
    """A search by the density of forecasts."""

    width: int = tuned(3, "Models of one number of effects that are extended.")
    finalists: int = tuned(3, "Effects that promise most and are calibrated beside each model.")
    near_promise: float = tuned(0.5, "Others are, too, if they promise this share of what the best promises.")
    most_finalists: int = tuned(5, "Effects calibrated beside each model at most.")
    near_gain: float = tuned(0.5, "Models that gain this share of what the best gains are calibrated to the end beside it.")
    least_gain: float = tuned(6.0, "Gain of the log density below which one more effect ends the search.", "400 to 1")


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
    least_size: float = tuned(0.3, "Size of an effect below which differences shrink no further, in typical sizes.")
    widest_step: float = tuned(0.3, "Widest difference, over a constant's prior or an effect's size.")


@dataclass(frozen=True)
class LeastSquares:
    """Levenberg–Marquardt with differences as wide as the model is off."""

    first_damping: float = tuned(1e-3, "Damping at the start.", "customary (Marquardt, J. SIAM 11 (1963) 431)")
    less_damping: float = tuned(0.2, "Factor of the damping after a step that helps.")
    least_damping: float = tuned(1e-7, "Smallest damping.")
    more_damping: float = tuned(10.0, "Factor of the damping after a step that fails.", "customary (Marquardt 1963)")
    least_helpful: float = tuned(
        1e-3,
        "Damping below which a step is that of Gauss and Newton.",
        "with Broyden's correction: one diagnosis of three runs took 46 s of one core, before 71; no sweep recorded",
    )
    largest_step: float = tuned(3.0, "Largest change of a scaled value in a step.")
    steps: int = tuned(
        4,
        "Steps along one Jacobian, which each corrects for the next.",
        "with Broyden's correction: one diagnosis of three runs took 46 s of one core, before 71; no sweep recorded",
    )
    worthwhile: float = tuned(
        0.01,
        "Relative decrease of the cost below which a Jacobian is computed anew.",
        "with Broyden's correction: one diagnosis of three runs took 46 s of one core, before 71; no sweep recorded",
    )
    trials: int = tuned(
        5,
        "Dampings that the first step along a Jacobian tries.",
        "with Broyden's correction: one diagnosis of three runs took 46 s of one core, before 71; no sweep recorded",
    )
    shrinks: float = tuned(0.7, "Differences that shrank by less than this factor give the same Jacobian again.")
    narrow: float = tuned(
        8.0,
        "Factor by which differences are narrower in the last pass.",
        "EMPS: over wider differences, curvature bent its friction by 1.2 %",
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
    tolerance: float = tuned(
        1e-2,
        "Relative decrease of the cost at which a level is left.",
        "with Broyden's correction: one diagnosis of three runs took 46 s of one core, before 71; no sweep recorded",
    )
    final_tolerance: float = tuned(
        1e-4,
        "Relative decrease of the cost at which the last pass ends.",
        "with Broyden's correction: one diagnosis of three runs took 46 s of one core, before 71; no sweep recorded",
    )
    last_iterations: int = tuned(
        2, "Jacobians when only the held-out part is new.", "a diagnosis did less twice; no sweep recorded"
    )
    brief_iterations: int = tuned(2, "Jacobians of a brief calibration.")
    continuations: int = tuned(
        4,
        "How often a calibration that stays far off is continued.",
        "one run of CU Boulder's arm ended 6 % off, by rounding; no sweep recorded",
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

    difference: float = tuned(
        1e-5,
        "Step of the differences.",
        "motor inertias of null-38, null-45 and null-58 were 10, 11 and 15 % off, then 3, 0 and 10 %; no sweep recorded",
    )
    iterations: int = tuned(5, "Jacobians at each level at most.", "no sweep recorded")
    tolerance: float = tuned(
        1e-2,
        "Relative decrease of the cost along a Jacobian below which no other is computed.",
        "that of `calibrating.tolerance`; no sweep recorded",
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
        (0.0, 1e1, 1e2, 1e3, 1e4),
        "Dampings tried in turn, over the priors' weight.",
        "motor inertias of null-38, null-45 and null-58 were 10, 11 and 15 % off, then 3, 0 and 10 %; no sweep recorded",
    )
    aside: float = tuned(
        0.3,
        "Distance to either side at which other minima are sought, in priors' standard deviations.",
        "26 null machines of seeds 2 and 3 then ended at 0.994 to 1.005 times the noise, before at 1.004 to 1.05",
    )
    scale_step: float = tuned(
        0.02,
        "Step of the logarithm of the common scale.",
        "torque constants of null-21, null-38 and null-45 of seed 4 were 10, 5 and 11 % off, then 3, 1 and 3 %",
    )
    scale_furthest: float = tuned(
        0.5,
        "Furthest that the logarithm of the common scale moves at once.",
        "torque constants of null-21, null-38 and null-45 of seed 4 were 10, 5 and 11 % off, then 3, 1 and 3 %",
    )


@dataclass(frozen=True)
class Intervals:
    """How 90 % intervals are made."""

    quantile: float = tuned(1.6449, "Two-sided 90 % quantile of the normal distribution.", "the normal distribution")
    best_model: float = tuned(0.005, "Relative standard deviation that no value beats: no model is more exact.")
    block: float = tuned(0.25, "Length of the blocks over which residuals may be correlated.", unit="s")


@dataclass(frozen=True)
class Screening:
    """Ranking of candidates by the change of the residual that they would make."""

    visible: float = tuned(
        1.5,
        "Error over noise at which a level of process noise leaves something to explain.",
        "with the levels of `process_noise.screening`, so that small steady torques show; no sweep recorded",
    )
    least_explained: float = tuned(0.005, "Least share of the residual that a signature must explain to be fitted.")
    least_change: float = tuned(1e-12, "A change of the residual below this share is none.", "guards a division")
    starts_scanned: int = tuned(2, "Starts whose size is scanned.")
    sizes: tuple[float, ...] = tuned((0.15, 0.4, 0.75, 1.2, 2.5), "Factors of the size that are scanned.")
    few_starts: int = tuned(
        2,
        "Effects with no more starts are tried at small sizes, too.",
        "so that effects a hundred times smaller than typical are found; no sweep recorded",
    )
    small: tuple[float, ...] = tuned(
        (0.03, 0.003),
        "Shares of the first start's size that are tried where starts are few.",
        "so that effects a hundred times smaller than typical are found; no sweep recorded",
    )
    linear: float = tuned(0.7, "Share of a secant's promise that counts as proportional growth.")
    largest_factor: float = tuned(
        10.0, "Largest factor taken from a secant.", "raised from 4 while the benchmark was built; no sweep recorded"
    )
    iterations: int = tuned(4, "Jacobians of a candidate's own parameters.")
    tolerance: float = tuned(1e-3, "Relative decrease of the cost at which a candidate's fit ends.")


@dataclass(frozen=True)
class Proposing:
    """Candidates that are calibrated in full, and the constants that they start from."""

    finalists: int = tuned(4, "Candidates calibrated in full in each round.")
    least_change: float = tuned(0.97, "They must lower the cost of the screening to this share.")
    least_of_best: float = tuned(0.3, "And by this share of what the best one does.")
    near_best: float = tuned(
        0.6, "Those that do this share of what the best one does go first.", "a diagnosis did less twice; no sweep recorded"
    )
    refit_helps: float = tuned(0.2, "Constants that leave less than this share of the excess are trusted as a start.")
    refit_fails: float = tuned(0.7, "Constants that leave more than this share of the excess are not.")
    biased: float = tuned(1.0, "Constants that moved by more priors' standard deviations are reset before brief calibrations.")
    briefly_better: float = tuned(
        0.9,
        "Share of the control's excess that an effect may leave after a brief calibration.",
        "a diagnosis that found nothing took two minutes less; no sweep recorded",
    )
    most_brief: int = tuned(4, "Effects calibrated in full after brief calibrations.")
    too_large: float = tuned(
        1.03,
        "A brief calibration that leaves this multiple of the control's error began too large.",
        "small gaps behind constants that are far off, misses of seed 4; no sweep recorded",
    )
    least_offset: float = tuned(
        0.01,
        "Share of the residual that the companion effect must explain to be fitted along.",
        "calibrations with a constant torque beside every finalist took half of a round; no sweep recorded",
    )


@dataclass(frozen=True)
class Selecting:
    """Thresholds by which effects are accepted, exchanged and dropped (`ThresholdCriteria`)."""

    most_effects: int = tuned(3, "Effects that a diagnosis names at most.")
    least_gain: float = tuned(
        0.25,
        "Least share of the excess that an effect must remove.",
        "raised from 0.15 before the benchmark existed; why is not known",
    )
    least_gain_far_off: float = tuned(
        0.5,
        "The same where the model stays far off, in windows and in the free run.",
        "cu-flexible: an effect that leaves a model far off must halve both errors; no sweep recorded",
    )
    least_total_gain: float = tuned(
        0.7,
        "Least share of the excess that all accepted effects must remove.",
        "raised from 0.5: brushes' drop was named for a sticky spot, seeds 1 to 3",
    )
    least_total_gain_near: float = tuned(
        0.95,
        "The same in windows where the model ends near the noise.",
        "seed 5: effects outside the catalogue that were mislabelled left 29, 9 and 4 % of the excess",
    )
    least_removed: float = tuned(0.2, "Excess that an effect must remove at least.")
    least_of_first: float = tuned(
        1e-3,
        "The same, as a share of what the refitted constants leave.",
        "2e-3 was tried with fewer continuations of a calibration, and taken back with them",
    )
    same_gain: float = tuned(
        0.03, "Effects are equivalent if what they leave differs by less than this share of what they remove."
    )
    same_excess: float = tuned(0.1, "And by less than one of them leaves, or this excess, whichever is more.")
    signal_rest: float = tuned(
        0.01,
        "Share of a signal's excess that may be left where it does not come near the noise, though all signals together do.",
        "a strain gage read at a tenth of the rate ends at 1.43 of its noise, with 0.05 % left",
    )
    noticed: float = tuned(
        0.1,
        "The error of a signal that moves by more than this share is noticed: an effect touches it, or makes it worse.",
        "stated as what a reader wants to know; not tuned",
    )
    refit_needed: float = tuned(1.5, "Constants were wrong if the nominal excess is this multiple of the refitted one.")


@dataclass(frozen=True)
class DetectionLimits:
    """The size up to which an absent effect would go undetected."""

    step_down: float = tuned(100.0, "Largest factor by which a size is lowered at once.", "raised from 30; why is not known")
    step_up: float = tuned(
        3.0,
        "Largest factor by which a size is raised at once.",
        "simulated effects: a third of the limit stays hidden, three times as much shows; no sweep recorded",
    )
    steps: int = tuned(
        4,
        "Steps by the innovations.",
        "simulated effects: a third of the limit stays hidden, three times as much shows; no sweep recorded",
    )
    window_steps: int = tuned(
        6,
        "Most steps by windows, of which a small one is the last.",
        "raised from 2 for limits of the command in runs of EMPS and `thesis-fem`, whose error does not grow with a square",
    )
    in_windows: float = tuned(
        25.0,
        "Rise of the error in windows over that of the innovations, in which feedback hides an effect.",
        "simulated effects: a third of the limit stays hidden, three times as much shows; no sweep recorded",
    )
    stays: float = tuned(
        0.7,
        "A smaller size that leaves more than this share of a change hardly lowers it.",
        "simulated effects: a third of the limit stays hidden, three times as much shows; no sweep recorded",
    )
    least_change: float = tuned(1e-12, "A change that counts as none.", "guards a division")
    close: float = tuned(
        0.2,
        "Change of the size's logarithm that ends the steps.",
        "simulated effects: a third of the limit stays hidden, three times as much shows; no sweep recorded",
    )
    most_starts: int = tuned(
        3,
        "Starts that are tried: of a periodic effect, from its slowest to its fastest.",
        "lowered from 4, in the change that halved the time of the demo's diagnosis",
    )


@dataclass(frozen=True)
class ExcitationLimits:
    """Which constants and effects recordings are said to show, before any fit."""

    shown: float = tuned(
        0.5,
        "A constant is shown where recordings narrow its prior to this share.",
        "chosen for the public definition: they then weigh three times as much as the prior",
    )
    most_sizes: float = tuned(
        10.0,
        "An effect that would not show at this multiple of its typical size is not excited.",
        "chosen for the public definition",
    )


@dataclass(frozen=True)
class Explaining:
    """Errors by regime and band, and torque estimated from recordings."""

    fast: float = tuned(0.1, "The hub moves fast above this share of its largest speed.")
    smoothing: float = tuned(0.02, "Half width of the mean by which regimes are told.", unit="s")
    still: float = tuned(3.0, "The hub is stuck below this multiple of the smoothed speed's noise.")
    bands: tuple[float, ...] = tuned((0.0, 2.0, 5.0, 15.0, 50.0), "Edges of the frequency bands.", unit="Hz")
    torque_step: float = tuned(0.05, "Change of the hub's torque per sample that the smoother expects, over the drive's rms.")
    least_noise: float = tuned(1e-6, "Noise on every state over that of the torque, so that all stay open to correction.")
    settling: float = tuned(0.2, "Time at both ends in which the smoother still depends on its start.", unit="s")
    rank: float = tuned(1e-14, "Relative singular value below which the smoother's covariance is singular.", "machine precision")
    moving: float = tuned(0.01, "The hub counts as moving above this share of its largest speed.")
    slowest: float = tuned(1e-6, "Speed at which a law's curve begins.", unit="rad/s")
    bins: int = tuned(32, "Bins of a curve.")
    fewest_in_bin: int = tuned(12, "Samples in a bin.", unit="samples")
    line_points: int = tuned(200, "Points of a law's line.")
    most_points: int = tuned(1500, "Samples drawn.")
    quartiles: tuple[float, float] = tuned((25.0, 75.0), "Band that holds the middle half of a bin.", "a definition", "%")


#: Origins of the numbers of `MotionFaults`.
SOUND_RUNS = (
    "no alarm on 236 sound recordings (66 machines of seed 5, practice, CU Boulder, EMPS); 1 on 280 simulated ones of seven arms "
    "with constants 30 % off and effects, since then excluded by a bound; no sweep recorded"
)
EFFECTS_OF_THE_HUB = (
    "three simulated arms, three inputs, eight effects at one and four times their typical size: at best lags above 0.004 s play "
    "leaves 0.53 to 0.98 of the difference, others 0.36 to 0.97; angles 8 to 48 ms late leave 0.0001 to 0.23, and 0.57 in one run"
)
FAULTY_RUNS = (
    "300 simulated recordings of seven arms with a fault at random, 298 found with their size within 2 %; no sweep recorded"
)


@dataclass(frozen=True)
class Inspecting:
    """How the readings of recordings are inspected before any model is replayed."""

    rounding: float = tuned(1e-9, "A change below this share of a signal's range is none.", "rounding of decimals to floats")
    from_rounding: float = tuned(0.28868, "Standard deviation of rounding over the step.", "uniform distribution: 1/√12")
    usual: float = tuned(
        0.95, "Quantile of a signal's changes that stands for its usual ones.", "leaves room for spikes in 2 % of the rows"
    )
    moves: float = tuned(20.0, "A signal moves if its range exceeds this multiple of its noise.", UNHARMED)
    beyond_limit: float = tuned(1.01, "Commands above this multiple of the limit are beyond it.", UNHARMED)
    fewest_changes: int = tuned(20, "Changes from which held readings are told.", UNHARMED)
    most_changing: float = tuned(
        0.6, "A held signal changes in fewer than this share of the rows.", "repeats of 2 change in half"
    )
    more_than_a_step: float = tuned(1.5, "A change above this multiple of the step is no flicker of the last digit.", UNHARMED)
    large_changes: float = tuned(0.2, "Share of such changes in a held signal.", UNHARMED)
    padding: int = tuned(4, "Length of the spectrum over that of the recording.", UNHARMED)
    comb: float = tuned(0.6, "Least line of a comb in its spectrum.", "repeats of 2 to 3, uneven, give 0.64 to 0.83")
    comb_by_chance: float = tuned(5.0, "Least line times the root of the number of changes.", "normal distribution")
    first_line: float = tuned(0.8, "The first line of a comb is at least this share of its highest.", UNHARMED)
    once_a_beat: float = tuned(1.1, "Changes of a held signal in each beat, at most.", "one, and an uneven rest")
    of_range: float = tuned(0.6, "A wrap jumps by more than this share of the range of its signal.", UNHARMED)
    most_wrapping: float = tuned(0.3, "Share of the changes that are wraps, at most.", UNHARMED)
    same_jump: float = tuned(0.02, "Jumps by one modulus differ by less than this share of it.", UNHARMED)
    most_alike: float = tuned(0.75, "Share of the jumps that differ by less; the others are also those of the motion.", UNHARMED)
    same_turn: float = tuned(0.002, "Jumps that differ by less from a turn or a counter's modulus are that.", UNHARMED)
    seldom: float = tuned(0.98, "Quantile of a signal's changes that starts and stops exceed.", SLOWLY)
    smooth: float = tuned(0.35, "Such other changes of a signal that wraps are below this share of the modulus.", SLOWLY)
    fewest_flickers: int = tuned(
        4, "Jumps from which a signal that flickers across the end of its range is one that wraps.", UNHARMED
    )
    goes_on: int = tuned(
        5, "Readings on each side of a jump that show whether the motion goes on, or the reading stays.", UNHARMED
    )
    goes_on_slowly: int = tuned(
        20,
        "The same of a motion that a few readings do not show.",
        "an angle at 0.5 rad/s read every 4 ms with a noise of 2 mrad wraps unseen with 5",
    )
    least_motion: float = tuned(3.0, "Motion over them, over the noise.", UNHARMED)
    wild: float = tuned(
        4.0,
        "A wild reading stands off its neighbours by this multiple of the usual change.",
        "sound recordings: 3.0 at most, with play between gears; with `wild_noise`, half of both",
    )
    wild_noise: float = tuned(
        40.0, "And by this multiple of the noise.", "sound recordings: 24 at most (EMPS), 20 with play between gears"
    )
    wild_largest: float = tuned(2.0, "And the largest other change by this factor.", SLOWLY)
    wild_side: float = tuned(0.5, "On either side it stands off by more than this share of its height.", UNHARMED)
    wild_steps: float = tuned(8.0, "And by this multiple of the step.", UNHARMED)
    longest_loss: float = tuned(0.2, "Longest stretch of lost readings, over the recording.", UNHARMED)
    most_named: int = tuned(4, "Stretches of rows that a message names.", UNHARMED)
    most_ignored: int = tuned(6, "Stretches that a line of a column map leaves out.", UNHARMED)
    fewest_at_rail: int = tuned(12, "Readings at a rail.", UNHARMED)
    least_run: int = tuned(3, "Shortest stretch at a rail.", UNHARMED)
    evidence: float = tuned(25.0, "Logarithm of the odds from which readings repeat by more than chance.", UNHARMED)
    stretches: int = tuned(20, "Parts of a recording of which the one with the most repeated readings is the measure.", UNHARMED)
    least_repeats: float = tuned(0.05, "Least share of repeated readings that is taken for usual.", UNHARMED)
    flickers: float = tuned(
        0.05,
        "Share of readings at which a signal turns back, from which it counts as noisy.",
        "sound recordings with noise: 0.10 and more; encoders of EMPS and CU Boulder: 0.0005 and less",
    )
    wide_noise: float = tuned(0.8, "Noise above this multiple of the step has a tail of several steps.", "normal distribution")
    many_at_rail: int = tuned(50, "Readings from which the tail of such noise has ten times as many a step before.", "the same")
    piled_up: float = tuned(4.0, "Surplus of readings at a rail over those a step before it, in standard deviations.", UNHARMED)
    cut_slope: float = tuned(1.5, "Slope into a rail, in steps per sample.", UNHARMED)
    near_zero: float = tuned(0.02, "A level below this share of the range is that of rest.", UNHARMED)
    quiet: float = tuned(2.0, "A signal is quiet if it scatters less than this multiple of its noise.", UNHARMED)
    most_glued: int = tuned(8, "Runs in one file that are told apart.", UNHARMED)
    jump: float = tuned(4.0, "A jump exceeds the largest change elsewhere by this factor.", UNHARMED)
    jump_noise: float = tuned(20.0, "And the noise by this one.", UNHARMED)
    stays: float = tuned(0.5, "Share of a jump that is left after some readings.", UNHARMED)
    as_begun: float = tuned(
        6.0, "Distance from the first reading, over the noise, of a run that begins as the first did.", UNHARMED
    )


@dataclass(frozen=True)
class MotionFaults:
    """Factors, signs, exchanged signals and clocks, found by a free run before anything is calibrated."""

    cell: float = tuned(
        0.01, "Signals are averaged over cells of this length.", "a fortieth of the period of 2.4 Hz, `thesis`", "s"
    )
    window: float = tuned(
        1.0, "Length of the windows in which a signal is compared.", "the window in which errors are measured", "s"
    )
    least_window_cells: int = tuned(20, "Shortest window.", "leaves 18 degrees of freedom beside offset and drift", "cells")
    longest_gap: int = tuned(3, "Longest gap between readings that is bridged.", "a sensor of 25 Hz", "cells")
    longest_lag: float = tuned(2.0, "Longest lag that is tried.", "four times the largest bound of the effect `time_offset`", "s")
    longest_lag_share: float = tuned(0.25, "Longest lag that is tried, over the length of the recording.", FAULTY_RUNS)
    lag_step: float = tuned(
        0.08, "First step from a likely lag to a better one.", "likely lags were 0.02 to 0.13 s off in simulated runs", "s"
    )
    lag_resolution: float = tuned(5e-4, "A step below this ends the search of a lag.", "1 % of `least_lag`", "s")
    least_lag: float = tuned(
        0.05,
        "A clock is at fault above this lag.",
        "sound recordings and delays of up to 30 ms, as effects have, stay below",
        "s",
    )
    sure_lag: float = tuned(
        0.1,
        "The same where more than the noise is left.",
        "350 simulated machines with constants 30 % off and effects: lags of up to 0.084 s without a clock's fault",
        "s",
    )
    least_hub_lag: float = tuned(
        0.004, "The same for the angle behind the speed, which are readings of one motion.", EFFECTS_OF_THE_HUB, "s"
    )
    longest_hub_lag: float = tuned(0.06, "Longest of these lags; above `least_lag` those against the model are tried.", unit="s")
    hub_lag_resolution: float = tuned(4e-5, "A step below this ends the search of it.", "1 % of `least_hub_lag`", "s")
    lag_leaves: float = tuned(
        0.25, "Share of the difference between angle and speed that is left at the lag of a clock, at most.", EFFECTS_OF_THE_HUB
    )
    same_lag: float = tuned(0.02, "Signals whose lags differ by less are late together.", SOUND_RUNS, "s")
    unexplained: float = tuned(0.4, "A lag is worth it if it leaves less than this share of what is unexplained.", SOUND_RUNS)
    exact: float = tuned(
        0.999, "A signal that the model explains to this share, the noise aside, leaves hardly more than noise.", FAULTY_RUNS
    )
    same_shape: float = tuned(0.98, "A signal that the model explains to this share has the model's shape.", SOUND_RUNS)
    alike: float = tuned(0.95, "A signal that the model explains to this share agrees with it.", SOUND_RUNS)
    in_step: float = tuned(
        0.9,
        "Angle and speed that explain each other to this share are readings of one motion.",
        "198 recordings of seed 5: 0.974 and above, with gains of 0.88 to 1.10",
    )
    similar: float = tuned(0.6, "A signal that the model explains to this share moves as the model does.", SOUND_RUNS)
    shared_motion: float = tuned(
        0.4, "Signs and factors are judged where the model explains this share.", "198 recordings of seed 5: 0.45 and above"
    )
    near: float = tuned(1.05, "Gains within this factor of 1 agree.", SOUND_RUNS)
    least_factor: float = tuned(
        1.3,
        "Gains within this factor of 1 belong to the calibration.",
        "raised from 1.25, a convention, since a tachometer with a strong ripple has 0.797 where the motor turns little",
    )
    plausible: float = tuned(
        2.5,
        "Gains of a sound signal are within this factor of 1 where it moves as the model does.",
        "198 recordings of seed 5: but for 2 %, 0.47 to 1.63",
    )
    far_apart: float = tuned(2.5, "Gains that differ by more are of different units.", SOUND_RUNS)
    surely_a_unit: float = tuned(
        6.0, "A factor of the command beyond this is one of units, whatever the model lacks.", SOUND_RUNS
    )
    spreads: float = tuned(3.0, "Spreads of the constants' priors beyond which a factor is none of theirs.", "a convention")
    command_factors: tuple[float, ...] = tuned(
        (0.3, 3.0, 0.1, 10.0, 1000.0, 0.001),
        "Factors of the command from which it is searched, after that of the signals.",
        FAULTY_RUNS,
    )
    command_steps: int = tuned(8, "Steps in which a factor of the command is refined.", FAULTY_RUNS)
    command_close: float = tuned(0.002, "Logarithm of the middle gain that ends the steps.", "a tenth of 2 %")
    largest_factor: float = tuned(
        1e4, "Factors of the command beyond this, or below one over it, are none.", "ten times mA for A"
    )
    polishing_step: float = tuned(0.008, "First step of its logarithm from there to the best one.", FAULTY_RUNS)
    signal_steps: int = tuned(3, "Steps in which a factor of an only signal is refined.", FAULTY_RUNS)
    constant_difference: float = tuned(
        0.02, "Difference of a constant's or a factor's logarithm over which slopes are taken.", FAULTY_RUNS
    )
    lag_difference: float = tuned(2e-3, "The same of a lag.", FAULTY_RUNS, "s")
    correlated: float = tuned(0.1, "Time over which errors beyond the noise count once.", FAULTY_RUNS, "s")
    sizing_steps: int = tuned(4, "Steps in which a size and the constants beside it are estimated.", FAULTY_RUNS)
    shortest_step: float = tuned(0.1, "Such a step is shortened to no less than this share of it.", FAULTY_RUNS)
    known_factor: float = tuned(0.02, "Logarithm of the ratio to a known number within which a factor is named by it.", "2 %")
    likely_factor: float = tuned(
        0.15,
        "The same where constants of the model change the factor, too.",
        "machines with constants 4 % off on either side: the factor of an only signal is then up to 12 % off",
    )


@dataclass(frozen=True)
class Settings:
    """Every tuned number of the method, by stage.

    Example:
        >>> from dataclasses import replace
        >>> settings = Settings()
        >>> settings.errors.far_off
        3.0
        >>> replace(settings, errors=replace(settings.errors, far_off=4.0)).errors.far_off
        4.0
    """

    errors: ErrorScale = ErrorScale()
    preparation: Preparation = Preparation()
    thinning: Thinning = Thinning()
    reference: ReferenceSizes = ReferenceSizes()
    initial_states: InitialStates = InitialStates()
    process_noise: ProcessNoise = ProcessNoise()
    observers: Observers = Observers()
    forecasts: Forecasts = Forecasts()
    forecast_fit: ForecastFit = ForecastFit()
    promising: Promising = Promising()
    forecast_searching: ForecastSearching = ForecastSearching()
    parameters: Parameters = Parameters()
    least_squares: LeastSquares = LeastSquares()
    calibrating: Calibrating = Calibrating()
    refining: Refining = Refining()
    intervals: Intervals = Intervals()
    screening: Screening = Screening()
    proposing: Proposing = Proposing()
    selecting: Selecting = Selecting()
    detection: DetectionLimits = DetectionLimits()
    excitation: ExcitationLimits = ExcitationLimits()
    explaining: Explaining = Explaining()
    inspecting: Inspecting = Inspecting()
    motion: MotionFaults = MotionFaults()

    def numbers(self) -> Iterator[Number]:
        """Yield every number with its stage, meaning and origin."""
        for stage in dataclasses.fields(self):
            values = getattr(self, stage.name)
            for number in dataclasses.fields(values):
                facts = number.metadata
                value = getattr(values, number.name)
                yield Number(stage.name, number.name, value, facts["unit"], facts["meaning"], facts["found"])

    def as_json(self) -> dict[str, dict[str, Any]]:
        """Convert to plain data: the value of each number by stage and name."""
        return {stage: dict(values) for stage, values in dataclasses.asdict(self).items()}

    def digest(self) -> str:
        """Compute the first 12 hexadecimal digits of the SHA-256 of the numbers as JSON, by which results name their settings.

        Example:
            >>> Settings().digest() == SETTINGS.digest()
            True
        """
        numbers = json.dumps(self.as_json(), sort_keys=True)
        return hashlib.sha256(numbers.encode()).hexdigest()[:12]


#: The settings of every published result.
SETTINGS = Settings()
