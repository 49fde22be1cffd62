"""Controllers and policies at work: evaluation on fixed sets of arms."""

import sys

if sys.argv[:1] == ["-m"]:  # of `python -m agents.…`, whose imports take seconds
    from flexarm_env.terminal.program import end_at_once

    end_at_once()
