"""Track: follow a square wave of ±50° at 0.2 Hz, thesis chapter 4."""

from __future__ import annotations

import math

from flexarm_env.tasks.task import Task

TRACK = Task(
    "track",
    duration=10.0,
    target=math.radians(50.0),
    half_period=2.5,
    summary="Follow a square wave of ±50° with a flexible arm.",
    description="""\
The target jumps from 50° to −50° and back, every 2.5 s (0.2 Hz). Each jump excites the beam anew, while the last
vibration still rings.""",
)
