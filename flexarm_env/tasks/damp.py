"""Damp: kill the vibration that a pulse of 3 A for 0.5 s leaves, thesis chapter 3."""

from __future__ import annotations

from flexarm_env.tasks.task import Task

# 3 A of the thesis's 5 A; the hub sticks within two seconds of the pulse's end.
DAMP = Task("damp", duration=5.0, pulse=0.6, pulse_time=0.5, coast=2.0, hold=True)
