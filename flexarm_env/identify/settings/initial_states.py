"""How the state at the start of a recording is estimated."""

from __future__ import annotations

from dataclasses import dataclass

from flexarm_env.identify.settings.number import tuned

#: Origin of several numbers.
START_FITS = (
    "with the fit of the start: simulated runs cut while driven, moving and vibrating, and cu-flexible; no sweep recorded"
)


@dataclass(frozen=True)
class InitialStates:
    """How the state at the start of a recording is estimated."""

    still: float = tuned(10.0, "A hub within this multiple of the noise of its first angle is still.", START_FITS)
    held_time: float = tuned(0.1, "A hub that is still for this long counts as held.", START_FITS, "s")
    vibrates: float = tuned(2.0, "A beam signal of a held hub that scatters by this multiple of its noise vibrates.", START_FITS)
    significant: float = tuned(
        6.0,
        "Multiple of the standard deviation at which a start differs from rest.",
        "taken from an earlier test for a deflected beam; how it was found there is not known",
    )
    at_rest: float = tuned(3.0, "A first speed within this multiple of the noise is one of rest.")
    at_zero: float = tuned(4.0, "A first angle within this multiple of the noise is zero.")
    first_samples: int = tuned(20, "Samples of the parabola from which a moving hub's speed is estimated.", START_FITS, "samples")
    first_time: float = tuned(0.004, "Stretch whose mean shows a deflected beam.", unit="s")
    longest_held: float = tuned(0.5, "Longest stretch that the state of a held hub is fitted to.", START_FITS, "s")
    longest_moving: float = tuned(0.15, "Longest stretch that the state of a moving hub is fitted to.", START_FITS, "s")
    fewest: int = tuned(
        3, "Shortest stretch.", "Appendix A's printed tables, sampled slowly, need samples for the start", "samples"
    )
    iterations: int = tuned(3, "Gauss–Newton steps.", START_FITS)
    difference: float = tuned(1e-4, "Step of the differences, in unit-energy coordinates.", START_FITS)
    gain: float = tuned(0.999, "A step that leaves more than this share of the cost ends the iterations.")
    modes: int = tuned(4, "Modes of the beam that may vibrate.", START_FITS)
    faster_modes: float = tuned(0.3, "Expected size of the faster modes over that of the first.", START_FITS)
    least_size: float = tuned(1e-12, "Smallest expected size of a mode.", "guards a division")
    least_seen: float = tuned(
        1e-4, "Directions that the stretch shows less than this, over the best shown one, stay at rest.", START_FITS
    )
