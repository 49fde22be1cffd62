"""Three recordings with something hidden, and the loop that finds it."""
