"""Machines drawn at random: the share for which a diagnosis is right, whatever their size, drive and sensors.

A case is an arm as given, one to three recordings of a machine that differs from it, and the difference. The machine is simulated
by tests/rig, which shares no code with the package. `benchmarks.machines.cases.case` makes one.
"""
