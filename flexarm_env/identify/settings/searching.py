"""The search for missing effects: candidates, calibrations in full, and the thresholds that decide."""

from __future__ import annotations

from dataclasses import dataclass

from flexarm_env.identify.settings.number import tuned

#: Origin of several numbers.
SMALL_EFFECTS = "so that effects a hundred times smaller than typical are found; no sweep recorded"


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
    in_proportion: float = tuned(
        0.3,
        "Residual over the change that an effect makes: below it the effect is tried at a smaller size, too.",
        "a size within three of the right one is reached by the secant; no sweep recorded",
    )
    shrinks: int = tuned(4, "Sizes of a start that are tried at most.", "friction of 1e-5 of what holds an arm takes three")
    small: tuple[float, ...] = tuned(
        (0.03, 0.003), "Shares of the first start's size that brief calibrations try.", SMALL_EFFECTS
    )
    linear: float = tuned(0.7, "Share of a secant's promise that counts as proportional growth.")
    largest_factor: float = tuned(
        10.0, "Largest factor taken from a secant.", "raised from 4 while the benchmark was built; no sweep recorded"
    )
    followed: float = tuned(
        0.01,
        "Share of the way along which readings follow a sine of the angle, or it is not tried.",
        "0 for a motor that turns by 8 rad and more between two readings; of a swing that is seven times too fast, still 0.01",
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
    least_log_gain: float = tuned(6.0, "Gain of the log density below which one more effect ends the search.", "400 to 1")


@dataclass(frozen=True)
class Selecting:
    """Thresholds by which effects are accepted, exchanged and dropped (`ThresholdCriteria`)."""

    most_effects: int = tuned(3, "Effects that a diagnosis names at most.")
    least_gain: float = tuned(
        0.25,
        "Least share of the excess that an effect must remove.",
        "raised from 0.15 before the benchmark existed; why is not known",
    )
    least_total_gain: float = tuned(
        0.7,
        "Least share of the excess that all accepted effects must remove, and each beside others where the model stays far off.",
        "raised from 0.5: brushes' drop was named for a sticky spot, seeds 1 to 3; on CU Boulder's rigid arm cogging removed 0.6",
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
    near_gain: float = tuned(
        0.5,
        "A simpler effect that removes this share of what another removes may be what is missing, where others are missing too.",
        "viscous friction behind a slow amplifier passed for a bent potentiometer: 80 and 84 % of the excess, before the second",
    )
    same_excess: float = tuned(0.1, "And by less than one of them leaves, or this excess, whichever is more.")
    signal_rest: float = tuned(
        0.01,
        "Share of a signal's excess that may be left where it does not come near the noise, though all signals together do.",
        "a strain gage read at a tenth of the rate ends at 1.43 of its noise, with 0.05 % left",
    )
    rough: float = tuned(
        0.1,
        "Share of the excess left by which calibrations of one model from two starts differ where its error is rough.",
        "a gap of 0.06 rad: a fifth to six times of it; a cable's spring that imitates two torques: less than a hundredth",
    )
    noticed: float = tuned(
        0.1,
        "The error of a signal that moves by more than this share is noticed: an effect touches it, or makes it worse.",
        "stated as what a reader wants to know; not tuned",
    )
    refit_needed: float = tuned(1.5, "Constants were wrong if the nominal excess is this multiple of the refitted one.")
