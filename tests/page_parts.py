"""Parts of a page as a browser gets them and as a person reads them."""

from __future__ import annotations

import base64
import gzip
import json
import re

PLACE = re.compile(r'id="(figure-[^"]*)" style="[^"]*"><script type="text/plain">([^<]*)</script>')


def unpacked(block: str) -> str:
    return gzip.decompress(base64.b64decode(block)).decode()


def figures(text: str) -> dict[str, dict]:
    """The figures of a page by their place, as the browser gets them."""
    found = {place.removeprefix("figure-"): json.loads(unpacked(block)) for place, block in PLACE.findall(text)}
    assert len(found) == text.count('<div class="plot"'), "two figures have one place"
    return found


def visible(text: str) -> str:
    """What is there to read."""
    return re.sub(r"<[^>]+>", " ", re.sub(r"<(script|style)[^>]*>.*?</\1>", "", text, flags=re.DOTALL))
