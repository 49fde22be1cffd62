"""Three recordings with something hidden, and the loop that finds it.

The recordings come from a simulator in the tests that shares no code with the package:
`python -m tests.rig.make_case flexarm_env/demo --seed 11 --set gap=0.06`
"""
