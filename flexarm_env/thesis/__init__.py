"""Reproduction of the thesis: its claims, its figures, its misprints and the effect of each."""
