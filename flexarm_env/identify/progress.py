"""Progress of long work, split into spans so that no stage has to know where it stands in the whole."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

ProgressCallback = Callable[[float, str], None]


def _silent(done: float, text: str) -> None:
    """ProgressCallback nothing."""


@dataclass(frozen=True)
class Progress:
    """One span of the whole work.

    Attributes:
        report: called with the share of the whole that is done, 0 to 1, and a text.
        start: share of the whole at which the span begins.
        end: share at which it ends.

    Example:
        >>> screening, fitting = Progress(lambda done, text: print(f"{done:.2f} {text}")).split(1, 3)
        >>> screening.at(0.5, "screening")
        0.12 screening
        >>> fitting.at(0.0, "fitting")
        0.25 fitting
    """

    report: ProgressCallback = _silent
    start: float = 0.0
    end: float = 1.0

    @classmethod
    def to(cls, report: ProgressCallback | None) -> Progress:
        """ProgressCallback to a function, or nowhere."""
        return cls() if report is None else cls(report)

    def at(self, done: float, text: str) -> None:
        """ProgressCallback the share of this span that is done."""
        self.report(self.start + done * (self.end - self.start), text)

    def split(self, *weights: int) -> tuple[Progress, ...]:
        """Split into consecutive spans, with lengths in proportion to the weights."""
        total, before, spans = sum(weights), 0, []
        for weight in weights:
            spans.append(Progress(self.report, self._share(before / total), self._share((before + weight) / total)))
            before += weight
        return tuple(spans)

    def _share(self, done: float) -> float:
        return self.start + done * (self.end - self.start)
