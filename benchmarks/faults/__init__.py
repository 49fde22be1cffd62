"""Faults of recordings: the share of those put in at random that an inspection names, and its false alarms.

Machines are drawn around four shipped arms. Each gives three recordings, into which one fault of a random size is put.
"""
