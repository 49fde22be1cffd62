"""Panel of what the recordings hold: faults first, then signals and command in numbers and curves."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from nicegui import html, ui

from flexarm_env.errors import InputError
from flexarm_env.lab.chart import Chart
from flexarm_env.lab.session import Session
from flexarm_env.pictures import inspection_figures, inspection_words


class InspectionPanel:
    """Faults and signals of a session's recordings.

    Args:
        session: that holds the recordings.
        show_error: called with one line where a request is refused.
        started: called when the work on the page has begun.
    """

    def __init__(self, session: Session, show_error: Callable[[str], None], started: Callable[[], None]) -> None:
        self.session, self.show_error, self.started = session, show_error, started
        with html.div().classes("card") as self.card:
            html.h2("What the recordings hold")
            self.sentence = ui.label().props("role=status")
            self.faults = html.ul().classes("faults")
            with ui.expansion("Signals", on_value_change=self._draw).props("dense").classes("signals") as self.more:
                self.table = html.div().classes("scroll").props("tabindex=0")
                self.choice = ui.toggle([], on_change=self._draw).props("no-caps dense")
                self.chart = Chart()
                self.page = ui.button("Page with all that they can show", on_click=self._page).props("outline").classes("q-mt-sm")

    def refresh(self) -> None:
        """Show the session's recordings."""
        found, recordings = self.session.inspection, self.session.recordings
        self.card.set_visibility(found is not None)
        self.faults.clear()
        self.table.clear()
        self.chart.clear()
        names = [one.name for one in recordings]
        if found is None:
            self.choice.set_options(names)
            return
        self.sentence.set_text(inspection_words.faults_sentence(found.faults, recordings))
        with self.faults:
            for fault in found.faults:
                with html.li():
                    ui.label(f"{fault.recording}: {fault.message}")
                    if fault.hint:
                        html.code(fault.hint)
        with self.table:
            _table(inspection_words.EXTENTS, inspection_words.extents(recordings))
            _table(inspection_words.SIGNALS, inspection_words.signals(self.session.base, recordings, found))
        worst = next((fault.recording for fault in found.faults), names[0])
        self.choice.set_options(names, value=worst)
        self._draw()

    def enable(self, free: bool) -> None:
        """Enable or disable the button that starts work."""
        self.page.set_enabled(free)

    def _draw(self) -> None:
        found = self.session.inspection
        shown = next((one for one in self.session.recordings if one.name == self.choice.value), None)
        if found is None or shown is None or not self.more.value:
            self.chart.clear()
            return
        self.chart.show(inspection_figures.signals(shown, found.faults))

    def _page(self) -> None:
        self.show_error("")
        try:
            self.session.write_inspection()
        except InputError as error:
            self.show_error(str(error))
        self.started()


def _table(columns: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    with html.table():
        with html.tr():
            for column in columns:
                html.th(column).props("scope=col")
        for row in rows:
            with html.tr():
                for cell in row:
                    html.td(cell)
