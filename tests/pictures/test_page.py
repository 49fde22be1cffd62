"""The page of a comparison: small, whole without a network, and true to the curves."""

from __future__ import annotations

import base64
import gzip
import json
import re

import numpy as np
import pytest

pytest.importorskip("plotly")

from plotly.offline import get_plotlyjs

from flexarm_env import Arm
from flexarm_env.identify.results import Comparison, Replay
from flexarm_env.pictures.page import page

SIGNALS = {"arm_angle": 2e-3, "motor_speed": 0.03, "strain_mid": 0.01, "strain_base": 0.01}


def replay(name: str, samples: int, seed: int) -> Replay:
    """A recording of noise around motion, which packs worse than any that is measured."""
    draw = np.random.default_rng(seed)
    time = 0.002 * np.arange(samples)
    parts = [
        {s: 3.0 * np.sin(2.0 * time) + draw.normal(0.0, times * noise, samples) for s, noise in SIGNALS.items()}
        for times in (1.0, 5.0, 20.0)
    ]
    return Replay(name, time, *parts, np.zeros(samples, dtype=np.int64))


def comparison(samples: int, seed: int) -> Comparison:
    replays = [replay(name, samples, seed + i) for i, name in enumerate(("pulse", "square", "sweep"))]
    return Comparison(Arm.load("thesis"), [], replays, SIGNALS, 1.5, 12.0)


def unpacked(text: str) -> tuple[str, list[dict]]:
    """Plotly's library and the figures of a page, as the browser gets them."""
    blocks = re.findall(r'<script type="text/plain"([^>]*)>([^<]*)</script>', text)
    texts = [(place, gzip.decompress(base64.b64decode(block)).decode()) for place, block in blocks]
    return next(t for place, t in texts if place), [json.loads(t) for place, t in texts if not place]


def test_a_page_of_the_demo_s_size_is_below_5_megabytes():
    assert len(page(comparison(5000, 0), comparison(5000, 10)).encode()) < 5e6


def test_it_holds_all_that_it_needs():
    text = page(comparison(200, 0))
    library, figures = unpacked(text)
    assert library == get_plotlyjs()
    assert len(figures) == 3
    assert not re.search(r"<(script|link|img|iframe)[^>]*(src|href)=", text)
    assert "http" not in re.sub(r'<script type="text/plain"[^>]*>[^<]*</script>', "", text)


def test_curves_are_exact_to_a_fiftieth_of_the_noise():
    result = comparison(300, 4)
    _, figures = unpacked(page(result))
    for one, figure in zip(result.replays, figures, strict=True):
        drawn = iter(figure["data"])
        for signal, noise in SIGNALS.items():
            for expected in (one.measured, one.windows, None, one.free, None):
                y = np.array(next(drawn)["y"])
                if expected is not None:
                    assert np.abs(y - expected[signal]).max() <= noise / 50.0
        assert next(drawn, None) is None


def test_a_replay_that_ran_away_leaves_a_gap():
    result = comparison(50, 5)
    result.replays[0].free["arm_angle"][20:] = np.nan
    result.replays[0].windows["arm_angle"][20:] = np.inf
    _, figures = unpacked(page(result))
    for i in (1, 3):
        assert figures[0]["data"][i]["y"][20:] == [None] * 30
