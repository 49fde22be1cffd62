"""Speed and accuracy against other solvers, measured in one run: `python -m benchmarks`."""

import os
import sys

if sys.argv[:1] == ["-m"]:  # of `python -m benchmarks…`, whose imports take seconds
    # The matrices are small: threads inside BLAS cost more than they save, for the peers as well. numpy reads these once.
    for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(variable, "1")
    from flexarm_env.terminal.program import end_at_once

    end_at_once()
