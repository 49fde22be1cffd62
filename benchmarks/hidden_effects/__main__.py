"""Run the benchmark: python -m benchmarks.hidden_effects."""

from benchmarks.hidden_effects.calibrate import calibrate

calibrate(1, lambda t: print(t, flush=True))
