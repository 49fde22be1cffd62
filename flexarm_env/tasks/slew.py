"""Slew: from rest to rest over 100°, thesis chapter 4."""

from __future__ import annotations

import math

from flexarm_env.tasks.task import Task

SLEW = Task("slew", duration=5.0, target=math.radians(100.0))
