"""The rows of the table: complete, in order, and verdicts that follow from numbers."""

from __future__ import annotations

import math

import pytest

from flexarm_env.thesis.claims import FAILS, HOLDS, IN_PART, ROWS, Claim, Part
from flexarm_env.thesis.errata import errata
from flexarm_env.thesis.figures import CHAPTERS
from flexarm_env.thesis.figures.chapter2 import STAND_IN


@pytest.fixture(scope="module")
def claims():
    return [row() for row in ROWS]


@pytest.fixture(scope="module")
def sheets():
    return [sheet for build in CHAPTERS.values() for sheet in build()]


@pytest.mark.parametrize(
    ("held", "verdict"), [((True, True), HOLDS), ((True, False), IN_PART), ((False, False), FAILS), ((False,), FAILS)]
)
def test_a_verdict_follows_from_its_parts(held, verdict):
    parts = [Part("", h, {str(k): float(k)}) for k, h in enumerate(held)]
    claim = Claim("T0", "", "", parts, "")
    assert claim.verdict == verdict
    assert claim.numbers == {str(k): float(k) for k in range(len(held))}


def test_there_are_rows_t1_to_t19(claims):
    assert [claim.key for claim in claims] == [f"T{k}" for k in range(1, 20)]
    for claim in claims:
        assert claim.words
        assert claim.where
        assert claim.because
        assert claim.parts
        assert claim.numbers
        for part in claim.parts:
            assert part.ours
            assert all(math.isfinite(value) for value in part.numbers.values()), claim.key
        assert "nan" not in " ".join(part.ours for part in claim.parts)


def test_every_figure_of_the_thesis_s_simulations_is_there(sheets):
    wanted = [f"2.{k}" for k in range(6, 10)] + [f"3.{k}" for k in range(5, 11)] + [f"4.{k}" for k in range(2, 20)]
    numbers = [sheet.number for sheet in sheets]
    assert set(wanted) <= set(numbers)
    assert len(set(numbers)) == len(numbers)


def test_rows_and_misprints_name_figures_that_are_there(claims, sheets):
    numbers = {sheet.number for sheet in sheets}
    for row in (*claims, *errata()):
        assert set(row.figures) <= numbers


def test_figures_have_units_and_say_what_stands_in(sheets):
    for sheet in sheets:
        for panel in sheet.panels:
            assert "[" in panel.label, sheet.number
            assert all(curve.label for curve in panel.curves)
        assert "[" in sheet.x
    for number in ("2.6", "2.7", "2.8", "2.9"):
        (sheet,) = [s for s in sheets if s.number == number]
        assert STAND_IN in {curve.label for panel in sheet.panels for curve in panel.curves}


def test_every_misprint_changes_a_number():
    found = errata()
    assert {row.number for row in found} == {str(k) for k in range(1, 11)}
    for row in found:
        assert row.printed != pytest.approx(row.mended, rel=5e-3), row.where


def test_misprints_of_figures_are_drawn_beside(sheets):
    """Where a misprint changes a figure, one curve there says so."""
    named = {n for row in errata() for n in row.figures if n not in ("4.2", "4.3", "A.1")}
    for number in named:
        (sheet,) = [s for s in sheets if s.number == number]
        labels = " ".join(curve.label for panel in sheet.panels for curve in panel.curves)
        assert "printed" in labels or "caption" in labels, number


def test_the_speed_is_measured(claims):
    numbers = claims[-1].numbers
    assert numbers["product [s]"] < 0.1
    assert numbers["method over product"] > 1e3
    assert numbers["12 h over product"] > 1e5
