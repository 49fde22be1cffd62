"""The lab's page: recordings, the overlay, effects to play with, the diagnosis and what comes of it."""

from __future__ import annotations

from collections.abc import Callable

from nicegui import html, ui

from flexarm_env.errors import InputError
from flexarm_env.lab.data_panel import DataPanel
from flexarm_env.lab.effects_panel import EffectsPanel
from flexarm_env.lab.results_panel import ResultsPanel
from flexarm_env.lab.session import Session
from flexarm_env.lab.style import CSS, PRIMARY
from flexarm_env.lab.view_panel import ViewPanel
from flexarm_env.recordings.recording import Recording

#: How often [s] the page looks what is new.
BEAT = 0.04


class LabPage:
    """The page of one tab.

    Args:
        session: what the tab has.
        demo: returns the recordings of the demo.
    """

    def __init__(self, session: Session, demo: Callable[[], list[Recording]]) -> None:
        self.session, self.news = session, session.news
        ui.colors(primary=PRIMARY)
        ui.add_css(CSS)
        with html.div().classes("lab"):
            with html.div().classes("top"):
                html.h1("FlexArm lab")
                ui.label("where a model of an arm fails, and what it lacks").classes("hint")
            self.complaint = html.div().classes("complaint").props("role=alert")
            with html.div().classes("board"):
                with html.section().classes("data"):
                    with html.div().classes("card"):
                        self.data = DataPanel(session, demo, self._say, self.complain, self.refresh)
                    self._diagnose_card()
                with html.section().classes("view"):
                    self.results = ResultsPanel(session, self.complain, self._stepped)
                    with html.div().classes("card"):
                        self.view = ViewPanel(session, self.results.refresh)
                    self.results.place_below()
                with html.section().classes("choose card"):
                    html.h2("Effects")
                    ui.label("Tick and drag: the model is simulated anew at once.").classes("muted")
                    self.effects = EffectsPanel(session, self.view.touch, self.complain)
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
        self.data.refresh()
        self.view.refresh()
        self._stepped()

    def _stepped(self) -> None:
        """Show the arm of a new step."""
        self.effects.refresh()
        self.view.touch()
        self.results.refresh(None)
        self._buttons()

    async def _beat(self) -> None:
        self._watch()
        await self.view.beat()

    def _say(self, text: str) -> None:
        self.doing.set_text(text)

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
        self._say("stopped")
        self._buttons()

    def _buttons(self) -> None:
        busy = self.session.busy
        self.start.set_enabled(bool(self.session.recordings) and not busy)
        self.stopper.set_enabled(busy)
        self.bar.set_visibility(busy)
        self.results.enable(not busy)

    def _watch(self) -> None:
        """Show what the work under way has said."""
        self.session.poll()
        job = self.session.job
        if job is None or self.session.news == self.news:
            return
        self.news = self.session.news
        self.bar.set_value(job.share)
        if job.state == "running":
            self._say(f"{job.title}, {100.0 * job.share:.0f} %: {job.text}")
            return
        self._say(f"{job.title}: {job.state}")
        if job.state == "failed":
            self.complain(job.text)
        elif isinstance(job.result, str):
            ui.download.content(job.result, "report.html", "text/html")
        else:
            self._stepped()
        self._buttons()
