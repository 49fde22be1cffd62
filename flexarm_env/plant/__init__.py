"""The plant: finite elements, exact linear propagation, stick-slip, in one numba kernel."""
