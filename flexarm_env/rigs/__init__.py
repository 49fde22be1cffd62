"""Real rigs: recordings that others published, diagnosed with the maker's model, beside the published figure."""
