"""Run the command line by `python -m flexarm_env.cli`."""

from flexarm_env.cli import main

main()
