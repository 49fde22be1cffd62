"""Replays of recordings through an arm, and their errors over the noise."""
