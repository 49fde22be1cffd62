"""Faults that a free run shows before anything is calibrated."""

from __future__ import annotations

from dataclasses import dataclass

from flexarm_env.identify.settings.number import tuned

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
    longest_drive_delay: float = tuned(
        0.1,
        "Longest lag of all signals that a diagnosis takes as a delay of the drive, and looks for an effect.",
        "delays of 60 to 90 ms were named on seven arms; half a second is a clock's",
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
    play_widths: tuple[float, ...] = tuned(
        (6.0, 7.5, 9.0, 11.0, 14.0),
        "Widths of play between motor and arm that are tried beside a lag of the angle, over its rms difference from the speed.",
        "sixteen axes with backlash whose angle seemed late: those that fit best are 7.5 to 10.3",
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
