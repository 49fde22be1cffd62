"""What recordings show: detectable sizes, excitation, and errors and torques by regime."""

from __future__ import annotations

from dataclasses import dataclass

from flexarm_env.identify.settings.number import tuned

#: Origin of several numbers.
HIDDEN_SIZES = "simulated effects: a third of the limit stays hidden, three times as much shows; no sweep recorded"


#: Origins of the probabilities.
NAMED = "of the effects named on 96 machines of seeds 126543 and 281909 (`benchmarks.machines`)"
EARLIER = "of those named on seeds 126543 and 129856 by an earlier search"


@dataclass(frozen=True)
class Probabilities:
    """How often named effects are right."""

    explained: float = tuned(
        0.98,
        "Where only noise is left, an effect or one that is equivalent to it.",
        f"67 of 67 {NAMED} without an equivalent; 66 of 67 is 98 %",
    )
    mostly: float = tuned(
        0.7, "The same where more than noise is left, but little of the excess.", f"0 of 2 {NAMED}, 7 of 8 {EARLIER}"
    )
    little: float = tuned(
        0.01,
        "Share of the excess in windows that is little.",
        f"right ones left at most 0.005, wrong ones but one at least 0.05 {EARLIER}",
    )
    partly: float = tuned(
        0.15,
        "The same where more of the excess is left.",
        f"2 of 11 {NAMED}, mostly on machines with effects of no catalogue; on CU Boulder's arms Coulomb friction is right",
    )
    first: float = tuned(
        0.92,
        "Share of the first of several equivalents; the others have the rest in equal parts.",
        f"23 of 24 {NAMED}, 25 of 29 {EARLIER}",
    )


@dataclass(frozen=True)
class DetectionLimits:
    """The size up to which an absent effect would go undetected."""

    first: float = tuned(
        0.03, "Multiple of a start at which an effect is tried first.", "the middle of what 38 effects end at on `thesis-fem`"
    )
    step_down: float = tuned(100.0, "Largest factor by which a size is lowered at once.", "raised from 30; why is not known")
    step_up: float = tuned(3.0, "Largest factor by which a size is raised at once.", HIDDEN_SIZES)
    steps: int = tuned(4, "Steps by the innovations.", HIDDEN_SIZES)
    window_steps: int = tuned(
        6,
        "Most steps by windows, of which a small one is the last.",
        "raised from 2 for limits of the command in runs of EMPS and `thesis-fem`, whose error does not grow with a square",
    )
    in_windows: float = tuned(
        25.0, "Rise of the error in windows over that of the innovations, in which feedback hides an effect.", HIDDEN_SIZES
    )
    stays: float = tuned(0.7, "A smaller size that leaves more than this share of a change hardly lowers it.", HIDDEN_SIZES)
    least_change: float = tuned(1e-12, "A change that counts as none.", "guards a division")
    close: float = tuned(0.2, "Change of the size's logarithm that ends the steps.", HIDDEN_SIZES)
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
    moved_far: float = tuned(3.0, "A constant that a fit moves by more of its prior's standard deviations is told.")
    moving: float = tuned(0.01, "The hub counts as moving above this share of its largest speed.")
    slowest: float = tuned(1e-6, "Speed at which a law's curve begins.", unit="rad/s")
    bins: int = tuned(32, "Bins of a curve.")
    fewest_in_bin: int = tuned(12, "Samples in a bin.", unit="samples")
    line_points: int = tuned(200, "Points of a law's line.")
    most_points: int = tuned(1500, "Samples drawn.")
    quartiles: tuple[float, float] = tuned((25.0, 75.0), "Band that holds the middle half of a bin.", "a definition", "%")
