"""Selection of the effects that a model lacks."""
