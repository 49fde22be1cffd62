"""Damp: end the vibration that a pulse of 3 A for 0.5 s leaves, thesis chapter 3."""

from __future__ import annotations

from flexarm_env.tasks.task import Task

DAMP = Task(
    "damp",
    duration=5.0,
    pulse=0.6,  # 3 A of the thesis's 5 A; the hub sticks within two seconds of the pulse's end
    pulse_time=0.5,
    coast=2.0,
    hold=True,
    summary="Damp the vibration that a pulse has left in a flexible arm.",
    description="""\
After a pulse (3 A for the thesis's arm) the hub has stuck, and the beam, clamped by it, rings on. To damp it the hub has
to break away, work against the beam, and come to rest again where it was.""",
)
