"""The lab's page: recordings, the overlay, effects to play with, the diagnosis and what comes of it."""

from __future__ import annotations

import contextlib
import time
from collections.abc import AsyncIterator, Callable

from nicegui import events, html, run, ui

from flexarm_env.arm import Arm
from flexarm_env.arm_file import shipped_arms
from flexarm_env.errors import InputError
from flexarm_env.identify.recording import Recording
from flexarm_env.identify.results import Diagnosis
from flexarm_env.lab.effects_panel import EffectsPanel
from flexarm_env.lab.guard import LARGEST_BODY
from flexarm_env.lab.live import Simulated
from flexarm_env.lab.overlay import moved, overlay
from flexarm_env.lab.results_panel import ResultsPanel
from flexarm_env.lab.session import Session
from flexarm_env.lab.style import CSS, PRIMARY
from flexarm_env.lab.uploads import MOST_RECORDINGS
from flexarm_env.pictures import words

DEMO_ARM = "thesis-fem"
#: How often [s] the page looks what is new; how long nothing must change before the held-out error is worked out.
BEAT, SETTLED = 0.04, 0.6


class LabPage:
    """The page of one tab.

    Args:
        session: what the tab has.
        demo: the recordings of the demo.
    """

    def __init__(self, session: Session, demo: Callable[[], list[Recording]]) -> None:
        self.session, self.demo = session, demo
        self.given: Simulated | None = None
        self.now: Simulated | None = None
        self.changed_at: float | None = None
        self.simulating = self.scoring = False
        self.held_out: float | None = None
        self.stale = False
        ui.colors(primary=PRIMARY)
        ui.add_css(CSS)
        with html.div().classes("lab"):
            with html.div().classes("top"):
                html.h1("FlexArm lab")
                ui.label("where a model of an arm fails, and what it lacks").classes("hint")
            self.complaint = html.div().classes("complaint").props("role=alert")
            with html.div().classes("board"):
                with html.section().classes("data"):
                    self._data_card()
                    self._diagnose_card()
                with html.section().classes("view"):
                    self._view()
                with html.section().classes("choose card"):
                    html.h2("Effects")
                    ui.label("Tick and drag: the model is simulated anew at once.").classes("muted")
                    self.effects = EffectsPanel(session, self._touched, self.complain)
        self.complain("")
        self.refresh()
        ui.timer(BEAT, self._beat)

    def complain(self, line: str) -> None:
        """Show one line that says what is wrong, or take it away."""
        self.complaint.clear()
        self.complaint.set_visibility(bool(line))
        if line:
            with self.complaint:
                ui.label(line)

    def refresh(self) -> None:
        """Show the session anew."""
        self._list_files()
        self.effects.refresh()
        self._choose_recordings()
        self.given = self.now = None
        self.held_out = None
        self._touched()
        self._buttons()
        self.results.refresh(None)

    # Recordings

    def _data_card(self) -> None:
        with html.div().classes("card"):
            html.h2("Recordings")
            self.upload = ui.upload(
                multiple=True,
                auto_upload=True,
                max_file_size=LARGEST_BODY,
                max_files=MOST_RECORDINGS,
                on_multi_upload=self._uploaded,
                on_rejected=lambda: self.complain(
                    f"not taken: at most {MOST_RECORDINGS} files at once, of {LARGEST_BODY // 2**20} MB each"
                ),
            )
            _drop_zone(self.upload)
            self.files = html.ul().classes("files")
            with html.div().classes("row"):
                ui.button("Start with the demo", on_click=self._start_demo).props("outline")
            arms = sorted({*shipped_arms(), self.session.base.name})
            self.arm_choice = ui.select(arms, label="Arm", value=self.session.base.name, on_change=self._change_arm)

    async def _uploaded(self, event: events.MultiUploadEventArguments) -> None:
        lines = []
        async with self._reading():
            for file in event.files:
                try:
                    await run.io_bound(self.session.upload, file.name, await file.read())
                except InputError as error:
                    lines.append(str(error))
            self.upload.reset()
            if lines:
                raise InputError(" — ".join(lines))

    async def _start_demo(self) -> None:
        async with self._reading():
            if self.session.base.name != DEMO_ARM:
                self.session.use([])
                self.session.change_arm(Arm.load(DEMO_ARM, self.session.base.known))
                self.arm_choice.set_value(DEMO_ARM)
            await run.io_bound(lambda: self.session.use(self.demo()))

    async def _change_arm(self) -> None:
        name = str(self.arm_choice.value)
        if name == self.session.base.name:
            return
        async with self._reading():
            try:
                await run.io_bound(self.session.change_arm, Arm.load(name, self.session.base.known))
            finally:
                self.arm_choice.set_value(self.session.base.name)

    @contextlib.asynccontextmanager
    async def _reading(self) -> AsyncIterator[None]:
        """Say that files are read, and show what came of it."""
        self.complain("")
        self.doing.set_text("Reading and simulating …")
        try:
            yield
        except InputError as error:
            self.complain(str(error))
        finally:
            self.doing.set_text("")
            self.refresh()

    def _list_files(self) -> None:
        self.files.clear()
        with self.files:
            for one in self.session.recordings:
                with html.li():
                    ui.label(f"{one.name}: {one.duration:.3g} s at {1.0 / one.sample_time:.4g} Hz")
                    button = ui.button(icon="close", on_click=lambda _, one=one: self._remove(one)).props("flat dense round")
                    button.props(f'aria-label="remove {one.name}"')

    async def _remove(self, gone: Recording) -> None:
        async with self._reading():
            await run.io_bound(self.session.use, [one for one in self.session.recordings if one is not gone])

    # The overlay

    def _view(self) -> None:
        self.results = ResultsPanel(self.session, self.complain, self._added)
        with html.div().classes("card"):
            with html.div().classes("tiles"):
                self.tiles = [self._tile(what) for what in ("one free run, all samples", "windows of 1 s, held out")]
            ui.label("Error over the noise, as given → now; 1 is perfect.").classes("muted")
            self.recording_choice = ui.toggle([], on_change=self._draw).props("no-caps dense")
            self.place = html.div()
            self.empty = ui.label("No recordings yet: drop CSV files in, or start with the demo.").classes("muted")
        self.results.place_below()

    def _tile(self, what: str) -> ui.label:
        with html.div().classes("tile"):
            number = ui.label(words.NOTHING).classes("number")
            ui.label(what).classes("what")
        return number

    def _choose_recordings(self) -> None:
        names = [one.name for one in self.session.recordings]
        value = self.recording_choice.value if self.recording_choice.value in names else next(iter(names), None)
        self.recording_choice.set_options(names, value=value)
        self.recording_choice.set_visibility(bool(names))
        self.empty.set_visibility(not names)
        if not names:
            self.place.clear()

    def _draw(self) -> None:
        live, given, now = self.session.live, self.given, self.now
        name = self.recording_choice.value
        if live is None or given is None or now is None or name not in now.readings:
            return
        shown = next(one for one in live.data.runs if one.name == name)
        self.place.clear()
        with self.place:
            self.plot = ui.plotly(overlay(shown, live.signals, given.readings[name], now.readings[name])).classes("plot")
        self._numbers()

    def _numbers(self) -> None:
        free = [None if one is None else one.error for one in (self.given, self.now)]
        first = self.session.steps[0][1] if self.session.steps else None
        for tile, pair in zip(self.tiles, (free, [first, self.held_out]), strict=True):
            given, now = (words.NOTHING if value is None else words.number(value) for value in pair)
            tile.set_text(f"{given} → {now}")

    def _touched(self) -> None:
        self.stale, self.changed_at = True, time.monotonic()

    # What goes on

    async def _beat(self) -> None:
        self._watch()
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
            if self.given is None:
                self.given = await run.io_bound(live.simulate, self.session.base)
            first, self.now = self.now is None, await run.io_bound(live.simulate, draft)
        finally:
            self.simulating = False
        if live is not self.session.live:
            self.stale = True
        elif first:
            self._draw()
        else:
            self.plot.run_plot_method("restyle", *moved(live.signals, self.now.readings[str(self.recording_choice.value)]))
            self.held_out = None
            self._numbers()

    async def _score(self) -> None:
        live, draft, self.scoring, self.changed_at = self.session.live, self.session.draft, True, None
        try:
            if live is not None:
                found = await run.io_bound(live.held_out, draft)
                if draft is self.session.draft and live is self.session.live:
                    self.held_out = found.windows
                    self._numbers()
                    self.results.refresh(found.windows)
        finally:
            self.scoring = False

    # Diagnose

    def _diagnose_card(self) -> None:
        with html.div().classes("card"):
            html.h2("Diagnose")
            with html.div().classes("row"):
                self.start = ui.button("Diagnose", on_click=self._diagnose)
                self.stopper = ui.button("Stop", on_click=self._stop).props("outline")
            self.bar = ui.linear_progress(0.0, show_value=False).props('aria-label="progress" instant-feedback')
            self.doing = ui.label("").classes("muted").props("role=status")

    def _diagnose(self) -> None:
        self.complain("")
        try:
            self.session.diagnose()
        except InputError as error:
            self.complain(str(error))
        self._buttons()

    def _stop(self) -> None:
        self.session.stop()
        self.doing.set_text("stopped")
        self._buttons()

    def _buttons(self) -> None:
        busy = self.session.busy
        self.start.set_enabled(bool(self.session.recordings) and not busy)
        self.stopper.set_enabled(busy)
        self.bar.set_visibility(busy)
        self.results.enable(not busy)

    def _watch(self) -> None:
        """Take in what the work under way has said."""
        job = self.session.job
        if job is None or not job.poll():
            return
        self.bar.set_value(job.share)
        self.doing.set_text(f"{job.title}: {job.text}" if job.state == "running" else "")
        if job.state == "running":
            return
        result = self.session.finish()
        if job.state == "failed":
            self.complain(job.text)
        elif isinstance(result, str):
            ui.download.content(result, "report.html", "text/html")
        else:
            self.doing.set_text(f"{job.title}: done" if isinstance(result, Diagnosis) else "")
            self._added()
        self._buttons()

    def _added(self) -> None:
        """Show the arm of a new step."""
        self.effects.refresh()
        self._touched()
        self.results.refresh(None)
        self._buttons()


def _drop_zone(upload: ui.upload) -> None:
    """Build a labelled place to drop files at, which hands them to an upload that is not shown.

    That upload's own button is one control within another, which a screen reader cannot tell apart.
    """
    take = f"getElement({upload.id}).$refs.qRef.addFiles"
    with html.label().classes("drop") as zone:
        ui.label("Drop CSV files here, or choose some")
        chosen = html.input(type="file", multiple=True, accept=".csv,.txt,.dat,.mat")
    chosen.on("change", js_handler=f"(e) => {{ {take}([...e.target.files]); e.target.value = '' }}")
    mark = "e.currentTarget.classList"
    zone.on("dragover", js_handler=f"(e) => {{ e.preventDefault(); {mark}.add('over') }}")
    zone.on("dragleave", js_handler=f"(e) => {mark}.remove('over')")
    zone.on("drop", js_handler=f"(e) => {{ e.preventDefault(); {mark}.remove('over'); {take}([...e.dataTransfer.files]) }}")
