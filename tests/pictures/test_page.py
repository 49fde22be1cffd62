"""The report: small, whole without a network, true to the curves, and with everything that a reader asks for."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("plotly")

from page_parts import figures, unpacked, visible
from picture_results import SIGNALS, comparison, diagnosis, recordings
from plotly.offline import get_plotlyjs

from flexarm_env.experiments.next_run import NextRun
from flexarm_env.identify.explain.detection_limits import DetectionLimit
from flexarm_env.pictures import bars
from flexarm_env.pictures.page import Findings, page

REDO = {"command_line": "flexarm diagnose runs --seed 7", "version": "0.1.0", "commit": "abcdef", "seed": 7}


def one_of(result, after=None, **more) -> str:
    return page(Findings(result, recordings(result), after, **more))


def test_a_page_of_the_demo_s_size_is_below_5_megabytes():
    text = one_of(comparison(5000, 0), comparison(5000, 10), diagnosis=diagnosis(), provenance=REDO)
    assert len(text.encode()) < 5e6


def test_it_holds_all_that_it_needs():
    text = one_of(comparison(200, 0))
    (library,) = re.findall(r'<script type="text/plain" id="plotly">([^<]*)</script>', text)
    assert unpacked(library) == get_plotlyjs()
    assert {"recording-pulse", "recording-square", "recording-sweep"} <= set(figures(text))
    assert not re.search(r"<(script|link|img|iframe)[^>]*(src|href)=", text)
    assert "http" not in re.sub(r'<script type="text/plain"[^>]*>[^<]*</script>', "", text)


def test_curves_are_exact_to_a_fiftieth_of_the_noise():
    result = comparison(300, 4)
    drawn_figures = figures(one_of(result))
    for one in result.replays:
        drawn = iter(drawn_figures[f"recording-{one.name}"]["data"])
        for signal, noise in SIGNALS.items():
            for expected in (one.measured, one.windows, None, one.free, None):
                y = np.array(next(drawn)["y"])
                if expected is not None:
                    assert np.abs(y - expected[signal]).max() <= noise / 50.0
        assert next(drawn, None) is None


def test_a_long_recording_is_drawn_by_the_graphics_card():
    drawn = figures(one_of(comparison(20_001, 0), comparison(20_001, 3)))["recording-pulse"]["data"]
    assert {trace["type"] for trace in drawn} == {"scattergl"}
    assert {trace["line"].get("dash") for trace in drawn} == {None, "dash"}


def test_a_replay_that_ran_away_leaves_a_gap():
    result = comparison(50, 5)
    result.replays[0].free["arm_angle"][20:] = np.nan
    result.replays[0].windows["arm_angle"][20:] = np.inf
    drawn = figures(one_of(result))["recording-pulse"]["data"]
    for i in (1, 3):
        assert drawn[i]["y"][20:] == [None] * 30


def test_the_verdict_stands_on_top():
    found = diagnosis()
    words = visible(one_of(comparison(200, 0), comparison(200, 3), diagnosis=found))
    order = [
        "Missing: backlash",
        "Where it fails",
        "Missing effect",
        "Error after each step",
        "Which effect",
        "Constants",
        "Residuals",
    ]
    assert [words.index(part) for part in order] == sorted(words.index(part) for part in order)


def test_each_step_has_a_bar_and_the_noise_is_the_last():
    drawn = figures(one_of(comparison(200, 0), comparison(200, 3), diagnosis=diagnosis()))["glance-fall"]["data"]
    solid = [bar for bar in drawn if "base" not in bar]
    assert [bar["x"] for bar in solid] == [[4.1], [3.7], [1.02], [1.0]]
    assert solid[-1]["y"] == ["noise floor <b>1</b>"]
    assert solid[2]["y"] == ["+ backlash <b>1.02</b>"]


def test_a_box_reaches_from_the_error_before_to_the_error_after():
    steps = [("as given", 3.0), ("constants refitted", 4.5), ("+ backlash", 1.13)]
    boxes = [bar for bar in bars.waterfall(steps).data if bar.base is not None]
    assert [(bar.base[0], bar.base[0] + bar.x[0]) for bar in boxes] == [(3.0, 4.5), (1.13, pytest.approx(4.5))]
    assert boxes[0].marker != boxes[1].marker  # an error that rises looks other than one that falls


def test_residuals_stand_against_every_driver_by_regime():
    result = comparison(400, 0)
    drawn = figures(one_of(result, comparison(400, 3)))
    for signal in SIGNALS:
        for driver in ("time--one-recording-after-another", "arm-angle", "arm-speed", "current", "spectrum"):
            assert f"{signal}-{driver}".replace("_", "-") in drawn
    names = [trace["name"] for trace in drawn["arm-angle-current"]["data"]]
    assert names == ["stuck", "creeping", "moving", "median"] * 2
    symbols = {trace["marker"]["symbol"] for trace in drawn["arm-angle-current"]["data"] if "marker" in trace}
    assert len(symbols) == 3  # told apart without colour


def test_the_spectrum_of_white_noise_is_flat_at_its_size():
    result = comparison(4000, 1)
    for one in result.replays:
        draw = np.random.default_rng(3)
        for signal, noise in SIGNALS.items():
            one.windows[signal][:] = one.measured[signal] - draw.normal(0.0, 3.0 * noise, 4000)
    drawn = figures(one_of(result))["arm-angle-spectrum"]["data"][0]
    assert float(np.mean(np.square(drawn["y"]))) == pytest.approx(9.0, rel=0.05)


def test_ranking_constants_and_rivals_have_their_intervals():
    words = visible(one_of(comparison(200, 0), comparison(200, 3), diagnosis=diagnosis()))
    assert "gap = 0.0612 rad (0.0583 to 0.0641)" in words
    assert "0.3291 to 0.3333" in words
    assert "indistinguishable from it" in words


def test_what_could_hide_and_the_next_run_are_shown_where_they_are_known():
    plain = one_of(comparison(200, 0), comparison(200, 3), diagnosis=diagnosis())
    assert "Smallest detectable sizes" not in plain
    assert "The next run" not in plain
    run = NextRun("slow ramps", ("stiction", "stribeck"), 2.5, np.arange(50) * 0.01, np.linspace(-1.0, 1.0, 50), "current")
    found = replace(diagnosis(), smallest={"stiction": DetectionLimit("extra", 0.0123, "N*m")}, next_run=run)
    text = one_of(comparison(200, 0), comparison(200, 3), diagnosis=found)
    words = visible(text)
    assert re.search(r"stiction\s+extra\s+0.0123\s+N·m", words)
    assert "Record slow ramps: it decides between stiction and stribeck (2.5 × the noise apart)." in words
    assert figures(text)["next-run"]["data"][0]["y"][-1] == pytest.approx(1.0, abs=1e-3)


def test_it_says_how_to_redo_it():
    result = comparison(100, 0)
    runs = recordings(result)
    object.__setattr__(runs[0], "sha256", "c0ffee")
    words = visible(page(Findings(result, runs, provenance=REDO)))
    for part in ("flexarm diagnose runs --seed 7", "FlexArm 0.1.0", "abcdef", "seed 7", "c0ffee"):
        assert part in words
    assert "Settings" not in words


def test_it_names_the_settings_of_a_diagnosis():
    result, found = comparison(100, 0), diagnosis()
    words = visible(page(Findings(result, recordings(result), comparison(100, 3), found, provenance=REDO)))
    assert f"Settings {found.settings.digest()}; flexarm diagnose --settings prints" in words


def test_names_are_no_markup():
    result = comparison(100, 0)
    object.__setattr__(result.replays[0], "name", "<b>run</b>")
    text = page(Findings(result, recordings(comparison(100, 0))))
    assert "<b>run</b>" not in text
