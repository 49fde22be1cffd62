"""Process noise, observers and forecasts of the corrected replay."""

from __future__ import annotations

from dataclasses import dataclass

from flexarm_env.identify.settings.number import tuned


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
        (1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6),
        "Candidates are screened at the first level at which errors exceed `screening.visible`: more feedback hides a small "
        "steady torque, less makes the errors of a model that is far off rough.",
        "at 0.01 alone small steady torques hid, and down to 3e-4 friction of 1e-5 of the drive's torque; no sweep recorded",
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
