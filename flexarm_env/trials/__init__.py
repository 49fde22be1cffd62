"""Controllers and policies at work: sets of arms, one episode each, and measures of it."""
