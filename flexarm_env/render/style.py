"""Layout of the picture, and colours that a colour-blind reader can distinguish (Okabe and Ito, 2008)."""

from __future__ import annotations

SIZE = (640, 640)  # width, height [pixels]

PAPER = (250, 250, 248)
BENCH = (236, 236, 232)
RULE = (200, 200, 196)
QUIET = (95, 95, 95)
INK = (34, 34, 34)
BEAM = (0, 114, 178)
STUCK = (213, 94, 0)
FREE = (70, 70, 70)
TARGET = (0, 133, 96)
GAGE = (240, 200, 0)

HUB_AT = (240.0, 262.0)  # [pixels]
TABLE = (12.0, 42.0, 456.0, 440.0)  # left, top, width, height of the bench [pixels]
REACH = 163.0  # of a straight beam [pixels]
SCALE = 178.0  # radius of the scale of angles [pixels]
COLUMN = (484.0, 628.0)  # left and right of the column of readings [pixels]
PANEL = (52.0, 520.0, 576.0, 80.0)  # left, top, width, height of the strain's curve [pixels]
