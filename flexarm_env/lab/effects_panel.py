"""Panel of effects to switch on, with a slider for each of their parameters."""

from __future__ import annotations

import math
from collections.abc import Callable

from nicegui import html, ui

from flexarm_env.effects import Effect
from flexarm_env.errors import InputError
from flexarm_env.lab.scale import STEPS, scale_of
from flexarm_env.lab.session import Session
from flexarm_env.pictures import words


class EffectsPanel:
    """The effects that apply to a session's arm.

    Args:
        session: that holds the draft to change.
        changed: called after each change.
        show_error: called with one line where a change is refused.
    """

    def __init__(self, session: Session, changed: Callable[[], None], show_error: Callable[[str], None]) -> None:
        self.session, self.changed, self.show_error = session, changed, show_error
        self.rows = html.div().classes("effects")
        self.refresh()

    def refresh(self) -> None:
        """Show the effects of the session's draft."""
        self.rows.clear()
        with self.rows:
            on = self.session.draft.effects
            for name, effect in sorted(self.session.base.known.items(), key=lambda item: item[0] not in on):
                if self.session.base.can_have(name) and effect.fitted:
                    self._row(name, effect)

    def _row(self, name: str, effect: type[Effect]) -> None:
        with html.div().classes("effect"):
            box = ui.checkbox(name.replace("_", " "), value=name in self.session.draft.effects).props("dense")
            box.props["title"] = effect.looks_like
            sliders = html.div().classes("sliders")
            self._fill(sliders, name, effect)

        def tick() -> None:
            try:
                self.session.tick(name, bool(box.value))
            except InputError as error:
                self.show_error(str(error))
                box.value = False
                return
            self._fill(sliders, name, effect)
            self.changed()

        box.on_value_change(tick)

    def _fill(self, place: html.div, name: str, effect: type[Effect]) -> None:
        place.clear()
        if name in self.session.draft.effects:
            with place:
                ui.label(effect.looks_like).classes("muted")
                for key in effect.parameters:
                    self._slider(name, effect, key)

    def _slider(self, name: str, effect: type[Effect], key: str) -> None:
        parameter = effect.parameters[key]
        factor = 1.0 if self.session.live is None else parameter.scaled_by(self.session.live.data.scales)
        value = self.session.draft.effects[name][key]
        scale = scale_of(parameter, value, parameter.typical * factor)
        unit = words.plain_unit(parameter.unit)
        start = scale.position(value) if math.isfinite(value) else STEPS
        with html.div().classes("setting"):
            ui.label(key.replace("_", " ")).classes("name")
            shown = ui.label(f"{words.number(value)} {unit}").classes("value")
        slider = ui.slider(min=0, max=STEPS, step=1, value=start)
        slider.props(f'aria-label="{name} {key} [{unit}]"')

        def drag() -> None:
            moved = scale.value(float(slider.value or 0.0))
            try:
                self.session.drag(name, key, moved)
            except InputError as error:
                self.show_error(str(error))
                return
            shown.set_text(f"{words.number(moved)} {unit}")
            self.changed()

        slider.on_value_change(drag)
