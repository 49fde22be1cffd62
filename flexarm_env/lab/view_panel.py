"""Panel of the overlay of measured and modelled signals, which follows every change of the arm, and of the error."""

from __future__ import annotations

import time
from collections.abc import Callable

from nicegui import html, run, ui

from flexarm_env.lab.chart import Chart
from flexarm_env.lab.live import Simulated
from flexarm_env.lab.overlay import moved, overlay
from flexarm_env.lab.session import Session
from flexarm_env.pictures import words

#: Time [s] without changes after which the held-out error is computed.
SETTLED = 0.6
FIRST_STEPS = (
    "Drop recordings of the arm in, or start with the demo: you see them beside the model.",
    "Tick effects and drag their sizes: the model follows at once.",
    "Diagnose: it names the effect that the model lacks. Add it, and watch the error fall.",
)


class ViewPanel:
    """Replays of a session's arm beside its recordings.

    Args:
        session: that holds arm and recordings.
        scored: called with the held-out error once it is computed.
    """

    def __init__(self, session: Session, scored: Callable[[float | None], None]) -> None:
        self.session, self.scored = session, scored
        self.given: Simulated | None = None
        self.now: Simulated | None = None
        self.held_out: float | None = None
        self.changed_at: float | None = None
        self.stale = self.simulating = self.scoring = False
        with html.div().classes("tiles") as self.top:
            self.tiles = [_tile(what) for what in ("one free run, all samples", "windows of 1 s, held out")]
            ui.label("Error over the noise, as given → now; 1 is perfect.").classes("muted")
        self.choice = ui.toggle([], on_change=self._draw).props("no-caps dense")
        self.chart = Chart()
        with html.ol().classes("empty") as self.empty:
            for step in FIRST_STEPS:
                html.li(step)

    def refresh(self) -> None:
        """Start over with the session's recordings."""
        names = [one.name for one in self.session.recordings]
        self.given = self.now = self.held_out = None
        self.choice.set_options(names, value=self.choice.value if self.choice.value in names else next(iter(names), None))
        for shown, element in ((bool(names), self.choice), (bool(names), self.top), (not names, self.empty)):
            element.set_visibility(shown)
        if not names:
            self.chart.clear()
        self.touch()

    def touch(self) -> None:
        """Mark the arm as changed."""
        self.stale, self.changed_at = True, time.monotonic()

    async def update(self) -> None:
        """Simulate the arm after a change; compute its held-out error once changes have ceased."""
        if self.session.live is None:
            return
        if self.stale and not self.simulating:
            await self._simulate()
        elif self.changed_at and time.monotonic() - self.changed_at > SETTLED and not self.scoring:
            await self._score()

    async def _simulate(self) -> None:
        live, draft, self.simulating, self.stale = self.session.live, self.session.draft, True, False
        try:
            if live is None:
                return
            given = self.given or await run.io_bound(live.simulate, self.session.base)
            now = await run.io_bound(live.simulate, draft)
        finally:
            self.simulating = False
        if live is not self.session.live:
            self.stale = True
            return
        first, self.given, self.now, self.held_out = self.now is None, given, now, None
        shown = self.choice.value
        if first or shown not in now.readings or not self.chart.restyle(*moved(live.signals, now.readings[shown])):
            self._draw()
        self._numbers()

    async def _score(self) -> None:
        live, draft, self.scoring, self.changed_at = self.session.live, self.session.draft, True, None
        try:
            found = None if live is None else await run.io_bound(live.held_out, draft)
        finally:
            self.scoring = False
        if found is not None and draft is self.session.draft and live is self.session.live:
            self.held_out = found.windows
            self._numbers()
            self.scored(found.windows)

    def _draw(self) -> None:
        live, given, now, name = self.session.live, self.given, self.now, self.choice.value
        if live is None or given is None or now is None or name not in now.readings:
            return
        shown = next(one for one in live.data.runs if one.name == name)
        self.chart.show(overlay(shown, live.signals, given.readings[name], now.readings[name]))

    def _numbers(self) -> None:
        free = [None if one is None else one.error for one in (self.given, self.now)]
        first = self.session.steps[0][1] if self.session.steps else None
        for tile, pair in zip(self.tiles, (free, [first, self.held_out]), strict=True):
            given, now = ("…" if value is None else words.number(value) for value in pair)
            tile.set_text(f"{given} → {now}")


def _tile(what: str) -> ui.label:
    with html.div().classes("tile"):
        number = ui.label(words.NOTHING).classes("number")
        ui.label(what).classes("what")
    return number
