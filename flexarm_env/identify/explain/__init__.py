"""Where a model fails, what drives it, and how small an effect the recordings would show."""
