"""Endurance of the environments: steps by the hundred million, each of which must end soon, with finite numbers."""
