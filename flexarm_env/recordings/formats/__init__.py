"""Formats of recording files: one module each."""
