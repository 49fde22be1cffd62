"""An independent truth simulator of the thesis's arm, and of machines of other sizes.

It shares no code with the package that it tests.

A beam of finite elements in its clamped modes, a rotor and an arm hub joined by a stiff gear mesh, dry friction on
each of the two with exact sticking, position Verlet at 10 µs, and the sensors' noise and rounding. Driven by the
recorded currents it repeats the practice recordings to their noise.

Conventions: arm-side units unless said; strain = gain · EI y″ with y measured from the hub's line, so a positive
torque first gives a negative base strain; a command is held until the next sample; the static budget counts at
exactly zero speed only.

Settings (`<constant>_x` scales a constant; CATALOGUE says which effect each one is, OUTSIDE what is in no catalogue):

    name            null      unit     meaning
"""

import sys

# numba's cache looks a kernel up by the name of the module that compiled it, and this folder is `rig` to the tests
# and `tests.rig` to the command. So simulate.py imports the kernel by a third name, always the same.
sys.modules.setdefault("truth_rig", sys.modules[__name__])

from .catalogue import CATALOGUE, EXAMPLES, OUTSIDE  # noqa: E402
from .experiments import Plan  # noqa: E402
from .recordings import FLOOR, read_recording, replay, write_case  # noqa: E402
from .settings import table  # noqa: E402
from .simulate import READINGS, SIGNALS, TRUTHS, perform, simulate  # noqa: E402

__doc__ += table()
__all__ = [
    "CATALOGUE",
    "EXAMPLES",
    "FLOOR",
    "OUTSIDE",
    "READINGS",
    "SIGNALS",
    "TRUTHS",
    "Plan",
    "perform",
    "read_recording",
    "replay",
    "simulate",
    "write_case",
]
