"""A headless Chromium for tests of pages, and what is wrong with a page."""

from __future__ import annotations

import io
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest
from PIL import Image

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
ARGUMENTS = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
DESKTOP, PHONE = {"width": 1440, "height": 900}, {"width": 390, "height": 844}
#: What axe calls a fault that keeps people out.
GRAVE = ("serious", "critical")

needs_chromium = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium found; install Debian's package chromium")


@contextmanager
def opened(**options: Any) -> Iterator[tuple[Any, list[str]]]:
    """Give a page with an empty profile, and the list of errors that its console shows."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        try:
            page = browser.new_page(**{"viewport": DESKTOP, **options})
            errors: list[str] = []
            page.on("console", lambda message: errors.append(message.text) if message.type == "error" else None)
            page.on("pageerror", lambda error: errors.append(str(error)))
            yield page, errors
        finally:
            browser.close()


def grave_faults(page: Any) -> list[str]:
    """Return the serious accessibility faults of a page, as axe-core finds them."""
    from axe_playwright_python.sync_playwright import Axe

    found = Axe().run(page).response["violations"]
    return [f"{v['id']}: {v['nodes'][0]['html'][:200]}" for v in found if v["impact"] in GRAVE]


def width_beyond(page: Any) -> int:
    """Return by how many pixels a page is wider than its window."""
    return page.evaluate("document.documentElement.scrollWidth - window.innerWidth")


def brightness(page: Any) -> tuple[float, float]:
    """Return the mean brightness (0 to 1) of a page's corner, and the largest one in a picture of it."""
    picture = np.asarray(Image.open(io.BytesIO(page.screenshot())).convert("L"), dtype=float) / 255.0
    return float(picture[:4, :4].mean()), float(picture.max())
