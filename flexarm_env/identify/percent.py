"""Shares as text."""

from __future__ import annotations

import math

#: Decimals of a share in percent.
MOST_DIGITS = 3


def percent(share: float) -> str:
    """Format a share with the digits that tell it from 0 and 1: "57 %", "99.4 %", "0.02 %"."""
    apart = min(abs(share), abs(1.0 - share))
    digits = max(0, math.ceil(-math.log10(apart)) - 2) if apart else 0
    if digits > MOST_DIGITS:
        return f"{100 * round(share)} %"
    return f"{100 * share:.{digits}f} %".replace("-", "−")
