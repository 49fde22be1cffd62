"""Panel of the verdict, the ranking with its buttons, the error after each step, and the downloads."""

from __future__ import annotations

from collections.abc import Callable

from nicegui import html, ui

from flexarm_env.errors import InputError
from flexarm_env.identify.results import Candidate
from flexarm_env.lab.chart import Chart
from flexarm_env.lab.session import Session
from flexarm_env.pictures import bars, words

RANKED = 7


class ResultsPanel:
    """Results of the steps so far: the verdict above the overlay, the rest below it.

    Args:
        session: that holds the results.
        show_error: called with one line where a request is refused.
        added: called when an effect has been added.
    """

    def __init__(self, session: Session, show_error: Callable[[str], None], added: Callable[[], None]) -> None:
        self.session, self.show_error, self.added = session, show_error, added
        self.buttons: list[ui.button] = []
        with html.div().classes("card") as self.verdict_card:
            self.verdict = ui.label().classes("verdict").props("role=status")
            self.taker = ui.button("Add", on_click=self._adopt).classes("q-mt-sm")

    def place_below(self) -> None:
        """Build the part below the overlay."""
        with html.div().classes("results") as self.below:
            with html.div().classes("card"):
                html.h2("Held-out error after each step")
                self.fall = Chart()
            with html.div().classes("card") as self.ranking_card:
                html.h2("Which effect")
                self.ranking = html.div()
            with html.div().classes("card"):
                html.h2("Take home")
                with html.div().classes("row"):
                    ui.button("Arm file", on_click=self._arm_file).props("outline")
                    self.report = ui.button("Report", on_click=self._report).props("outline")
                    self.next_run = ui.button("Next run", on_click=self._next_run).props("outline")
                self.why = ui.label().classes("muted")

    def refresh(self, held_out: float | None) -> None:
        """Show the session's results.

        Args:
            held_out: error of the current arm, once it is computed.
        """
        found = self.session.diagnosis
        self.verdict_card.set_visibility(found is not None)
        self.ranking_card.set_visibility(found is not None and bool(found.ranking))
        self.below.set_visibility(bool(self.session.recordings))
        if found is not None:
            self.verdict.set_text(words.verdict(found))
            names = " and ".join(name.replace("_", " ") for name in found.effects)
            self.taker.set_text(f"Add {names}" if names else "Take the refitted constants")
        self.taker.set_visibility(self.session.can_adopt)
        self._rank()
        steps = list(self.session.steps)
        if held_out is not None and self.session.draft != self.session.arm:
            steps.append(("by hand", held_out))
        if steps:
            self.fall.show(bars.waterfall(steps))
        else:
            self.fall.clear()
        proposal = found.next_run if found is not None else None
        self.next_run.set_visibility(proposal is not None)
        self.why.set_text(proposal.why if proposal is not None else "")

    def enable(self, free: bool) -> None:
        """Enable or disable the buttons that start work."""
        for button in [*self.buttons, self.taker, self.report]:
            button.set_enabled(free)

    def _rank(self) -> None:
        self.ranking.clear()
        self.buttons = []
        found = self.session.diagnosis
        if found is None:
            return
        same, probable = {name for names in found.equivalent for name in names}, words.probabilities(found)
        with self.ranking:
            for one in found.ranking[:RANKED]:
                self._row(one, one.effect in same and not one.accepted, probable.get(one.effect, ""))
        self.enable(not self.session.busy)

    def _row(self, one: Candidate, same: bool, probable: str) -> None:
        with html.div().classes(f"ranked{' accepted' if one.accepted else ''}"):
            mark = "✓ " if one.accepted else "≈ " if same else ""
            ui.label(mark + one.effect.replace("_", " ")).classes("effect-name")
            ui.label(f"{100.0 * one.gain:.0f} %").classes("gain")
            if one.effect in self.session.arm.effects:
                ui.label("added").classes("muted")
            else:
                button = ui.button("Add", on_click=lambda: self._add(one.effect)).props("dense outline padding='0 .7rem'")
                button.props(f'aria-label="Add {one.effect}"')
                self.buttons.append(button)
            with html.div().classes("bar"):
                html.div().style(f"width: {100.0 * one.gain:.1f}%")
            facts = [f"probability {probable}"] if probable else []
            if facts or one.estimates:
                ui.label(", ".join(facts + [words.parameters_of(one.estimates)] * bool(one.estimates))).classes("parameters")

    def _add(self, effect: str) -> None:
        self.show_error("")
        try:
            self.session.add(effect)
        except InputError as error:
            self.show_error(str(error))
        self.added()

    def _adopt(self) -> None:
        self.session.adopt()
        self.added()

    def _arm_file(self) -> None:
        ui.download.content(self.session.arm_file(), f"{self.session.draft.name}.toml", "application/toml")

    def _report(self) -> None:
        self.show_error("")
        try:
            self.session.write_report()
        except InputError as error:
            self.show_error(str(error))
        self.added()

    def _next_run(self) -> None:
        content = self.session.next_run()
        if content is not None:
            ui.download.content(content, "next-run.csv", "text/csv")
