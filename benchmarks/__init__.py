"""Speed and accuracy against other solvers, measured in one run: `python -m benchmarks`."""
