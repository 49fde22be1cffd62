"""Hidden effects: how often a diagnosis names the effect that a machine has and its model lacks.

The machine is the independent simulator of tests/rig. Every case hides one effect of the catalogue, two, one that the
catalogue does not hold, or nothing but wrong constants; it is three recordings of 10 s, in the form of a real rig's.
"""
