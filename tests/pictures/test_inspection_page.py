"""The page of `flexarm inspect`: what it says, what its figures mark, and how it looks in a browser."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("plotly")

from browser import DESKTOP, PHONE, grave_faults, needs_chromium, opened, width_beyond
from inspection_results import CUT, GLUED, overview
from page_parts import figures, visible

from flexarm_env.pictures import inspection_figures
from flexarm_env.pictures.inspection_page import inspection_page

REDO = {"command_line": "flexarm inspect runs", "version": "0.1.0", "commit": "abcdef"}


def test_faults_come_first_with_the_line_that_mends_them():
    text = visible(inspection_page(overview(CUT, GLUED), REDO))
    assert "2 faults in 2 recordings." in text
    assert text.index(CUT.message) < text.index("Recordings") < text.index("Constants that a fit would show")
    assert CUT.hint in text
    assert "flexarm inspect runs" in text


def test_sound_recordings_have_no_table_of_faults():
    text = visible(inspection_page(overview(), REDO))
    assert "No fault in 2 recordings." in text
    assert "line that mends it" not in text


def test_states_limits_and_remarks_are_there_to_read():
    text = visible(inspection_page(overview(), REDO))
    for part in ("75 %", "from 0.0020", "up to 2.0", "not excited", "too small to see", "± 9.1 %", "not shown"):
        assert part in text
    assert "1 of 2 constants, and 1 of 3 effects" in text
    assert "the scale that torques, inertias and stiffnesses have in common" in text
    assert "near the truth" in text


def test_faulty_samples_are_crossed_and_breaks_are_lines():
    found = overview(CUT, GLUED)
    drawn = inspection_figures.signals(found.recordings[0], found.inspection.faults)
    (crosses,) = [trace for trace in drawn.data if trace.mode == "markers"]
    assert list(crosses.x) == pytest.approx([0.40, 0.41, 0.42])
    assert list(crosses.y) == pytest.approx(found.recordings[0].signals["arm_angle"][40:43], abs=1e-3)
    assert {shape.x0 for shape in drawn.layout.shapes} == {0.5}
    assert any("rail" in one.text for one in drawn.layout.annotations)
    sound = inspection_figures.signals(found.recordings[1], found.inspection.faults)
    assert not [trace for trace in sound.data if trace.mode == "markers"]
    assert not sound.layout.shapes


def test_effects_without_a_limit_are_in_the_table_alone():
    drawn = figures(inspection_page(overview(), REDO))
    assert drawn["effects"]["data"][0]["y"] == ["saturation", "coulomb"]
    assert {"recording-pulse", "recording-square", "constants", "effects"} == set(drawn)


@pytest.fixture(scope="module")
def page(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("inspection") / "inspection.html"
    path.write_text(inspection_page(overview(CUT, GLUED), REDO), encoding="utf-8")
    return path


@needs_chromium
@pytest.mark.parametrize("viewport", [PHONE, DESKTOP], ids=["phone", "desktop"])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_fits_every_window(page, viewport, scheme):
    with opened(viewport=viewport, color_scheme=scheme) as (shown, errors):
        shown.goto(page.as_uri())
        shown.wait_for_selector("html[data-drawn]")
        assert shown.locator("div.plot .main-svg").count() == 3 * shown.locator("div.plot").count()
        assert width_beyond(shown) <= 0
        assert grave_faults(shown) == []
        assert errors == []
