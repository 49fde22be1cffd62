"""Formats of recording files: one module each.

A module here that has a `FORMAT`, see `base.Format`, is a format: its suffix is read by all commands, taken from folders and
accepted by the lab. Nothing else names it.
"""
