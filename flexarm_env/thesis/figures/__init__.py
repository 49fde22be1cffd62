"""The figures as data, by chapter of the thesis."""

from __future__ import annotations

from collections.abc import Callable

from flexarm_env.thesis.figures import appendix, chapter2, chapter3, chapter4
from flexarm_env.thesis.sheet import Sheet

CHAPTERS: dict[str, Callable[[], list[Sheet]]] = {
    "chapter 2": chapter2.sheets,
    "chapter 3": chapter3.sheets,
    "chapter 4": chapter4.sheets,
    "Appendix A": appendix.sheets,
}
