"""Three recordings of a machine with an effect that the model lacks, and the loop that finds it.

The recordings come from a simulator in the tests that shares no code with the package:
`python -m tests.rig.make_case flexarm_env/demo --seed 11 --set gap=0.06`
"""
