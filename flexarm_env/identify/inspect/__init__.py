"""What recordings hold, before any model is calibrated: signals, noise, excitation, and faults of sensors and files."""
