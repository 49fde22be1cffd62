"""The report as a person opens it: offline, on a desk and on a phone, in print, and for a screen reader."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("plotly")
pytest.importorskip("playwright")

from browser import PHONE, brightness, grave_faults, needs_chromium, opened, width_beyond
from picture_results import comparison, diagnosis, recordings

from flexarm_env.pictures.page import Findings, page

pytestmark = needs_chromium
DRAWN = "html[data-drawn]"


@pytest.fixture(scope="module")
def report(tmp_path_factory) -> Path:
    before = comparison(400, 0)
    found = Findings(
        before,
        recordings(before),
        comparison(400, 5),
        diagnosis(),
        provenance={"command_line": "flexarm " + 300 * "x", "version": "0.1.0", "commit": 40 * "c"},
    )
    path = tmp_path_factory.mktemp("report") / "report.html"
    path.write_text(page(found), encoding="utf-8")
    return path


def test_it_opens_offline_and_draws_all_that_is_not_folded(report):
    with opened(offline=True) as (shown, errors):
        asked: list[str] = []
        shown.on("request", lambda request: asked.append(request.url))
        shown.goto(report.as_uri())
        shown.wait_for_selector(DRAWN)
        assert asked == [report.as_uri()]
        folded = shown.locator("details:not([open]) div.plot").count()
        assert shown.locator("div.plot").count() - folded == shown.locator("div.plot .main-svg").count() / 3
        shown.locator("summary", has_text="Residuals of").first.click()
        shown.wait_for_selector("details[open] .main-svg")
        assert errors == []


@pytest.mark.parametrize(("scheme", "is_dark"), [("light", False), ("dark", True)])
def test_it_follows_the_scheme(report, scheme, is_dark):
    with opened(color_scheme=scheme) as (shown, _):
        shown.goto(report.as_uri())
        shown.wait_for_selector(DRAWN)
        corner, brightest = brightness(shown)
        assert (corner < 0.1) is is_dark
        assert brightest > 0.8  # of text, or of paper


def test_it_fits_a_phone(report):
    with opened(viewport=PHONE) as (shown, errors):
        shown.goto(report.as_uri())
        shown.wait_for_selector(DRAWN)
        assert width_beyond(shown) <= 0
        wide = shown.locator("div.plot .main-svg").evaluate_all(
            "all => all.filter(s => s.getBoundingClientRect().right > 390).length"
        )
        assert wide == 0
        assert errors == []


def test_print_opens_what_is_folded_and_keeps_within_the_paper(report):
    with opened() as (shown, errors):
        shown.goto(report.as_uri())
        shown.wait_for_selector(DRAWN)
        assert shown.pdf(format="A4").startswith(b"%PDF")
        shown.evaluate("dispatchEvent(new Event('beforeprint'))")
        assert shown.locator("details:not([open])").count() == 0
        widths = shown.locator("div.plot .main-svg").evaluate_all("all => all.map(s => s.getBoundingClientRect().width)")
        assert len(widths) == 3 * shown.locator("div.plot").count()
        assert max(widths) <= 700
        assert errors == []


@pytest.mark.parametrize("viewport", [PHONE, {"width": 1440, "height": 900}], ids=["phone", "desktop"])
def test_axe_finds_no_serious_fault(report, viewport):
    with opened(viewport=viewport) as (shown, _):
        shown.goto(report.as_uri())
        shown.wait_for_selector(DRAWN)
        assert grave_faults(shown) == []
