"""Drive and gains of the thesis's rig, by which commands, gains and ranges are scaled to other arms."""

from __future__ import annotations

#: Largest current of the drive [A] (thesis section 4.2) and gear ratio (Table A.1).
LIMIT, GEAR_RATIO = 5.0, 1.5
#: PD gains on the arm's angle [A/rad] and on the motor's speed [A s/rad] (thesis section 2.3, Fig. 2.6).
PROPORTIONAL, DERIVATIVE = 2.5308, 0.6625
