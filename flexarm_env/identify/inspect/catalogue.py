"""The checks of recordings that need no model, in their order: each sees what those before it have mended."""

from __future__ import annotations

from collections.abc import Callable

from flexarm_env.arm import Arm
from flexarm_env.identify.inspect.constant import constant
from flexarm_env.identify.inspect.dropout import dropout
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.inspect.frozen import frozen
from flexarm_env.identify.inspect.glued import glued
from flexarm_env.identify.inspect.held import held
from flexarm_env.identify.inspect.limit import limit
from flexarm_env.identify.inspect.rail import rail
from flexarm_env.identify.inspect.series import Inspected
from flexarm_env.identify.inspect.spike import spike
from flexarm_env.identify.inspect.wrap import wrap
from flexarm_env.identify.settings import Inspecting

#: A check takes a recording with its noise, the arm and the numbers of the inspection.
Check = Callable[[Inspected, Arm, Inspecting], list[Fault]]

CHECKS: tuple[Check, ...] = (constant, limit, wrap, held, dropout, spike, glued, rail, frozen)
