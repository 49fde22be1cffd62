"""How recordings are prepared, split, thinned and measured before anything is calibrated."""

from __future__ import annotations

from dataclasses import dataclass

from flexarm_env.identify.settings.number import tuned

#: Origin of several numbers.
LATE_LIMITS = "limits that act once, late, after misses of saturation in seed 5; no sweep recorded"


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
    motion_readings: int = tuned(
        3,
        "Readings in a row of which the mean counts in that.",
        "`thesis` at rest for 60 s: readings range over 8.6 times the noise, means of three over 4.8; longer means blur more",
        "samples",
    )
    one_command: float = tuned(1e-9, "Share of a command by which it may vary and counts as constant: thinning rounds its mean.")
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
        0.05, "Less is held out where the fitted part shows less than this share of the excess.", LATE_LIMITS
    )
    late_least_held_out: float = tuned(0.1, "Share of a recording's time and samples that stays held out.", LATE_LIMITS)


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
    vibration_error: float = tuned(
        0.05,
        "Largest change of a signal, rms over its noise, by the vibrations of a beam that replays leave out.",
        "changes an error at the noise by 0.1 %; seven of the twelve are kept of `thesis-fem` at 500 Hz",
    )
    vibration_windows: int = tuned(12, "Windows in which it is measured, spread over all recordings at most.")
    command_error: float = tuned(
        0.2,
        "Error that the mean command makes in a signal, rms over its noise in windows, that is left.",
        "raises an error of 1 to 1.02, a fifth of what counts as nothing left (`errors.nothing_left`)",
    )
    frictions: tuple[float, ...] = tuned(
        (0.7, 1.0, 1.2, 1.4),
        "Shares of Coulomb friction with which that error must not be larger.",
        "a hub held by 1.1 times its model's friction under a noisy command: 0.04 with 0.6 to 1.0 of it, 2 to 3 from 1.1 on",
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
