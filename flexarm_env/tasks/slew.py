"""Slew: from rest to rest over 100°, thesis chapter 4."""

from __future__ import annotations

import math

from flexarm_env.tasks.task import Task

SLEW = Task(
    "slew",
    duration=5.0,
    target=math.radians(100.0),
    summary="Slew a flexible arm from rest to rest over 100°.",
    description="""\
Bring the arm to 100° fast, and leave it still. Once the hub sticks at the target, nothing but its own slight damping
calms the beam.""",
)
