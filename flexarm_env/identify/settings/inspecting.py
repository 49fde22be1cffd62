"""How the readings of recordings are inspected before any model is replayed."""

from __future__ import annotations

from dataclasses import dataclass

from flexarm_env.identify.settings.number import tuned

#: Origins of numbers that were not swept.
SLOWLY = "no false alarm on 60 sets of seed 31 thinned to 20, 50 and 100 Hz, where 42, 38 and 1 had one before"
UNHARMED = "no false alarm on 134 sets of sound recordings, 120 of them of seed 31; no sweep recorded"


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
    answered: int = tuned(
        2,
        "Samples after a jump of the command in which a wild reading is the machine's answer.",
        "a motor of an elastic joint behind a square wave of a PD loop, told as spikes of the tachometer at each step",
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
