"""Calibration of an arm's constants and effects against recordings."""
