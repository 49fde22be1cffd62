"""Faults put into recordings at random: the share that an inspection names, and its false alarms on sound recordings."""

from benchmarks.faults.measure import COUNT, SEED, measure

__all__ = ["COUNT", "SEED", "measure"]
