"""Experiments: recordings that a model makes, and the one to make next on the machine."""
