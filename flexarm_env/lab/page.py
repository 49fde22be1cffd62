"""The lab's page: recordings, the overlay, effects to try, the diagnosis and its results."""

from __future__ import annotations

from collections.abc import Callable

from nicegui import html, ui

from flexarm_env.errors import InputError
from flexarm_env.lab.data_panel import DataPanel
from flexarm_env.lab.effects_panel import EffectsPanel
from flexarm_env.lab.inspection_panel import InspectionPanel
from flexarm_env.lab.results_panel import ResultsPanel
from flexarm_env.lab.session import INSPECTING, Session
from flexarm_env.lab.sessions import MOST_SESSIONS
from flexarm_env.lab.style import CSS, PRIMARY
from flexarm_env.lab.view_panel import ViewPanel
from flexarm_env.recordings.recording import Recording

#: Period [s] at which the page polls the session.
BEAT = 0.04
DROPPED = (
    f"the lab keeps the sessions of {MOST_SESSIONS} tabs, and another tab took the place of this one: its recordings and its "
    "work are gone; close some tabs, then reload this one"
)


class LabPage:
    """The page of one tab.

    Args:
        session: state of the tab.
        demo: reads the recordings of the demo.
    """

    def __init__(self, session: Session, demo: Callable[[], list[Recording]]) -> None:
        self.session, self.revision, self.is_over = session, session.revision, False
        ui.colors(primary=PRIMARY)
        ui.add_css(CSS)
        with html.div().classes("lab"):
            with html.div().classes("top"):
                html.h1("FlexArm lab")
                ui.label("where a model of an arm fails, and what it lacks").classes("hint")
            self.error_box = html.div().classes("complaint").props("role=alert")
            with html.div().classes("board"):
                with html.section().classes("data"):
                    with html.div().classes("card"):
                        self.data = DataPanel(session, demo, self._show_status, self.show_error, self.refresh)
                    self._diagnose_card()
                with html.section().classes("view"):
                    self.inspection = InspectionPanel(session, self.show_error, self._buttons)
                    self.results = ResultsPanel(session, self.show_error, self._refresh_arm)
                    with html.div().classes("card"):
                        self.view = ViewPanel(session, self.results.refresh)
                    self.results.place_below()
                with html.section().classes("choose card"):
                    html.h2("Effects")
                    ui.label("Tick and drag: the model is simulated anew at once.").classes("muted")
                    self.effects = EffectsPanel(session, self.view.touch, self.show_error)
        self.show_error("")
        self.refresh()
        ui.timer(BEAT, self._beat)

    def show_error(self, line: str) -> None:
        """Show one line on bad input; an empty line removes it."""
        self.error_box.clear()
        self.error_box.set_visibility(bool(line))
        if line:
            with self.error_box:
                ui.label(line)

    def refresh(self) -> None:
        """Show the session anew."""
        self.data.refresh()
        self.inspection.refresh()
        self.view.refresh()
        self._refresh_arm()

    def _refresh_arm(self) -> None:
        """Show the arm of a new step."""
        self.effects.refresh()
        self.view.touch()
        self.results.refresh(None)
        self._buttons()

    async def _beat(self) -> None:
        self._poll()
        await self.view.update()

    def _show_status(self, text: str) -> None:
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
        self.show_error("")
        try:
            self.session.diagnose()
        except InputError as error:
            self.show_error(str(error))
        self._buttons()

    def _stop(self) -> None:
        self.session.stop()
        self._show_status("stopped")
        self._buttons()

    def _buttons(self) -> None:
        busy = self.session.busy
        self.start.set_enabled(bool(self.session.recordings) and not busy)
        self.stopper.set_enabled(busy)
        self.bar.set_visibility(busy)
        self.results.enable(not busy)
        self.inspection.enable(not busy)

    def _poll(self) -> None:
        """Show progress and results of the current work."""
        if self.session.dropped and not self.is_over:
            self.is_over = True
            self.refresh()
            self._show_status("")
            self.show_error(DROPPED)
        self.session.poll()
        job = self.session.job
        if job is None or self.session.revision == self.revision:
            return
        self.revision = self.session.revision
        self.bar.set_value(job.share)
        if job.state == "running":
            self._show_status(f"{job.title}, {100.0 * job.share:.0f} %: {job.text}")
            return
        self._show_status(f"{job.title}: {job.state}")
        if job.state == "failed":
            self.show_error(job.text)
        elif isinstance(job.result, str):
            name = "inspection.html" if job.title == INSPECTING else "report.html"
            ui.download.content(job.result, name, "text/html")
        else:
            self._refresh_arm()
        self._buttons()
