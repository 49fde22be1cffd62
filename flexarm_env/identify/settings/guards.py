"""Numbers that keep a quotient, an exponential or an error finite. They tune nothing."""

from __future__ import annotations

#: Error over noise of a reading that is not finite: any large finite number.
FAILED_ERROR = 1e6
#: Smallest excess of an error and smallest command [A or V], so that ratios to them stay finite.
LEAST_EXCESS = LEAST_COMMAND = 1e-9
#: Largest logarithm of a value over its origin, so that the exponential stays finite.
LARGEST_LOG = 20.0
#: Smallest frequency [Hz] that divides: of an arm that does not vibrate.
LEAST_FREQUENCY = 1e-9
#: Weight of a group of lead times without readings.
LEAST_COUNT = 1e-9
#: Smallest norm that divides.
LEAST_NORM = 1e-300
