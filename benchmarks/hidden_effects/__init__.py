"""Hidden effects: the share of machines for which a diagnosis names the effect that the model lacks.

The machine is the independent simulator of tests/rig. The model of every case may have wrong constants, and lacks one effect of
the catalogue, two, one from outside the catalogue, or none. A case consists of three recordings of 10 s, in the form of a real
rig's.
"""
