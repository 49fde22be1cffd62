"""Recordings of an arm: read from files, checked, in SI."""
