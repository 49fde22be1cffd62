"""Search for a controller's options, and the margins of its loop."""
