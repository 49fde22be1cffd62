"""Controllers and policies at work: evaluation on fixed sets of arms."""
