"""Time of a diagnosis by stage, and its residuals and replays, for fixed cases."""
