"""From recordings to a verdict on the model."""
