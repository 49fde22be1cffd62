"""Forward sensitivities: derivatives of the readings with respect to constants, carried with the state through events."""
