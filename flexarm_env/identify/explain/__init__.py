"""Where a model fails, the driver of its error, and the smallest effect that the recordings would show."""
